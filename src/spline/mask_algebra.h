// SPDX-License-Identifier: MIT
#pragma once

//! Dense rows over the local columns of a vertex, and the solutions of the twist equations that all
//! schemes share.

#include "bot2nurbs/result.h"

#include <vector>

namespace bot2nurbs {

using MaskRow = std::vector<double>;

//! Below this |cos(phi)| a fan counts as regular. It comes out as 6e-17 for phi = pi / 2; the next
//! default fan (valence 5) has 0.31.
inline constexpr double regular_cosine = 1e-12;

inline double alternating(Index i)
{
    return i % 2 == 0 ? 1.0 : -1.0;
}

//! row += weight * other. \pre row is not shorter
inline void add(MaskRow& row, double weight, const MaskRow& other)
{
    for (std::size_t i = 0; i < other.size(); ++i)
        row[i] += weight * other[i];
}

//! Weights w with x_i = sum_l w_l r_(i-l) a solution of x_i + x_(i-1) = r_i on a ring of n: the
//! only one for odd n; for even n the smallest one, where the alternating sum of r vanishes.
inline std::vector<double> ring_weights(Index n)
{
    std::vector<double> w(n);
    for (Index l = 0; l < n; ++l) {
        const double shape = n % 2 == 1 ? 0.5 : (double(n) - 1.0 - 2.0 * l) / (2.0 * n);
        w[l] = alternating(l) * shape;
    }
    return w;
}

//! Weight of r_m in x_i, where x_0 .. x_(k-1) is the smallest solution of x_i + x_(i-1) = r_i for
//! i = 1 .. k - 1.
inline double chain_weight(Index k, Index m, Index i)
{
    return alternating(i + m) * (double(m) / k - (m > i ? 1.0 : 0.0));
}

} // namespace bot2nurbs
