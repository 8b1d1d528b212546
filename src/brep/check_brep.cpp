// SPDX-License-Identifier: MIT
#include "bot2nurbs/brep.h"

#include "brep/brep_rules.h"
#include "brep/volume.h"

namespace bot2nurbs {

Box3 bounding_box(const Brep& brep)
{
    Box3 box;
    for (const BsplinePatch& s : brep.surfaces) {
        for (const Vec3& c : s.control)
            box.add(c);
    }
    for (const BrepVertex& v : brep.vertices)
        box.add(v.point);
    return box;
}

BrepReport check_brep(const Brep& brep)
{
    BrepReport report;
    DefectList defects, warnings;
    if (brep.faces.empty())
        defects.add("no_faces", invalid_index, "the B-Rep has no faces");
    check_indices(brep, defects);
    check_splines(brep, defects);
    if (defects.empty())
        check_lists(brep, defects);
    if (defects.empty()) {
        check_topology(brep, defects, report);
        check_geometry(brep, defects, warnings, report);
        const bool closed = report.boundary_edges == 0 && report.nonmanifold_edges == 0;
        if (closed)
            report.volume = signed_volume(brep);
        if (closed && defects.empty() && !(report.volume > 0.0))
            defects.add("inside_out", invalid_index, "the normals point inward");
        if (!closed && brep.solid && defects.empty()) {
            defects.add("solid_flag", invalid_index,
                        "the B-Rep is called solid but has " +
                            std::to_string(report.boundary_edges) + " boundary edges");
        }
        report.solid = closed && defects.empty();
    }
    report.valid = defects.empty();
    report.defects = defects.take();
    report.warnings = warnings.take();
    return report;
}

} // namespace bot2nurbs
