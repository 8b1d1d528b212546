// SPDX-License-Identifier: MIT
#pragma once

//! The point of one triangle that is closest to a point in space.

#include "bot2nurbs/vec.h"

#include <algorithm>
#include <array>

namespace bot2nurbs {

// Sine of an angle below which a triangle counts as thin. The case distinction by barycentric
// signs loses about eps / sine^2 of the triangle's size, so here at most 1e-8; thin triangles are
// compared side by side instead, which loses nothing.
inline constexpr double thin_sine = 1e-4;

struct TriangleCorners {
    Vec3 a, b, c;
    bool thin = true;

    TriangleCorners() = default;
    TriangleCorners(const Vec3& a_, const Vec3& b_, const Vec3& c_) : a(a_), b(b_), c(c_)
    {
        const double longest =
            std::max({norm_squared(b - a), norm_squared(c - b), norm_squared(a - c)});
        thin = !(norm(cross(b - a, c - a)) > thin_sine * longest);
    }

    //! The point with barycentric weights `bary`.
    Vec3 at(const std::array<double, 3>& bary) const
    {
        // One corner or one side: no rounding from corners that do not take part.
        if (bary[0] == 1.0)
            return a;
        if (bary[1] == 1.0)
            return b;
        if (bary[2] == 1.0)
            return c;
        return bary[0] * a + bary[1] * b + bary[2] * c;
    }
};

//! By the signs of the barycentric coordinates (Ericson, Real-Time Collision Detection, 5.1.5).
inline std::array<double, 3> closest_by_signs(const Vec3& p, const TriangleCorners& t)
{
    const Vec3 ab = t.b - t.a, ac = t.c - t.a, ap = p - t.a;
    const double d1 = dot(ab, ap), d2 = dot(ac, ap);
    if (d1 <= 0.0 && d2 <= 0.0)
        return {1.0, 0.0, 0.0};
    const Vec3 bp = p - t.b;
    const double d3 = dot(ab, bp), d4 = dot(ac, bp);
    if (d3 >= 0.0 && d4 <= d3)
        return {0.0, 1.0, 0.0};
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
        const double s = d1 / (d1 - d3);
        return {1.0 - s, s, 0.0};
    }
    const Vec3 cp = p - t.c;
    const double d5 = dot(ab, cp), d6 = dot(ac, cp);
    if (d6 >= 0.0 && d5 <= d6)
        return {0.0, 0.0, 1.0};
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
        const double s = d2 / (d2 - d6);
        return {1.0 - s, 0.0, s};
    }
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
        const double s = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return {0.0, 1.0 - s, s};
    }
    const double scale = 1.0 / (va + vb + vc);
    const double v = vb * scale, w = vc * scale;
    return {1.0 - v - w, v, w};
}

//! The parameter in [0, 1] of the point of a segment that is closest to p.
inline double closest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b)
{
    const Vec3 d = b - a;
    const double length2 = norm_squared(d);
    const double t = dot(p - a, d);
    if (!(length2 > 0.0) || t <= 0.0)
        return 0.0;
    return t >= length2 ? 1.0 : t / length2;
}

//! For triangles that are nearly or exactly a segment or a point.
inline std::array<double, 3> closest_by_sides(const Vec3& p, const TriangleCorners& t)
{
    const double s = closest_on_segment(p, t.a, t.b);
    const double q = closest_on_segment(p, t.b, t.c);
    const double r = closest_on_segment(p, t.c, t.a);
    const std::array<double, 3> sides[3] = {
        {1.0 - s, s, 0.0}, {0.0, 1.0 - q, q}, {r, 0.0, 1.0 - r}};
    std::array<double, 3> best = sides[0];
    double least = norm_squared(t.at(best) - p);
    const auto offer = [&](const std::array<double, 3>& bary) {
        const double d = norm_squared(t.at(bary) - p);
        if (d < least) {
            least = d;
            best = bary;
        }
    };
    offer(sides[1]);
    offer(sides[2]);
    const std::array<double, 3> inside = closest_by_signs(p, t);
    if (inside[0] >= 0.0 && inside[1] >= 0.0 && inside[2] >= 0.0) // false for NaN
        offer(inside);
    return best;
}

//! Barycentric weights of the closest point; none below zero but for rounding.
inline std::array<double, 3> closest_on_triangle(const Vec3& p, const TriangleCorners& t)
{
    return t.thin ? closest_by_sides(p, t) : closest_by_signs(p, t);
}

} // namespace bot2nurbs
