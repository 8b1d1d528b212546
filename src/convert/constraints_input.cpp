// SPDX-License-Identifier: MIT
#include "convert/constraints_input.h"

#include "convert/component_file.h"

#include <algorithm>
#include <set>
#include <utility>

namespace bot2nurbs {

namespace {

// Sites closer than this part of the diagonal are the same: the weights of a place on an edge
// differ by rounding when it is seen from the two faces.
constexpr double same_place = 1e-9;

Vec3 place_of(const ConstraintSite& site, const ManifoldMesh& source)
{
    return site.vertex ? source.position(*site.vertex) : source.at(site.point);
}

} // namespace

Result<std::vector<DomainConstraints>> read_constraints(const std::string& path,
                                                        const RepairedMesh& mesh)
{
    return read_for_components(path, mesh, constraint_list_from_json);
}

DomainConstraints constraints_used(const DomainConstraints& asked,
                                   const std::vector<FeaturePath>& features,
                                   const ManifoldMesh& source, const QuadDomain& domain)
{
    DomainConstraints used = asked;
    used.source_signature = domain.source_signature;
    used.patches = domain.complex.quad_count();
    for (const FeaturePath& feature : features) {
        if (feature.kind != FeatureKind::corner) {
            used.features.push_back(feature);
            continue;
        }
        for (const Index v : feature.vertices)
            used.features.push_back({FeatureKind::corner, {v}});
    }
    const double least = same_place * source.box().diagonal();
    const std::size_t given = used.sites.size();
    for (Index v = 0; v < domain.complex.vertex_count(); ++v) {
        const Index on_carrier = domain.vertices[v];
        ConstraintSite site;
        if (on_carrier < source.vertex_count())
            site.vertex = on_carrier;
        else
            site.point = domain.carrier.vertex_source[on_carrier];
        const Vec3 place = place_of(site, source);
        const auto end = used.sites.begin() + static_cast<std::ptrdiff_t>(given);
        if (std::any_of(used.sites.begin(), end, [&](const ConstraintSite& other) {
                return norm(place_of(other, source) - place) <= least;
            }))
            continue;
        if (!domain.carrier.mesh.is_boundary_vertex(on_carrier))
            site.valence = domain.complex.valence(v);
        used.sites.push_back(site);
    }
    return used;
}

} // namespace bot2nurbs
