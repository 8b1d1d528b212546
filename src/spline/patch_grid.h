// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/result.h"

#include <array>
#include <utility>

namespace bot2nurbs {

//! Grid index in face coordinates of the place J steps along side s and K steps into the face, on a
//! grid 0 .. m in both directions. Seen from side s, J runs from corner s to corner s + 1.
inline std::pair<Index, Index> from_side(Index s, Index along, Index depth, Index m)
{
    switch (s) {
    case 0: return {along, depth};
    case 1: return {m - depth, along};
    case 2: return {m - along, m - depth};
    default: return {depth, m - along};
    }
}

//! One row of the 13 x 6 matrix that turns a clamped quadratic spline with six controls into the
//! Bezier coefficients of its four pieces, raised to cubics. At most two controls matter.
struct ClampedRow {
    Index first;
    double weight, next_weight; //!< Of controls first and first + 1.
};

//! The same weights from either end (row 12 - i mirrors row i exactly), so that both neighbours of
//! an edge see the same numbers.
inline constexpr std::array<ClampedRow, 13> clamped_rows{{
    {0, 1.0, 0.0},
    {0, 1.0 / 3.0, 2.0 / 3.0},
    {1, 5.0 / 6.0, 1.0 / 6.0},
    {1, 0.5, 0.5},
    {1, 1.0 / 6.0, 5.0 / 6.0},
    {2, 5.0 / 6.0, 1.0 / 6.0},
    {2, 0.5, 0.5},
    {2, 1.0 / 6.0, 5.0 / 6.0},
    {3, 5.0 / 6.0, 1.0 / 6.0},
    {3, 0.5, 0.5},
    {3, 1.0 / 6.0, 5.0 / 6.0},
    {4, 2.0 / 3.0, 1.0 / 3.0},
    {4, 0.0, 1.0},
}};

} // namespace bot2nurbs
