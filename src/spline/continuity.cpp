// SPDX-License-Identifier: MIT
#include "bot2nurbs/spline_network.h"

#include "spline/bernstein.h"
#include "spline/patch_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bot2nurbs {

namespace {

//! Radians, a little below 1e-8 degrees. A normal is left out only where rounding of the
//! coefficients alone may turn it by more than this and the surface is collapsed, see below.
constexpr double angle_resolution = 1e-10;

//! Coefficients are sums of a few products, and derivatives take differences of them: off by a few
//! units in the last place of the largest coordinate.
constexpr double rounding_units = 4.0;

//! A place is collapsed where the derivatives span less than this share of an ordinary control leg.
//! Without this a model far from the origin would lose all its samples to rounding, not a few.
constexpr double collapse_ratio = 1e-3;

//! The coefficients of a join seen from one side: the curve, and the row next to it.
struct JoinSide {
    std::array<Vec3, 13> curve, next;
};

struct JoinMeasure {
    double gap = 0.0, angle = 0.0; //!< Radians.
    std::size_t undefined = 0;
};

class JoinMeter {
public:
    JoinMeter(const SplineSurface& surface, Index samples)
    {
        double largest = 0.0;
        for (const Vec3& c : surface.bezier()) {
            largest = std::max({largest, std::fabs(c.x), std::fabs(c.y), std::fabs(c.z)});
        }
        const double noise = rounding_units * std::numeric_limits<double>::epsilon() * largest;
        double legs = 0.0;
        for (Index patch = 0; patch < surface.patch_count(); ++patch) {
            for (Index i = 0; i < 12; ++i) {
                legs += norm(surface.bezier(patch, i + 1, i) - surface.bezier(patch, i, i));
            }
        }
        const double leg = legs / std::max(12.0 * surface.patch_count(), 1.0);
        least_width_ = std::min(noise / angle_resolution, std::max(collapse_ratio * leg, noise));
        const Index count = std::max<Index>(samples, 2);
        for (Index i = 0; i < count; ++i) {
            const double t = double(i) / (count - 1);
            value_.push_back(bernstein(t));
            derivative_.push_back(bernstein_d(t));
        }
    }

    //! Both sides listed in the direction of the left one's boundary.
    JoinMeasure measure(const JoinSide& left, const JoinSide& right, bool smooth) const
    {
        JoinMeasure out;
        for (Index piece = 0; piece < pieces_per_side; ++piece) {
            for (std::size_t i = 0; i < value_.size(); ++i) {
                const Vec3 *l = &left.curve[3 * piece], *r = &right.curve[3 * piece];
                const double gap = norm(sum(value_[i], l) - sum(value_[i], r));
                out.gap = std::isnan(gap) ? INFINITY : std::max(out.gap, gap);
                if (!smooth)
                    continue;
                const Vec3 along_l = sum(derivative_[i], l), along_r = sum(derivative_[i], r);
                const Vec3 into_l = difference(value_[i], &left.next[3 * piece], l);
                const Vec3 into_r = difference(value_[i], &right.next[3 * piece], r);
                const Vec3 nl = cross(along_l, into_l), nr = cross(into_r, along_r);
                if (!resolved(nl, along_l, into_l) || !resolved(nr, along_r, into_r)) {
                    ++out.undefined;
                    continue;
                }
                const Vec3 a = normalized(nl), b = normalized(nr);
                out.angle = std::max(out.angle, std::atan2(norm(cross(a, b)), dot(a, b)));
            }
        }
        return out;
    }

private:
    static Vec3 sum(const Cubic& b, const Vec3* c)
    {
        return b[0] * c[0] + b[1] * c[1] + b[2] * c[2] + b[3] * c[3];
    }
    //! A third of the derivative across the join.
    static Vec3 difference(const Cubic& b, const Vec3* next, const Vec3* curve)
    {
        return b[0] * (next[0] - curve[0]) + b[1] * (next[1] - curve[1]) +
               b[2] * (next[2] - curve[2]) + b[3] * (next[3] - curve[3]);
    }
    //! Whether the direction of n = a x b is determined. Errors of size d in a and b turn n by
    //! d (|a| + |b|) / |n| at most.
    bool resolved(const Vec3& n, const Vec3& a, const Vec3& b) const
    {
        return norm(n) > least_width_ * (norm(a) + norm(b));
    }

    std::vector<Cubic> value_, derivative_;
    double least_width_ = 0.0;
};

} // namespace

Continuity measure_continuity(const QuadComplex& complex, const SplineSurface& surface,
                              Index samples)
{
    const JoinMeter meter(surface, samples);
    constexpr double degrees = 180.0 / M_PI;
    Continuity out;
    JoinSide left, right;
    for (Index e = 0; e < complex.edge_count(); ++e) {
        if (complex.is_boundary_edge(e))
            continue;
        const Index h = complex.halfedge_of_edge(e), g = complex.twin(h);
        const auto coefficient = [&](Index halfedge, Index along, Index depth) {
            const auto [i, j] = from_side(QuadComplex::side_of(halfedge), along, depth, 12);
            return surface.bezier(QuadComplex::quad_of(halfedge), i, j);
        };
        for (Index j = 0; j < 13; ++j) {
            left.curve[j] = coefficient(h, j, 0);
            left.next[j] = coefficient(h, j, 1);
            right.curve[j] = coefficient(g, 12 - j, 0);
            right.next[j] = coefficient(g, 12 - j, 1);
        }
        const bool crease = complex.is_crease(e);
        out.crease_edges += crease;
        const JoinMeasure m = meter.measure(left, right, !crease);
        out.max_gap = std::max(out.max_gap, m.gap);
        out.undefined_normals += m.undefined;
        if (m.angle * degrees > out.max_g1_angle_deg) {
            out.max_g1_angle_deg = m.angle * degrees;
            out.worst_edge = e;
        }
    }
    for (Index patch = 0; patch < surface.patch_count(); ++patch) {
        for (Index knot : {3u, 6u, 9u}) {
            for (bool across_u : {true, false}) {
                for (Index j = 0; j < 13; ++j) {
                    const auto at = [&](Index k) {
                        return across_u ? surface.bezier(patch, k, j) : surface.bezier(patch, j, k);
                    };
                    left.curve[j] = right.curve[j] = at(knot);
                    left.next[j] = at(knot - 1);
                    right.next[j] = at(knot + 1);
                }
                const JoinMeasure m = meter.measure(left, right, true);
                out.undefined_normals += m.undefined;
                if (m.angle * degrees > out.max_inner_angle_deg) {
                    out.max_inner_angle_deg = m.angle * degrees;
                    out.worst_patch = patch;
                }
            }
        }
    }
    return out;
}

} // namespace bot2nurbs
