// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "bot2nurbs/spline_network.h"

#include <vector>

namespace bot2nurbs {

//! A spline network with its constraint rows eliminated, cut into Bezier pieces.
//!
//! Piece p = 16 q + 4 a + b is the bicubic Bezier patch over [a, a + 1] x [b, b + 1] of quad q's
//! parameter square [0, 4]^2. Its 16 coefficients (i, j), numbered 4 i + j, are fixed combinations
//! of a few of the *free* unknowns; any values of the free unknowns satisfy the constraints.
class ReducedNetwork {
public:
    //! Eliminates the largest coefficient of every constraint row (ties: the smallest unknown).
    //! Errors: fit_failed when two rows share an unknown or a row is zero, cancelled. Cost
    //! O(stencil entries).
    static Result<ReducedNetwork> build(const SplineNetwork& network, const Context& context);

    static constexpr Index pieces_per_quad = 16;
    static constexpr int coefficients = 16;

    Index free_count() const { return static_cast<Index>(free_.size()); }
    Index piece_count() const { return static_cast<Index>(offset_.size() - 1); }
    //! Number of free unknowns of a piece.
    Index piece_size(Index p) const { return static_cast<Index>(offset_[p + 1] - offset_[p]); }
    //! The free unknowns of a piece, ascending.
    const Index* piece_unknowns(Index p) const { return unknown_.data() + offset_[p]; }
    //! Weights of a piece: coefficient c, k-th unknown at [piece_size(p) * c + k].
    const double* piece_weights(Index p) const
    {
        return weight_.data() + static_cast<std::size_t>(coefficients) * offset_[p];
    }
    //! All unknowns of the network for given free ones. Satisfies the constraints to rounding.
    std::vector<Vec3> expand(const std::vector<Vec3>& free) const;
    //! 1 for unknowns that move with a translation, 0 for vectors; per free unknown.
    char is_point(Index free) const { return is_point_[free_[free]]; }

private:
    std::vector<Index> free_; //!< Per free unknown: the network's unknown.
    std::vector<char> is_point_;
    SparseRows eliminated_; //!< Per eliminated unknown: its combination of free ones.
    std::vector<Index> eliminated_unknown_;
    std::vector<std::size_t> offset_{0};
    std::vector<Index> unknown_;
    std::vector<double> weight_;
};

//! Place of coefficient i of a piece in SplineSurface::bezier().
inline std::size_t bezier_index(Index piece, Index i)
{
    const Index q = piece / 16, a = piece % 16 / 4, b = piece % 4;
    return 169 * static_cast<std::size_t>(q) + 13 * (3 * a + i / 4) + 3 * b + i % 4;
}

} // namespace bot2nurbs
