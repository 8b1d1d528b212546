// SPDX-License-Identifier: MIT
#include "refine/grade_marks.h"

#include <algorithm>

namespace bot2nurbs {

namespace {

// With 2.2 a fifth more patches are needed for 0.1 % of the diagonal, without a limit some models
// do not get there (docs/algorithms/refinement.md).
constexpr double most_growth = 3.0;

// Edges around a vertex, counter-clockwise; none when one of them is sharp.
std::vector<Index> smooth_ring(const QuadComplex& complex, Index vertex)
{
    std::vector<Index> ring;
    const Index first = complex.halfedge_at(vertex);
    Index h = first;
    do {
        ring.push_back(complex.edge(h));
        if (complex.is_sharp(ring.back()))
            return {};
        h = complex.rotate_ccw(h);
    } while (h != first);
    return ring;
}

} // namespace

void grade_marks(const QuadComplex& complex, const std::vector<double>& lengths,
                 const std::vector<Index>& quads, std::vector<char>& marks)
{
    std::vector<Index> open; // Vertices to look at.
    std::vector<char> is_open(complex.vertex_count(), 0);
    const auto look_at = [&](Index v) {
        if (!is_open[v]) {
            is_open[v] = 1;
            open.push_back(v);
        }
    };
    for (const Index q : quads)
        for (const Index v : complex.quad(q))
            look_at(v);
    const auto length = [&](Index e) { return marks[e] ? 0.5 * lengths[e] : lengths[e]; };
    // A mark only makes more edges too long, so the order does not matter.
    while (!open.empty()) {
        const Index v = open.back();
        open.pop_back();
        is_open[v] = 0;
        const std::vector<Index> ring = smooth_ring(complex, v);
        const std::size_t n = ring.size();
        for (std::size_t k = 0; k < n; ++k) {
            const double opposite =
                std::max(length(ring[(k + n / 2) % n]), length(ring[(k + (n + 1) / 2) % n]));
            if (marks[ring[k]] || lengths[ring[k]] <= most_growth * opposite)
                continue;
            marks[ring[k]] = 1;
            const Index h = complex.halfedge_of_edge(ring[k]);
            look_at(complex.from(h));
            look_at(complex.to(h));
        }
    }
}

} // namespace bot2nurbs
