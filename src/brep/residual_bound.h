// SPDX-License-Identifier: MIT
#pragma once

//! The lemma both directions of the bound rest on; proof in docs/algorithms/deviation.md.
//!
//! Let w_0, w_1, w_2 be places in the unit square of a Bezier piece S, m_k points of one triangle,
//! r_k = S(w_k) - m_k, H a symmetric bilinear map, and q_ij = H(w_i - w_j, w_i - w_j) / 2. For
//! weights c_k >= 0 with sum 1 let w = sum c_k w_k and m = sum c_k m_k. Then
//!     S(w) - m = sum c_k r_k - sum_(i<j) c_i c_j q_ij + e,
//! where |e| is small of third order when H is the second derivative of S at a place near by. So
//! every w in the triangle of the w_k has a point m of the mesh that near, and every m in that of
//! the m_k a place of the surface.

#include "bot2nurbs/vec.h"

#include <array>

namespace bot2nurbs {

//! A quadratic function sum c_k r_k - sum_(i<j) c_i c_j q_ij of weights; q[k] is that of the
//! corners k and k + 1.
struct QuadraticResidual {
    std::array<Vec3, 3> r, q;
};

struct ResidualBound {
    double bound = 0.0;           //!< Of the length of the function.
    std::array<double, 3> weight; //!< Where it is about longest,
    double length = 0.0;          //!< and how long it is there.
};

//! The smaller of two bounds: by the convex hull of the function, and by its exact extremes along
//! `n`, a vector of length one or zero, with what is across bounded apart. Rounding is below 64
//! units of 2^-53 of the largest r_k or q_k.
ResidualBound residual_bound(const QuadraticResidual& f, const Vec3& n);

} // namespace bot2nurbs
