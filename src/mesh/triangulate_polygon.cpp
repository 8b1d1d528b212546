// SPDX-License-Identifier: MIT
#include "mesh/triangulate_polygon.h"

#include "core/predicates.h"

#include <algorithm>

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

void cut_quad(const std::vector<Vec3>& positions, const std::vector<Index>& q,
              std::vector<std::array<Index, 3>>& triangles)
{
    const Vec3 normal = polygon_normal(positions, q);
    const auto good = [&](int i, int j, int k) {
        return dot(normal, cross(positions[q[j]] - positions[q[i]],
                                 positions[q[k]] - positions[q[i]])) > 0.0;
    };
    const bool across_02 = good(0, 1, 2) && good(0, 2, 3);
    const bool across_13 = good(0, 1, 3) && good(1, 2, 3);
    const bool shorter_02 = norm_squared(positions[q[2]] - positions[q[0]]) <=
                            norm_squared(positions[q[3]] - positions[q[1]]);
    if (across_02 == across_13 ? shorter_02 : across_02) {
        triangles.push_back({q[0], q[1], q[2]});
        triangles.push_back({q[0], q[2], q[3]});
    } else {
        triangles.push_back({q[0], q[1], q[3]});
        triangles.push_back({q[1], q[2], q[3]});
    }
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

//! Cuts the convex ring from..to (inclusive) in halves.
void halve(const std::vector<Index>& ring, std::size_t from, std::size_t to,
           std::vector<std::array<Index, 3>>& triangles)
{
    if (to - from < 2)
        return;
    const std::size_t middle = (from + to) / 2;
    triangles.push_back({ring[from], ring[middle], ring[to]});
    halve(ring, from, middle, triangles);
    halve(ring, middle, to, triangles);
}

void clip_ears(const std::vector<Vec3>& positions, std::vector<Index> ring, std::vector<Vec2> plane,
               std::vector<std::array<Index, 3>>& triangles)
{
    while (ring.size() > 3) {
        const std::size_t n = ring.size();
        const bool any_ear = n > small_polygon;
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
        std::size_t best = n;
        double best_shape = -1.0;
        for (std::size_t i = 0; i < n; ++i) {
            if (!is_ear(i))
                continue;
            const double s = shape(positions[ring[(i + n - 1) % n]], positions[ring[i]],
                                   positions[ring[(i + 1) % n]]);
            if (s > best_shape) {
                best = i;
                best_shape = s;
            }
            if (any_ear)
                break;
        }
        if (best == n) {
            // No ear: the polygon crosses itself or is flat. Cut the straightest corner, so that
            // corners on a line do not become faces without area while others are left.
            best = 0;
            for (std::size_t i = 0; i < n; ++i) {
                const double s = shape(positions[ring[(i + n - 1) % n]], positions[ring[i]],
                                       positions[ring[(i + 1) % n]]);
                if (s > best_shape) {
                    best = i;
                    best_shape = s;
                }
            }
        }
        triangles.push_back({ring[(best + n - 1) % n], ring[best], ring[(best + 1) % n]});
        ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(best));
        plane.erase(plane.begin() + static_cast<std::ptrdiff_t>(best));
    }
    triangles.push_back({ring[0], ring[1], ring[2]});
}

} // namespace

void triangulate_polygon(const std::vector<Vec3>& positions, const Index* corners,
                         std::size_t count, std::vector<std::array<Index, 3>>& triangles)
{
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
        cut_quad(positions, ring, triangles);
        return;
    }
    std::vector<Vec2> plane = project(positions, ring, polygon_normal(positions, ring));
    if (ring.size() > small_polygon && is_convex(plane))
        halve(ring, 0, ring.size() - 1, triangles);
    else
        clip_ears(positions, std::move(ring), std::move(plane), triangles);
}

} // namespace bot2nurbs
