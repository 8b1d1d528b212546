// SPDX-License-Identifier: MIT
#include "brep/bspline.h"

#include <algorithm>

namespace bot2nurbs {

BasisValues bspline_basis(const std::vector<double>& knots, int order, Index count, double t)
{
    const int degree = order - 1;
    t = std::clamp(t, domain_start(knots, order), domain_end(knots, count));
    // Span k: knots[k] <= t < knots[k + 1], and the last span that is not empty at the end.
    const auto begin = knots.begin() + order - 2, end = knots.begin() + count;
    Index k = static_cast<Index>(std::upper_bound(begin, end, t) - knots.begin());
    if (k >= count)
        k = static_cast<Index>(std::lower_bound(begin, end, t) - knots.begin());
    --k;

    BasisValues b;
    b.first = k + 2 - static_cast<Index>(order);
    std::array<double, max_spline_order> left{}, right{}, lower{};
    b.value[0] = 1.0;
    for (int j = 1; j <= degree; ++j) {
        lower = b.value;
        left[j] = t - knots[k + 1 - j];
        right[j] = knots[k + j] - t;
        double carry = 0.0;
        for (int r = 0; r < j; ++r) {
            const double share = b.value[r] / (right[r + 1] + left[j - r]);
            b.value[r] = carry + right[r + 1] * share;
            carry = left[j - r] * share;
        }
        b.value[j] = carry;
    }
    // Derivatives from the values of degree - 1.
    for (int j = 0; j <= degree && degree > 0; ++j) {
        double d = 0.0;
        if (j > 0)
            d += lower[j - 1] / (knots[b.first + j + degree - 1] - knots[b.first + j - 1]);
        if (j < degree)
            d -= lower[j] / (knots[b.first + j + degree] - knots[b.first + j]);
        b.derivative[j] = degree * d;
    }
    return b;
}

Vec3 evaluate_curve(const BrepCurve3& curve, double t)
{
    const BasisValues b =
        bspline_basis(curve.knots, curve.order, static_cast<Index>(curve.control.size()), t);
    Vec3 p;
    for (int i = 0; i < curve.order; ++i)
        p += b.value[i] * curve.control[b.first + i];
    return p;
}

PatchPoint evaluate_patch(const BsplinePatch& patch, double u, double v)
{
    const BasisValues a = bspline_basis(patch.knots, patch_order, patch.size, u);
    const BasisValues b = bspline_basis(patch.knots, patch_order, patch.size, v);
    PatchPoint p;
    for (int i = 0; i < patch_order; ++i) {
        const Vec3* row = &patch.control[(a.first + i) * patch.size + b.first];
        Vec3 value, derivative;
        for (int j = 0; j < patch_order; ++j) {
            value += b.value[j] * row[j];
            derivative += b.derivative[j] * row[j];
        }
        p.position += a.value[i] * value;
        p.du += a.derivative[i] * value;
        p.dv += a.value[i] * derivative;
    }
    return p;
}

Index side_control(Index size, Index side, Index k)
{
    const Index last = size - 1;
    switch (side) {
    case 0: return k * size;
    case 1: return last * size + k;
    case 2: return (last - k) * size + last;
    default: return last - k;
    }
}

} // namespace bot2nurbs
