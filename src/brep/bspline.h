// SPDX-License-Identifier: MIT
#pragma once

//! Evaluation of B-splines in the knot convention of openNURBS: `count + order - 2` knots, domain
//! from knots[order - 2] to knots[count - 1].

#include "bot2nurbs/brep.h"

#include <array>

namespace bot2nurbs {

//! Largest order evaluated; curves above it are a defect.
inline constexpr int max_spline_order = 8;

//! The basis functions that do not vanish at a parameter, and their first derivatives.
struct BasisValues {
    Index first = 0; //!< Control point of value[0].
    std::array<double, max_spline_order> value{}, derivative{};
};

//! Values at t, clamped to the domain. At a knot the span to its right is used (at the end of the
//! domain, the span to its left). \pre knots are valid for count and order
BasisValues bspline_basis(const std::vector<double>& knots, int order, Index count, double t);

Vec3 evaluate_curve(const BrepCurve3& curve, double t);

//! Position and first derivatives of a patch with respect to its knot parameters.
struct PatchPoint {
    Vec3 position, du, dv;
};
PatchPoint evaluate_patch(const BsplinePatch& patch, double u, double v);

//! Order of a BsplinePatch in both directions.
inline constexpr int patch_order = 4;

inline double domain_start(const std::vector<double>& knots, int order)
{
    return knots[order - 2];
}
inline double domain_end(const std::vector<double>& knots, Index count)
{
    return knots[count - 1];
}

//! Index in BsplinePatch::control of the k-th control point of a side, counter-clockwise around the
//! patch; side 0 is v = low, 1 is u = high, 2 is v = high, 3 is u = low.
Index side_control(Index size, Index side, Index k);

} // namespace bot2nurbs
