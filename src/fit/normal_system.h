// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "fit/reduced_network.h"
#include "fit/scaled_factor.h"

#include <vector>

namespace bot2nurbs {

//! One sample as a round sees it: a place on a Bezier piece and what is wanted there.
struct FitRow {
    Index piece = invalid_index;
    double s = 0.0, t = 0.0; //!< Parameters in the piece, in [0, 1].
    double weight = 0.0;
    Vec3 residual; //!< Sample minus surface point: the wanted move.
    Vec3 normal;   //!< Unit normal of the surface there; zero: all directions count alike.
    //! True: the sample is one of a curve, whose unit tangent is in place of the normal; distances
    //! across the tangent count in full, and along it with mu.
    bool of_curve = false;
    double least_mu = 0.0; //!< See RoundProblem.
};

//! Rows grouped by piece: rows of piece p are order[offset[p]] .. order[offset[p + 1] - 1], in the
//! order of the samples.
struct RowsByPiece {
    std::vector<std::size_t> offset;
    std::vector<Index> order;
};
RowsByPiece group_by_piece(const std::vector<FitRow>& rows, Index piece_count);

//! The quadratic problem of one round: rows, the current coefficients, and fairness per quad.
//!
//! Over moves d of the free unknowns it minimises
//!   sum_i w_i [(1 - mu) (n_i . (r_i - d_i))^2 + mu |r_i - d_i|^2] + sum_q f_q E_q(x + d)
//! (for rows of a curve with unit tangent t_i: |r_i - d_i|^2 - (1 - mu) (t_i . (r_i - d_i))^2),
//! with mu the problem's or, where that is larger, the row's own, d_i the surface's move at row i
//! and E_q the exact thin-plate energy of quad q.
struct RoundProblem {
    const std::vector<FitRow>* rows = nullptr;
    const RowsByPiece* groups = nullptr;
    const std::vector<Vec3>* bezier = nullptr;     //!< 169 per quad; empty: all zero.
    const std::vector<double>* fairness = nullptr; //!< f_q.
    double mu = 1.0;                               //!< 1: point-distance rows.
    //! Not null: the moves that solve the problem before this one. That differs in few quads only,
    //! so that its factor preconditions this one.
    const std::vector<Vec3>* start = nullptr;
};

//! The normal equations of a round, assembled piece by piece in Bezier coefficients and scattered
//! into a pattern that is analysed once. With mu = 1 the x, y and z parts decouple and share one
//! matrix; otherwise 3 x 3 blocks couple them in the same pattern. Cost linear in rows and pieces.
class NormalSystem {
public:
    //! Not to be used when the context was cancelled meanwhile.
    NormalSystem(const ReducedNetwork& network, const Context& context);
    NormalSystem(const NormalSystem&) = delete;
    NormalSystem& operator=(const NormalSystem&) = delete;

    Index size() const { return static_cast<Index>(plan_.size()); }
    //! Entries of the scalar factor (a 3 x 3 coupled one has nine times as many).
    std::size_t factor_entries() const { return plan_.entries; }
    //! Multiplications of one scalar factorisation; 27 times as many for a coupled one.
    double factor_work() const { return plan_.work; }

    //! Outcome of a solve: the moves, or none when the factorisation failed, the condition exceeded
    //! `condition_limit`, or the context was cancelled (ask the context).
    struct Solution {
        bool ok = false;
        std::vector<Vec3> move; //!< Per free unknown.
        double condition = 0.0; //!< Of the last factorised matrix; 0 when that is not of this kind.
    };
    Solution solve(const RoundProblem& problem, double condition_limit, const Context& context);

private:
    bool assemble(const RoundProblem& problem, bool coupled, const Context& context);
    Solution solve_decoupled(double condition_limit, const Context& context);
    Solution solve_coupled(const std::vector<Vec3>* start, double condition_limit,
                           const Context& context);
    //! Values per unknown in the order of the columns, as moves, and the other way round.
    void set_move(const Eigen::VectorXd& x, Solution& solution) const;
    Eigen::VectorXd in_columns(const std::vector<Vec3>& move) const;
    //! Solves x, y and z each with the factor of the decoupled matrix.
    Eigen::VectorXd solve_by_scalar(const Eigen::VectorXd& right, const Context& context) const;

    const ReducedNetwork& network_;
    FactorPlan plan_;
    std::vector<std::size_t> pair_offset_; //!< Per piece: first of its slots.
    std::vector<int> slot_;                //!< Per piece and pair (i <= j): entry of the pattern.
    std::vector<double> energy_;           //!< Likewise: the piece's thin-plate energy.
    std::vector<double> right_;            //!< 3 per column.
    ScaledFactor scalar_, coupled_;
    double coupled_condition_ = 0.0;
};

} // namespace bot2nurbs
