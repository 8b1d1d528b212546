// SPDX-License-Identifier: MIT
#include "brep/residual_bound.h"

#include <algorithm>
#include <cmath>

namespace bot2nurbs {

namespace {

//! Below this ratio of determinant to squared trace a critical point is not computed: the function
//! is then so flat in one direction that it takes about the same value on a side.
constexpr double nearly_flat = 1e-6;
//! How far outside the triangle a computed critical point may be that is inside: its relative error
//! is below rounding divided by `nearly_flat`.
constexpr double inside_slack = 1e-8;

//! f = sum c_k r[k] - sum c_k c_(k+1) q[k], and the largest |f| met with.
struct ScalarQuadratic {
    std::array<double, 3> r, q;

    double largest = -1.0;
    std::array<double, 3> weight{1.0, 0.0, 0.0};

    double value(const std::array<double, 3>& c) const
    {
        return c[0] * r[0] + c[1] * r[1] + c[2] * r[2] - c[0] * c[1] * q[0] - c[1] * c[2] * q[1] -
               c[2] * c[0] * q[2];
    }
    void offer(const std::array<double, 3>& c)
    {
        const double length = std::abs(value(c));
        if (!(length <= largest)) {
            largest = length;
            weight = c;
        }
    }
};

} // namespace

ResidualBound residual_bound(const QuadraticResidual& f, const Vec3& n)
{
    ScalarQuadratic along;
    double across_r = 0.0, across_q = 0.0;
    for (int k = 0; k < 3; ++k) {
        along.r[k] = dot(n, f.r[k]);
        along.q[k] = dot(n, f.q[k]);
        across_r = std::max(across_r, norm_squared(f.r[k] - along.r[k] * n));
        across_q = std::max(across_q, norm_squared(f.q[k] - along.q[k] * n));
    }
    // sum_(i<j) c_i c_j is at most 1/3.
    const double across = std::sqrt(across_r) + std::sqrt(across_q) / 3.0;

    for (int k = 0; k < 3; ++k) {
        const int j = (k + 1) % 3;
        std::array<double, 3> c{};
        c[k] = 1.0;
        along.offer(c);
        // (1 - t) r_k + t r_j - t (1 - t) q_k.
        const double t = 0.5 * (1.0 + (along.r[k] - along.r[j]) / along.q[k]);
        if (t > 0.0 && t < 1.0) {
            c[k] = 1.0 - t;
            c[j] = t;
            along.offer(c);
        }
    }
    // In x = c_1, y = c_2: gradient (gx, gy) at the corner, Hessian (2 a, b; b, 2 d).
    const double a = along.q[0], d = along.q[2], b = a + d - along.q[1];
    const double gx = along.r[1] - along.r[0] - a, gy = along.r[2] - along.r[0] - d;
    const double det = 4.0 * a * d - b * b, trace = 2.0 * (a + d);
    double missed = 0.0;
    if (det > nearly_flat * trace * trace) {
        double x = (b * gy - 2.0 * d * gx) / det, y = (b * gx - 2.0 * a * gy) / det;
        if (x > -inside_slack && y > -inside_slack && x + y < 1.0 + inside_slack) {
            x = std::clamp(x, 0.0, 1.0);
            y = std::clamp(y, 0.0, 1.0 - x);
            along.offer({1.0 - x - y, x, y});
            // Both this place and the exact one are in the triangle; the function is convex or
            // concave, so they differ by the gradient here at most.
            missed =
                2.0 * (std::abs(gx + 2.0 * a * x + b * y) + std::abs(gy + b * x + 2.0 * d * y));
        }
    } else if (det > 0.0) {
        // From the critical point to a side along the flat direction: 2 det / trace bounds the
        // smaller eigenvalue, and the way is at most sqrt(2) long.
        missed = 2.0 * det / std::abs(trace);
    }
    const double most_along = along.largest + missed;
    // The control points of the function: corners and, with twice the weight, middles.
    double hull = 0.0;
    for (int k = 0; k < 3; ++k) {
        hull = std::max(hull, norm_squared(f.r[k]));
        hull = std::max(hull, norm_squared(0.5 * (f.r[k] + f.r[(k + 1) % 3] - f.q[k])));
    }
    ResidualBound out;
    out.bound = std::sqrt(std::min(most_along * most_along + across * across, hull));
    out.weight = along.weight;
    const auto& c = along.weight;
    out.length = norm(c[0] * f.r[0] + c[1] * f.r[1] + c[2] * f.r[2] - (c[0] * c[1]) * f.q[0] -
                      (c[1] * c[2]) * f.q[1] - (c[2] * c[0]) * f.q[2]);
    for (int k = 0; k < 3; ++k) {
        const double length = norm(f.r[k]);
        if (length > out.length) {
            out.length = length;
            out.weight = {};
            out.weight[k] = 1.0;
        }
    }
    return out;
}

} // namespace bot2nurbs
