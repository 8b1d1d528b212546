// SPDX-License-Identifier: MIT
#pragma once

//! Values of the cubic Bernstein polynomials on the 4 x 4 pieces of a patch. Parameters u, v are in
//! [0, 1] over the whole patch; piece p covers [p / 4, (p + 1) / 4], the last one closed.

#include "bot2nurbs/result.h"

#include <array>

namespace bot2nurbs {

//! Pieces of a patch in one direction.
inline constexpr Index pieces_per_side = 4;

//! The piece that holds u, clamped to the patch, and the parameter t in [0, 1] within it.
struct PieceParameter {
    Index piece;
    double t;
};
inline PieceParameter piece_parameter(double u)
{
    const double scaled = u * pieces_per_side;
    // Also sends a NaN to piece 0 instead of an undefined conversion.
    const Index piece = scaled >= 1.0 ? (scaled >= 3.0 ? 3u : static_cast<Index>(scaled)) : 0u;
    return {piece, scaled - piece};
}

using Cubic = std::array<double, 4>;

inline Cubic bernstein(double t)
{
    const double s = 1.0 - t;
    return {s * s * s, 3.0 * t * s * s, 3.0 * t * t * s, t * t * t};
}

//! First derivatives with respect to t.
inline Cubic bernstein_d(double t)
{
    const double s = 1.0 - t;
    return {-3.0 * s * s, 3.0 * s * (s - 2.0 * t), 3.0 * t * (2.0 * s - t), 3.0 * t * t};
}

//! Second derivatives with respect to t.
inline Cubic bernstein_dd(double t)
{
    const double s = 1.0 - t;
    return {6.0 * s, 6.0 * (t - 2.0 * s), 6.0 * (s - 2.0 * t), 6.0 * t};
}

//! The 16 bicubic Bernstein values of the piece that holds (u, v). Entry 4 a + b belongs to Bezier
//! coefficient (first_i + a, first_j + b) of the patch, so to stencil row
//! SplineNetwork::row(quad, first_i + a, first_j + b).
struct PieceBasis {
    Index first_i = 0, first_j = 0;
    std::array<double, 16> value;
};

//! Values with all derivatives up to order two with respect to u and v in [0, 1].
struct PieceBasis2 {
    Index first_i = 0, first_j = 0;
    std::array<double, 16> value, du, dv, duu, duv, dvv;
};

inline PieceBasis piece_basis(double u, double v)
{
    const PieceParameter pu = piece_parameter(u), pv = piece_parameter(v);
    const Cubic bu = bernstein(pu.t), bv = bernstein(pv.t);
    PieceBasis out;
    out.first_i = 3 * pu.piece;
    out.first_j = 3 * pv.piece;
    for (int a = 0; a < 4; ++a) {
        for (int b = 0; b < 4; ++b)
            out.value[4 * a + b] = bu[a] * bv[b];
    }
    return out;
}

inline PieceBasis2 piece_basis2(double u, double v)
{
    constexpr double d = pieces_per_side, dd = d * d; // chain rule of t = 4 u - piece
    const PieceParameter pu = piece_parameter(u), pv = piece_parameter(v);
    const Cubic u0 = bernstein(pu.t), u1 = bernstein_d(pu.t), u2 = bernstein_dd(pu.t);
    const Cubic v0 = bernstein(pv.t), v1 = bernstein_d(pv.t), v2 = bernstein_dd(pv.t);
    PieceBasis2 out;
    out.first_i = 3 * pu.piece;
    out.first_j = 3 * pv.piece;
    for (int a = 0; a < 4; ++a) {
        for (int b = 0; b < 4; ++b) {
            const int i = 4 * a + b;
            out.value[i] = u0[a] * v0[b];
            out.du[i] = d * (u1[a] * v0[b]);
            out.dv[i] = d * (u0[a] * v1[b]);
            out.duu[i] = dd * (u2[a] * v0[b]);
            out.duv[i] = dd * (u1[a] * v1[b]);
            out.dvv[i] = dd * (u0[a] * v2[b]);
        }
    }
    return out;
}

} // namespace bot2nurbs
