// SPDX-License-Identifier: MIT
#include "layout/catmull_clark.h"

#include "layout/quad_boundary.h"

namespace bot2nurbs {

namespace {

// What is around a vertex: sums over the quads at it.
struct Star {
    Vec3 edges;     // Other ends of the edges.
    Vec3 diagonals; // Corners opposite.
    double quads = 0.0;
    // On the boundary: its two neighbours there.
    Vec3 boundary_edges;
};

Star star_of(const SubdividedQuads& mesh, Index v)
{
    const QuadComplex& k = mesh.complex;
    Star star;
    Index h = k.halfedge_at(v);
    const Index first = h;
    do {
        star.edges += mesh.positions[k.to(h)];
        star.diagonals += mesh.positions[k.to(QuadComplex::next(h))];
        star.quads += 1.0;
        if (k.twin(h) == invalid_index)
            star.boundary_edges += mesh.positions[k.to(h)];
        const Index last = QuadComplex::prev(h);
        if (k.twin(last) == invalid_index)
            star.boundary_edges += mesh.positions[k.from(last)];
        h = k.rotate_ccw(h);
    } while (h != first && h != invalid_index);
    return star;
}

} // namespace

Result<SubdividedQuads> SubdividedQuads::refined() const
{
    const Index vertices = complex.vertex_count(), edges = complex.edge_count();
    std::vector<Vec3> p(vertices + edges + complex.quad_count());
    std::vector<std::array<Index, 4>> quads(complex.halfedge_count());
    for (Index q = 0; q < complex.quad_count(); ++q) {
        Vec3 sum;
        for (const Index v : complex.quad(q))
            sum += positions[v];
        p[vertices + edges + q] = 0.25 * sum;
        for (Index h = 4 * q; h < 4 * q + 4; ++h)
            quads[h] = {complex.from(h), vertices + complex.edge(h), vertices + edges + q,
                        vertices + complex.edge(QuadComplex::prev(h))};
    }
    for (Index e = 0; e < edges; ++e) {
        const Index h = complex.halfedge_of_edge(e), t = complex.twin(h);
        const Vec3 ends = positions[complex.from(h)] + positions[complex.to(h)];
        p[vertices + e] = t == invalid_index
                              ? 0.5 * ends
                              : 0.25 * (ends + p[vertices + edges + QuadComplex::quad_of(h)] +
                                        p[vertices + edges + QuadComplex::quad_of(t)]);
    }
    for (Index v = 0; v < vertices; ++v) {
        const Star star = star_of(*this, v);
        const double n = star.quads;
        if (!is_boundary_vertex(complex, v)) {
            // (F + 2 R + (n - 3) v) / n, with F the mean of the new face points and R that of the
            // middles of the edges.
            const Vec3 faces = (n * positions[v] + 2.0 * star.edges + star.diagonals) / (4.0 * n);
            const Vec3 middles = 0.5 * (positions[v] + star.edges / n);
            p[v] = (faces + 2.0 * middles + (n - 3.0) * positions[v]) / n;
        } else {
            p[v] = n == 1.0 ? positions[v] : 0.75 * positions[v] + 0.125 * star.boundary_edges;
        }
    }
    Result<QuadComplex> built = QuadComplex::build(static_cast<Index>(p.size()), std::move(quads));
    if (!built)
        return built.error();
    return SubdividedQuads{std::move(*built), std::move(p)};
}

std::vector<Vec3> SubdividedQuads::limit() const
{
    std::vector<Vec3> p(positions.size());
    for (Index v = 0; v < complex.vertex_count(); ++v) {
        const Star star = star_of(*this, v);
        const double n = star.quads;
        if (!is_boundary_vertex(complex, v))
            p[v] = (n * n * positions[v] + 4.0 * star.edges + star.diagonals) / (n * (n + 5.0));
        else
            p[v] = n == 1.0 ? positions[v] : (4.0 * positions[v] + star.boundary_edges) / 6.0;
    }
    return p;
}

} // namespace bot2nurbs
