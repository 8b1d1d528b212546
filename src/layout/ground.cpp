// SPDX-License-Identifier: MIT
#include "layout/ground.h"

#include "layout/refine_carrier.h"
#include "layout/size_field.h"

#include <algorithm>
#include <cmath>

namespace bot2nurbs {

namespace {

// The default number of patches is the shape's bending, k1^2 + k2^2 integrated, between bounds: 25
// on any sphere, 108 on a torus with radii 1 and 0.4. The upper bound keeps fits fast and B-Reps
// easy to handle; a tolerance or --patches asks for more. Short curves ask for more patches around
// them, up to the second bound.
constexpr double min_default_patches = 24.0;
constexpr double max_default_patches = 150.0;
constexpr double max_default_patches_genus_3 = 300.0;
constexpr double patches_per_handle = 16.0;
// Curvature is measured at this fraction of the box diagonal.
constexpr double curvature_scale = 0.015;
// Carrier edges are at most this part of the width of a patch, so that a patch has enough faces for
// a smooth map: some thirty, for halved edges are shorter than they must be. With 0.3 layouts of
// coarse meshes take twice the time; stretch and errors in scripts/corpus.py are the same on the
// whole.
constexpr double carrier_resolution = 0.4;
// Refining a carrier adds at most this many vertices per face, plus the constant: a sliver whose
// area is nothing beside its length would ask for any number.
constexpr std::size_t max_refinement_factor = 4;
constexpr std::size_t max_refinement_floor = 20000;

double surface_area(const ManifoldMesh& mesh)
{
    return scaled_area(mesh, std::vector<double>(mesh.vertex_count(), 1.0));
}

// `handles` is the genus of a closed surface.
double most_default_patches(double handles)
{
    const double limit = handles >= 3.0 ? max_default_patches_genus_3 : max_default_patches;
    return std::max(limit, patches_per_handle * handles);
}

double default_patches(double bending, double handles)
{
    const double least = std::max(min_default_patches, 0.5 * patches_per_handle * handles);
    return std::clamp(bending, least, most_default_patches(handles));
}

// The level of a mesh cut open, with the density of curvature.
struct Measured {
    std::unique_ptr<CutMesh> cut;
    std::unique_ptr<LayoutLevel> level;
    double bending = 0.0;
};

Measured measure(const ManifoldMesh& mesh, const std::vector<char>& marks,
                 const std::vector<char>& corner, double smoothing, const Context& context)
{
    Measured result;
    result.cut = std::make_unique<CutMesh>(mesh, marks);
    const ManifoldMesh& cut = result.cut->mesh();
    SizeField field = measure_size_field(cut, smoothing, context);
    result.bending = field.bending;
    std::vector<Index> name(cut.vertex_count());
    for (Index v = 0; v < cut.vertex_count(); ++v)
        name[v] = result.cut->original(v);
    result.level =
        std::make_unique<LayoutLevel>(cut, std::move(name), mesh.vertex_count(),
                                      std::move(field.density), trace_curves(mesh, marks, corner));
    return result;
}

} // namespace

int euler_characteristic(const ManifoldMesh& mesh)
{
    return static_cast<int>(mesh.vertex_count()) - static_cast<int>(mesh.edge_count()) +
           static_cast<int>(mesh.face_count());
}

Result<Ground> prepare_ground(const ManifoldMesh& source, const LayoutOptions& options,
                              LayoutSummary& summary, const Context& context)
{
    const DomainConstraints& wanted = options.constraints;
    if (Status failed = check_constrained_paths(wanted, source))
        return *failed;
    Ground ground;
    std::vector<FeaturePath> edges;
    ground.corner.assign(source.vertex_count(), 0);
    std::vector<FeaturePath> paths = options.features;
    for (const FeaturePath& path : constrained_paths(wanted))
        paths.push_back(path);
    for (const FeaturePath& path : paths) {
        if (path.kind != FeatureKind::corner)
            edges.push_back(path);
        else
            for (const Index v : path.vertices)
                ground.corner[v] = 1;
    }
    ground.marks = mark_edges(source, edges);

    const double smoothing = curvature_scale * source.box().diagonal();
    Measured on_source = measure(source, ground.marks, ground.corner, smoothing, context);
    const double handles = 0.5 * (2 - euler_characteristic(source));
    const std::optional<Index> asked = options.patches ? options.patches : wanted.patches;
    const double by_bending = asked ? *asked : default_patches(on_source.bending, handles);
    // Patches of this width where the density is one.
    const double unit = std::sqrt(surface_area(source) / by_bending);
    on_source.level->refine_at_curves(unit);
    double count = by_bending;
    if (!asked) {
        const double by_curves =
            scaled_area(on_source.level->mesh(), on_source.level->density()) / (unit * unit);
        count =
            std::clamp(by_curves, by_bending, std::max(by_bending, max_default_patches_genus_3));
    }
    summary.target_patches = static_cast<Index>(std::lround(count));

    CarrierPlan plan;
    plan.limit.assign(source.vertex_count(), carrier_resolution * unit);
    for (Index v = 0; v < on_source.level->mesh().vertex_count(); ++v) {
        double& least = plan.limit[on_source.level->name(v)];
        least = std::min(least, carrier_resolution * unit / on_source.level->density()[v]);
    }
    plan.max_splits = max_refinement_floor + max_refinement_factor * source.face_count();
    plan.marks = std::move(ground.marks);
    for (const ConstraintSite& site : wanted.sites)
        if (!site.vertex)
            plan.points.push_back(site.point);
    PlannedCarrier planned = refine_carrier(source, std::move(plan));
    ground.carrier = std::make_unique<CarrierMesh>(std::move(planned.carrier));
    ground.marks = std::move(planned.marks);
    const ManifoldMesh& mesh = ground.carrier->mesh;
    ground.corner.resize(mesh.vertex_count(), 0);
    if (ground.carrier->refined)
        summary.notes.push_back("edges split where the mesh is coarse for its patches: " +
                                std::to_string(source.face_count()) + " faces became " +
                                std::to_string(mesh.face_count()));
    Result<CarrierConstraints> constraints = place_constraints(wanted, planned.point_vertices);
    if (!constraints)
        return constraints.error();
    ground.constraints = std::move(*constraints);
    if (Status failed = route_joints(mesh, ground.constraints, ground.marks))
        return *failed;

    Measured on_carrier;
    if (ground.carrier->refined || ground.constraints.binds()) {
        // Curves end at sites on them.
        std::vector<char> node = ground.corner;
        for (const Index s : ground.constraints.sites)
            node[s] = 1;
        on_carrier = measure(mesh, ground.marks, node, smoothing, context);
        on_carrier.level->refine_at_curves(unit);
    } else {
        on_carrier = std::move(on_source); // The same mesh, vertex by vertex.
    }
    on_carrier.level->required = ground.constraints.sites;
    for (const auto& pair : ground.constraints.apart)
        on_carrier.level->apart.push_back({pair.a, pair.b});
    ground.cut = std::move(on_carrier.cut);
    ground.level = std::move(on_carrier.level);
    ground.width = std::sqrt(scaled_area(ground.level->mesh(), ground.level->density()) / count);
    return ground;
}

} // namespace bot2nurbs
