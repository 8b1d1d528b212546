// SPDX-License-Identifier: MIT
#pragma once

#include "fit/normal_system.h"

#include <array>
#include <vector>

namespace bot2nurbs {

//! Quadratic form of one piece in its k unknowns: `blocks` symmetric matrices (1: the same for x,
//! y, z; 6: xx, xy, xz, yy, yz, zz), each as its pairs i <= j row by row, and the right-hand side.
//!
//! Summing in the unknowns, not in the 16 coefficients, spares turning six matrices by the stencils
//! of every piece, which costs more than the samples do.
class PieceForm {
public:
    //! Zero; `out` has room for doubles() numbers and must outlive this.
    PieceForm(const ReducedNetwork& network, Index piece, int blocks, double* out);

    static std::size_t pairs(Index k) { return static_cast<std::size_t>(k) * (k + 1) / 2; }
    //! Size of a form of k unknowns: its blocks, then 3 k right-hand sides.
    static std::size_t doubles(Index k, int blocks) { return blocks * pairs(k) + 3ul * k; }

    //! Adds the rows of the piece. `scratch` is reused.
    void add_rows(const RoundProblem& problem, std::vector<double>& scratch);
    //! Adds the energy; `energy` has the pairs of the piece's thin-plate energy in its unknowns.
    void add_fairness(const RoundProblem& problem, const double* energy);

private:
    static constexpr std::size_t rows_at_a_time = 4; //!< As add_products() is written.
    using RowWeights = std::array<double, 6>;        //!< Of the blocks.
    void add_products(const double* products, const RowWeights* weights);

    const ReducedNetwork& network_;
    Index piece_, size_;
    int blocks_;
    double *block_, *right_;
};

} // namespace bot2nurbs
