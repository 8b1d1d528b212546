// SPDX-License-Identifier: MIT
#include "layout/make_domain.h"

#include "domain/domain_paths.h"
#include "layout/curves.h"

#include <algorithm>

namespace bot2nurbs {

bool is_simple(const PatchComplex& quads)
{
    std::vector<std::pair<Index, Index>> ends;
    for (const PatchComplex::Path& p : quads.paths())
        if (p.alive)
            ends.push_back(std::minmax(p.geometry.a, p.geometry.b));
    std::sort(ends.begin(), ends.end());
    return std::adjacent_find(ends.begin(), ends.end()) == ends.end();
}

bool has_enough_quads(const PatchComplex& quads)
{
    for (const PatchComplex::Side& s : quads.vertex_sides()) {
        const std::vector<PatchComplex::Side> star = quads.star(s);
        const bool inside = quads.face_at(star.back()) != invalid_index;
        const auto creases = std::count_if(star.begin(), star.end(), [&](const auto& spoke) {
            return quads.paths()[spoke.path].mark == mark_of(FeatureKind::crease);
        });
        if (inside && star.size() < 3 && creases < 2)
            return false;
    }
    return true;
}

Result<QuadDomain> make_domain(const PatchComplex& quads, CarrierMesh carrier,
                               const std::vector<char>& is_corner)
{
    QuadDomain domain;
    const ManifoldMesh& mesh = carrier.mesh;
    std::vector<Index> number(mesh.vertex_count(), invalid_index);
    std::vector<std::array<Index, 4>> corners_of;
    for (Index f = 0; f < quads.faces().size(); ++f) {
        const std::vector<Index> corners = quads.corners(f);
        std::array<Index, 4> quad{};
        for (std::size_t k = 0; k < 4; ++k) {
            if (number[corners[k]] == invalid_index) {
                number[corners[k]] = static_cast<Index>(domain.vertices.size());
                domain.vertices.push_back(corners[k]);
            }
            quad[k] = number[corners[k]];
        }
        corners_of.push_back(quad);
    }
    std::vector<std::pair<Index, Index>> creases;
    for (Index p = 0; p < quads.paths().size(); ++p)
        if (quads.paths()[p].mark == mark_of(FeatureKind::crease) && !quads.is_boundary(p))
            creases.emplace_back(number[quads.paths()[p].geometry.a],
                                 number[quads.paths()[p].geometry.b]);
    std::vector<Index> corners;
    for (Index v = 0; v < domain.vertices.size(); ++v)
        if (domain.vertices[v] < is_corner.size() && is_corner[domain.vertices[v]])
            corners.push_back(v);
    Result<QuadComplex> built =
        QuadComplex::build(static_cast<Index>(domain.vertices.size()), std::move(corners_of),
                           creases, std::move(corners));
    if (!built)
        return built.error();
    domain.complex = std::move(*built);
    domain.edges.resize(domain.complex.edge_count());
    for (Index f = 0; f < quads.faces().size(); ++f)
        for (Index s = 0; s < 4; ++s) {
            const Index h = 4 * f + s, e = domain.complex.edge(h);
            if (domain.complex.halfedge_of_edge(e) != h)
                continue;
            const PatchComplex::Side& side = quads.faces()[f].sides[s];
            const PathSide walk{&quads.paths()[side.path].geometry, side.reversed};
            SurfacePath path;
            path.a = walk.start();
            path.b = walk.end();
            for (std::size_t i = 0; i < walk.node_count(); ++i)
                path.nodes.push_back(walk.node(mesh, i));
            domain.edges[e].a = number[path.a];
            domain.edges[e].b = number[path.b];
            domain.edges[e].path = path_points(mesh, path);
            domain.edges[e].crease = domain.complex.is_crease(e);
        }
    domain.carrier = std::move(carrier);
    domain.origin = "eck";
    return domain;
}

} // namespace bot2nurbs
