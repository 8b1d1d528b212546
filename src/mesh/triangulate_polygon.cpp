// SPDX-License-Identifier: MIT
#include "mesh/triangulate_polygon.h"

#include "core/predicates.h"

#include <algorithm>
#include <cmath>

namespace bot2nurbs {

namespace {

// Up to this size the best ear is looked for over all corners, convex or not: shape matters more
// than the quadratic cost.
constexpr std::size_t small_polygon = 64;

//! Twice the area vector (Newell), about the first corner so that distant polygons keep digits.
Vec3 polygon_normal(const std::vector<Vec3>& positions, const std::vector<Index>& ring)
{
    Vec3 normal;
    const Vec3 origin = positions[ring[0]];
    for (std::size_t i = 1; i + 1 < ring.size(); ++i)
        normal += cross(positions[ring[i]] - origin, positions[ring[i + 1]] - origin);
    return normal;
}

//! The projection along the largest component of the normal; keeps exact coordinates and makes
//! the polygon counter-clockwise.
std::vector<Vec2> project(const std::vector<Vec3>& positions, const std::vector<Index>& ring,
                          const Vec3& normal)
{
    int axis = 0;
    for (int k = 1; k < 3; ++k)
        if (std::abs(normal[k]) > std::abs(normal[axis]))
            axis = k;
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    if (normal[axis] < 0.0)
        std::swap(u, v);
    std::vector<Vec2> plane(ring.size());
    for (std::size_t i = 0; i < ring.size(); ++i)
        plane[i] = {positions[ring[i]][u], positions[ring[i]][v]};
    return plane;
}

//! Shape of a triangle: area over the sum of squared sides, largest for the equilateral one.
double shape(const Vec3& a, const Vec3& b, const Vec3& c)
{
    const double sides = norm_squared(b - a) + norm_squared(c - b) + norm_squared(a - c);
    return sides > 0.0 ? norm(cross(b - a, c - a)) / sides : 0.0;
}

bool is_convex(const std::vector<Vec2>& plane)
{
    const std::size_t n = plane.size();
    int x_turns = 0, direction = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const Vec2 &a = plane[i], &b = plane[(i + 1) % n], &c = plane[(i + 2) % n];
        if (orient2d(a, b, c) <= 0)
            return false;
        // A polygon that turns left everywhere is convex when it winds round once only.
        const int d = b.x > a.x ? 1 : (b.x < a.x ? -1 : direction);
        if (direction != 0 && d != direction)
            ++x_turns;
        direction = d;
    }
    return x_turns <= 3;
}

//! All triangles of the convex ring from..to (inclusive), cut in halves again and again.
void halve_ring(const std::vector<Index>& ring, std::size_t from, std::size_t to,
                std::vector<std::array<Index, 3>>& triangles)
{
    if (to - from < 2)
        return;
    const std::size_t middle = (from + to) / 2;
    triangles.push_back({ring[from], ring[middle], ring[to]});
    halve_ring(ring, from, middle, triangles);
    halve_ring(ring, middle, to, triangles);
}

//! A pair of vertices as one number, never zero for different vertices.
std::uint64_t pair_key(Index a, Index b)
{
    return std::uint64_t{std::max(a, b)} << 32 | std::min(a, b);
}

constexpr std::uint64_t no_key = 0;

//! Where the key is or would go in the table.
std::size_t find_key(const std::vector<std::uint64_t>& table, std::uint64_t key)
{
    // 2^64 / golden ratio: spreads neighbouring vertex numbers over the table.
    std::size_t i = (key * 0x9e3779b97f4a7c15ull) >> 20 & (table.size() - 1);
    while (table[i] != no_key && table[i] != key)
        i = (i + 1) & (table.size() - 1);
    return i;
}

} // namespace

PolygonTriangulator::PolygonTriangulator(const std::vector<Vec3>& positions,
                                         const PolygonList& polygons)
    : positions_(positions), polygons_(polygons)
{
    if (polygons.corners.size() <= 3 * polygons.size()) {
        // Perhaps all triangles: then there is no diagonal to choose.
        bool triangles_only = true;
        for (std::size_t p = 0; p < polygons.size() && triangles_only; ++p)
            triangles_only = polygons.first[p + 1] - polygons.first[p] <= 3;
        if (triangles_only)
            return;
    }
    // Sides and diagonals: n + (n - 3) pairs of n corners.
    std::size_t size = 64;
    while (size < 4 * polygons.corners.size())
        size *= 2;
    edges_.assign(size, no_key);
    for (std::size_t p = 0; p < polygons.size(); ++p)
        for (std::size_t i = polygons.first[p]; i < polygons.first[p + 1]; ++i)
            add_edge(polygons.corners[i],
                     polygons.corners[i + 1 < polygons.first[p + 1] ? i + 1 : polygons.first[p]]);
}

bool PolygonTriangulator::joined(Index a, Index b) const
{
    return a == b || edges_[find_key(edges_, pair_key(a, b))] != no_key;
}

void PolygonTriangulator::add_edge(Index a, Index b)
{
    if (a != b)
        edges_[find_key(edges_, pair_key(a, b))] = pair_key(a, b);
}

