// SPDX-License-Identifier: MIT
#include "bot2nurbs/cage_surface.h"

#include "layout/catmull_clark.h"
#include "layout/quad_names.h"

#include <utility>

namespace bot2nurbs {

namespace {

// Quads of the refined cage, at most, unless the least number of steps gives more. A step of 1/8 of
// a patch leaves chords of the surface a thousandth of a patch off where it turns by 30 degrees,
// 1/32 less than a ten-thousandth.
constexpr std::size_t most_quads = 50000;
constexpr int least_levels = 3;
constexpr int most_levels = 5;

int levels_for(std::size_t quads)
{
    int levels = least_levels;
    while (levels < most_levels && quads << (2 * (levels + 1)) <= most_quads)
        ++levels;
    return levels;
}

// Two triangles a quad, along its shorter diagonal.
std::vector<std::array<Index, 3>> triangulated(const QuadComplex& quads,
                                               const std::vector<Vec3>& positions)
{
    std::vector<std::array<Index, 3>> triangles;
    triangles.reserve(2 * quads.quads().size());
    for (const auto& [a, b, c, d] : quads.quads()) {
        if (norm(positions[a] - positions[c]) <= norm(positions[b] - positions[d])) {
            triangles.push_back({a, b, c});
            triangles.push_back({a, c, d});
        } else {
            triangles.push_back({a, b, d});
            triangles.push_back({b, c, d});
        }
    }
    return triangles;
}

// The edges of the cage as chains of vertices of the refined one.
std::vector<DomainEdge> edges_of(const QuadComplex& cage, const QuadComplex& refined, int levels)
{
    std::vector<DomainEdge> edges(cage.edge_count());
    std::vector<Index> chain, next;
    for (Index e = 0; e < cage.edge_count(); ++e) {
        const Index h = cage.halfedge_of_edge(e);
        edges[e].a = cage.from(h);
        edges[e].b = cage.to(h);
        chain.assign(1, h);
        for (int level = 0; level < levels; ++level) {
            next.clear();
            for (const Index g : chain)
                for (const Index part : refined_halfedge(g))
                    next.push_back(part);
            std::swap(chain, next);
        }
        for (std::size_t i = 1; i < chain.size(); ++i) {
            const Index v = refined.from(chain[i]);
            edges[e].path.push_back({v, v, 0.0});
        }
    }
    return edges;
}

} // namespace

Result<CageSurface> cage_surface(const QuadMesh& cage, Context& context)
{
    Result<QuadComplex> complex =
        QuadComplex::build(static_cast<Index>(cage.positions.size()), cage.quads);
    if (!complex)
        return complex.error();
    if (const Status failed = check_valences(*complex, cage))
        return *failed;
    CageSurface result;
    result.levels = levels_for(cage.quads.size());
    SubdividedQuads quads{*complex, cage.positions};
    for (int level = 0; level < result.levels; ++level) {
        if (context.cancelled())
            return Context::cancelled_error("layout");
        Result<SubdividedQuads> refined = quads.refined();
        if (!refined)
            return refined.error();
        quads = std::move(*refined);
    }
    std::vector<Vec3> positions = quads.limit();
    std::vector<std::array<Index, 3>> triangles = triangulated(quads.complex, positions);
    result.quad_of_face.resize(triangles.size());
    for (std::size_t f = 0; f < triangles.size(); ++f)
        result.quad_of_face[f] = static_cast<Index>((f / 2) >> (2 * result.levels));
    Result<ManifoldMesh> mesh = ManifoldMesh::build(std::move(positions), std::move(triangles));
    if (!mesh)
        return mesh.error();
    result.mesh = std::move(*mesh);
    const Vec3 side = result.mesh.box().max - result.mesh.box().min;
    if (!(norm(side) > 0.0))
        return Error{ErrorCode::bad_geometry, "all vertices of the cage are at one place",
                     invalid_index};
    QuadDomain& domain = result.domain;
    domain.source_signature = signature(result.mesh);
    domain.carrier = CarrierMesh::from_source(result.mesh);
    for (Index v = 0; v < complex->vertex_count(); ++v)
        domain.vertices.push_back(v);
    domain.edges = edges_of(*complex, quads.complex, result.levels);
    domain.complex = std::move(*complex);
    domain.origin = "cage";
    return result;
}

} // namespace bot2nurbs
