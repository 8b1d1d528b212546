// SPDX-License-Identifier: MIT
#include "layout/even_regions.h"

#include "core/disjoint_sets.h"

#include <algorithm>

namespace bot2nurbs {

namespace {

// A piece of a curve between two sites.
struct Piece {
    double length = 0.0;
    Index middle = invalid_index; // A vertex in its middle.
    Index a = 0, b = 0;           // The regions on its sides; the last one is the outside.
};

// The longest pieces first. A piece with one region on both sides changes nothing.
std::vector<Piece> pieces_of_curves(const LayoutLevel& level, const Tiles& tiles)
{
    const auto is_site = [&tiles](Index v) { return tiles.sites()[tiles.labels()[v]] == v; };
    std::vector<Piece> pieces;
    for (const Curve& curve : level.curves()) {
        if (curve.whole)
            continue;
        const std::vector<Vec3> point = level.points(curve);
        std::size_t from = 0;
        double half = 0.0;
        std::vector<double> arc{0.0};
        for (std::size_t i = 1; i < point.size(); ++i) {
            arc.push_back(arc.back() + norm(point[i] - point[i - 1]));
            if (!is_site(level.any_copy(curve.vertices[i])))
                continue;
            half = 0.5 * (arc[from] + arc[i]);
            std::size_t best = from + 1;
            for (std::size_t k = from + 1; k < i; ++k)
                if (std::abs(arc[k] - half) < std::abs(arc[best] - half))
                    best = k;
            if (best < i) {
                Piece piece;
                piece.length = arc[i] - arc[from];
                piece.middle = level.any_copy(curve.vertices[best]);
                std::vector<Index> side;
                level.for_each_copy(curve.vertices[best],
                                    [&](Index v) { side.push_back(level.regions()[v]); });
                piece.a = side.front();
                piece.b = side.size() > 1 ? side.back() : level.region_count();
                if (piece.a != piece.b)
                    pieces.push_back(piece);
            }
            from = i;
        }
    }
    std::stable_sort(pieces.begin(), pieces.end(),
                     [](const Piece& p, const Piece& q) { return p.length > q.length; });
    return pieces;
}

} // namespace

std::vector<Index> sites_for_even_regions(const LayoutLevel& level, const Tiles& tiles)
{
    const Index outside = level.region_count();
    std::vector<char> odd(outside + 1, 0);
    for (const Index s : tiles.sites())
        if (level.mesh().is_boundary_vertex(s))
            odd[level.regions()[s]] ^= 1;
    if (std::none_of(odd.begin(), odd.end(), [](char o) { return o != 0; }))
        return {};

    // A spanning forest, as neighbours of each region.
    std::vector<std::vector<std::pair<Index, Index>>> tree(outside + 1); // Region, vertex.
    DisjointSets sets(outside + 1);
    for (const Piece& p : pieces_of_curves(level, tiles))
        if (sets.find(p.a) != sets.find(p.b)) {
            sets.join(p.a, p.b);
            tree[p.a].emplace_back(p.b, p.middle);
            tree[p.b].emplace_back(p.a, p.middle);
        }
    // From the leaves up: an odd region asks for a site on the piece towards its parent. The
    // outside is a root, and takes any number.
    std::vector<Index> order, parent(outside + 1, invalid_index), towards(outside + 1);
    std::vector<char> seen(outside + 1, 0);
    for (Index k = 0; k <= outside; ++k) {
        const Index root = outside - k;
        if (seen[root])
            continue;
        seen[root] = 1;
        order.push_back(root);
        for (std::size_t i = order.size() - 1; i < order.size(); ++i)
            for (const auto& [next, middle] : tree[order[i]])
                if (!seen[next]) {
                    seen[next] = 1;
                    parent[next] = order[i];
                    towards[next] = middle;
                    order.push_back(next);
                }
    }
    std::vector<Index> result;
    for (auto r = order.rbegin(); r != order.rend(); ++r)
        if (odd[*r] && parent[*r] != invalid_index) {
            result.push_back(towards[*r]);
            odd[*r] = 0;
            odd[parent[*r]] ^= 1;
        }
    return result;
}

} // namespace bot2nurbs