void PolygonTriangulator::cut_quad(const std::vector<Index>& q,
                                   std::vector<std::array<Index, 3>>& triangles)
{
    const Vec3 normal = polygon_normal(positions_, q);
    const auto good = [&](int i, int j, int k) {
        return dot(normal, cross(positions_[q[j]] - positions_[q[i]],
                                 positions_[q[k]] - positions_[q[i]])) > 0.0;
    };
    const bool free_02 = !joined(q[0], q[2]), free_13 = !joined(q[1], q[3]);
    const bool flat_02 = good(0, 1, 2) && good(0, 2, 3), flat_13 = good(0, 1, 3) && good(1, 2, 3);
    const bool shorter_02 = norm_squared(positions_[q[2]] - positions_[q[0]]) <=
                            norm_squared(positions_[q[3]] - positions_[q[1]]);
    const bool use_02 = free_02 != free_13 ? free_02 : (flat_02 != flat_13 ? flat_02 : shorter_02);
    if (use_02) {
        add_edge(q[0], q[2]);
        triangles.push_back({q[0], q[1], q[2]});
        triangles.push_back({q[0], q[2], q[3]});
    } else {
        add_edge(q[1], q[3]);
        triangles.push_back({q[0], q[1], q[3]});
        triangles.push_back({q[1], q[2], q[3]});
    }
}

bool PolygonTriangulator::halve(const std::vector<Index>& ring,
                                std::vector<std::array<Index, 3>>& triangles)
{
    std::vector<std::array<Index, 3>> cut;
    halve_ring(ring, 0, ring.size() - 1, cut);
    // The long side of every triangle but the first is a diagonal.
    for (std::size_t i = 1; i < cut.size(); ++i)
        if (joined(cut[i][0], cut[i][2]))
            return false;
    for (std::size_t i = 1; i < cut.size(); ++i)
        add_edge(cut[i][0], cut[i][2]);
    triangles.insert(triangles.end(), cut.begin(), cut.end());
    return true;
}

void PolygonTriangulator::clip_ears(std::vector<Index> ring, std::vector<Vec2> plane,
                                    std::vector<std::array<Index, 3>>& triangles)
{
    while (ring.size() > 3) {
        const std::size_t n = ring.size();
        std::vector<std::size_t> reflex;
        for (std::size_t i = 0; i < n; ++i)
            if (orient2d(plane[(i + n - 1) % n], plane[i], plane[(i + 1) % n]) <= 0)
                reflex.push_back(i);
        const auto is_ear = [&](std::size_t i) {
            const std::size_t p = (i + n - 1) % n, s = (i + 1) % n;
            if (orient2d(plane[p], plane[i], plane[s]) <= 0)
                return false;
            for (const std::size_t r : reflex) {
                if (r == p || r == i || r == s || plane[r] == plane[p] || plane[r] == plane[i] ||
                    plane[r] == plane[s])
                    continue;
                if (orient2d(plane[p], plane[i], plane[r]) >= 0 &&
                    orient2d(plane[i], plane[s], plane[r]) >= 0 &&
                    orient2d(plane[s], plane[p], plane[r]) >= 0)
                    return false;
            }
            return true;
        };
        // Best first: an ear with a free diagonal; a free diagonal; an ear. Within a rank by shape,
        // so that corners on a line do not become faces without area while others are left.
        std::size_t best = n;
        int best_rank = -1;
        double best_shape = -1.0;
        for (std::size_t i = 0; i < n; ++i) {
            const Index before = ring[(i + n - 1) % n], after = ring[(i + 1) % n];
            const int rank = (joined(before, after) ? 0 : 2) + (is_ear(i) ? 1 : 0);
            const double s = shape(positions_[before], positions_[ring[i]], positions_[after]);
            if (rank > best_rank || (rank == best_rank && s > best_shape)) {
                best = i;
                best_rank = rank;
                best_shape = s;
            }
            if (n > small_polygon && best_rank == 3)
                break;
        }
        const Index before = ring[(best + n - 1) % n], after = ring[(best + 1) % n];
        add_edge(before, after);
        triangles.push_back({before, ring[best], after});
        ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(best));
        plane.erase(plane.begin() + static_cast<std::ptrdiff_t>(best));
    }
    triangles.push_back({ring[0], ring[1], ring[2]});
}

void PolygonTriangulator::triangulate(std::size_t p, std::vector<std::array<Index, 3>>& triangles)
{
    const Index* corners = polygons_.corners.data() + polygons_.first[p];
    const std::size_t count = polygons_.first[p + 1] - polygons_.first[p];
    if (count < 3)
        return;
    if (count == 3) {
        triangles.push_back({corners[0], corners[1], corners[2]});
        return;
    }
    std::vector<Index> ring;
    ring.reserve(count);
    for (std::size_t i = 0; i < count; ++i)
        if (ring.empty() || corners[i] != ring.back())
            ring.push_back(corners[i]);
    while (ring.size() > 1 && ring.front() == ring.back())
        ring.pop_back();
    if (ring.size() < 3)
        return;
    if (ring.size() == 3) {
        triangles.push_back({ring[0], ring[1], ring[2]});
        return;
    }
    if (ring.size() == 4) {
        cut_quad(ring, triangles);
        return;
    }
    std::vector<Vec2> plane = project(positions_, ring, polygon_normal(positions_, ring));
    if (ring.size() <= small_polygon || !is_convex(plane) || !halve(ring, triangles))
        clip_ears(std::move(ring), std::move(plane), triangles);
}

} // namespace bot2nurbs
