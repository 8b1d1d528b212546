// SPDX-License-Identifier: MIT
#include "fit/normal_system.h"

#include "core/parallel.h"
#include "fit/bernstein_gram.h"
#include "fit/piece_form.h"

#include <algorithm>

namespace bot2nurbs {

namespace {

//! Pieces assembled in parallel before their blocks are added to the matrix in piece order.
constexpr Index batch_pieces = 512;
constexpr Index chunk_pieces = 16;
//! Conjugate gradients with the factor of nearly the same matrix: at most as many iterations as
//! cost half a factorisation. Where most of the move is at a spike, 1e-2 of it would spoil what is
//! elsewhere (FitNetwork.one_spot_that_folds_does_not_stop_the_rest).
constexpr GradientLimits with_other_factor{20, 1e-3};
//! With the factor, in single precision, of the matrix itself: a few iterations make up for its
//! rounding. If that takes more, the matrix needs a factor in double precision.
constexpr GradientLimits with_own_factor{12, 1e-8};

} // namespace

RowsByPiece group_by_piece(const std::vector<FitRow>& rows, Index piece_count)
{
    RowsByPiece groups;
    groups.offset.assign(static_cast<std::size_t>(piece_count) + 1, 0);
    for (const FitRow& row : rows)
        ++groups.offset[row.piece + 1];
    for (std::size_t p = 0; p < piece_count; ++p)
        groups.offset[p + 1] += groups.offset[p];
    groups.order.resize(rows.size());
    std::vector<std::size_t> next(groups.offset.begin(), groups.offset.end() - 1);
    for (std::size_t i = 0; i < rows.size(); ++i)
        groups.order[next[rows[i].piece]++] = static_cast<Index>(i);
    return groups;
}

NormalSystem::NormalSystem(const ReducedNetwork& network, const Context& context)
    : network_(network), scalar_(plan_, 1), coupled_(plan_, 3)
{
    std::vector<std::vector<int>> neighbours(network.free_count());
    for (Index p = 0; p < network.piece_count(); ++p) {
        const Index k = network.piece_size(p), *u = network.piece_unknowns(p);
        for (Index i = 0; i < k; ++i)
            for (Index j = 0; j < k; ++j)
                neighbours[u[i]].push_back(static_cast<int>(u[j]));
    }
    if (context.cancelled())
        return;
    for (std::size_t i = 0; i < neighbours.size(); ++i) {
        std::vector<int>& list = neighbours[i];
        list.push_back(static_cast<int>(i)); // An unknown no piece uses still has a diagonal.
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
    }
    if (context.cancelled())
        return;
    plan_ = FactorPlan(neighbours, context);
    if (context.cancelled())
        return;
    pair_offset_.assign(1, 0);
    for (Index p = 0; p < network.piece_count(); ++p) {
        const Index k = network.piece_size(p), *u = network.piece_unknowns(p);
        const Eigen::Map<const Eigen::Matrix<double, 16, Eigen::Dynamic, Eigen::RowMajor>> weights(
            network.piece_weights(p), 16, k);
        const Eigen::MatrixXd energy = weights.transpose() * thin_plate_matrix() * weights;
        for (Index i = 0; i < k; ++i)
            for (Index j = i; j < k; ++j) {
                slot_.push_back(plan_.slot(static_cast<int>(u[i]), static_cast<int>(u[j])));
                energy_.push_back(energy(i, j));
            }
        pair_offset_.push_back(slot_.size());
    }
}

bool NormalSystem::assemble(const RoundProblem& problem, bool coupled, const Context& context)
{
    const int blocks = coupled ? 6 : 1;
    std::vector<double>& values = (coupled ? coupled_ : scalar_).values();
    values.assign(plan_.row.size() * blocks, 0.0);
    right_.assign(3 * plan_.place.size(), 0.0);
    const Index pieces = network_.piece_count();
    // Per piece of a batch: its upper blocks pair by pair, then its right-hand side.
    std::vector<double> local;
    std::vector<std::size_t> local_offset;
    for (Index begin = 0; begin < pieces; begin += batch_pieces) {
        const Index end = std::min(pieces, begin + batch_pieces);
        local_offset.assign(1, 0);
        for (Index p = begin; p < end; ++p) {
            const Index k = network_.piece_size(p);
            local_offset.push_back(local_offset.back() + PieceForm::doubles(k, blocks));
        }
        local.resize(local_offset.back());
        const bool finished = for_each_chunk(
            context, end - begin, chunk_pieces, [&](std::size_t first, std::size_t last) {
                std::vector<double> scratch;
                for (std::size_t o = first; o < last; ++o) {
                    const Index p = begin + static_cast<Index>(o);
                    PieceForm form(network_, p, blocks, local.data() + local_offset[o]);
                    form.add_rows(problem, scratch);
                    form.add_fairness(problem, energy_.data() + pair_offset_[p]);
                }
            });
        if (!finished)
            return false;
        for (Index p = begin; p < end; ++p) {
            const double* in = local.data() + local_offset[p - begin];
            const std::size_t pairs = pair_offset_[p + 1] - pair_offset_[p];
            for (std::size_t e = 0; e < pairs; ++e)
                for (int m = 0; m < blocks; ++m)
                    values[static_cast<std::size_t>(slot_[pair_offset_[p] + e]) * blocks + m] +=
                        in[m * pairs + e];
            in += blocks * pairs;
            for (Index i = 0; i < network_.piece_size(p); ++i)
                for (int c = 0; c < 3; ++c)
                    right_[3 * plan_.place[network_.piece_unknowns(p)[i]] + c] += *in++;
        }
    }
    return true;
}

NormalSystem::Solution NormalSystem::solve(const RoundProblem& problem, double condition_limit,
                                           const Context& context)
{
    const bool coupled = problem.mu < 1.0;
    if (!assemble(problem, coupled, context))
        return {};
    return coupled ? solve_coupled(problem.start, condition_limit, context)
                   : solve_decoupled(condition_limit, context);
}

NormalSystem::Solution NormalSystem::solve_decoupled(double condition_limit, const Context& context)
{
    Solution solution;
    if (!scalar_.factorize(ScaledFactor::Precision::full, context) || context.cancelled())
        return solution;
    solution.condition = scalar_.condition(context);
    if (!(solution.condition <= condition_limit)) {
        scalar_.drop_factor();
        return solution;
    }
    const Eigen::VectorXd x = solve_by_scalar(
        Eigen::Map<const Eigen::VectorXd>(right_.data(), 3 * scalar_.size()), context);
    if (!context.cancelled())
        set_move(x, solution);
    return solution;
}

void NormalSystem::set_move(const Eigen::VectorXd& x, Solution& solution) const
{
    solution.move.resize(plan_.place.size());
    for (std::size_t i = 0; i < plan_.place.size(); ++i) {
        const Eigen::Index at = 3 * static_cast<Eigen::Index>(plan_.place[i]);
        solution.move[i] = {x[at], x[at + 1], x[at + 2]};
    }
    solution.ok = true;
}

Eigen::VectorXd NormalSystem::in_columns(const std::vector<Vec3>& move) const
{
    Eigen::VectorXd x(coupled_.size());
    for (std::size_t i = 0; i < plan_.place.size(); ++i)
        x.segment<3>(3 * static_cast<Eigen::Index>(plan_.place[i])) << move[i].x, move[i].y,
            move[i].z;
    return x;
}

Eigen::VectorXd NormalSystem::solve_by_scalar(const Eigen::VectorXd& right,
                                              const Context& context) const
{
    using Columns = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
    const Eigen::Index n = scalar_.size();
    Eigen::VectorXd x(3 * n);
    Eigen::Map<Columns>(x.data(), n, 3) =
        scalar_.solve_three(Eigen::Map<const Columns>(right.data(), n, 3), context);
    return x;
}

NormalSystem::Solution NormalSystem::solve_coupled(const std::vector<Vec3>* start,
                                                   double condition_limit, const Context& context)
{
    const Eigen::VectorXd right = Eigen::Map<const Eigen::VectorXd>(right_.data(), coupled_.size());
    const Eigen::VectorXd first =
        start != nullptr ? in_columns(*start) : Eigen::VectorXd::Zero(coupled_.size());
    const auto by_coupled = [&](const Eigen::VectorXd& r) { return coupled_.solve(r, context); };
    const auto by_scalar = [&](const Eigen::VectorXd& r) { return solve_by_scalar(r, context); };
    Solution solution;
    std::optional<Eigen::VectorXd> x;
    // From round to round the rows of samples that slide change too much for the factor of the
    // last. In the first, rows are not far from those of the decoupled problem.
    if (coupled_.has_factor() && start != nullptr) {
        x = conjugate_gradients(coupled_, right, first, with_other_factor, by_coupled, context);
        solution.condition = coupled_condition_;
    } else if (!coupled_.has_factor() && scalar_.has_factor()) {
        x = conjugate_gradients(coupled_, right, first, with_other_factor, by_scalar, context);
    }
    for (const auto precision : {ScaledFactor::Precision::single, ScaledFactor::Precision::full}) {
        if (x || context.cancelled())
            break;
        if (!coupled_.factorize(precision, context))
            continue;
        solution.condition = coupled_condition_ = coupled_.condition(context);
        if (!(solution.condition <= condition_limit)) {
            coupled_.drop_factor();
            return solution;
        }
        x = conjugate_gradients(coupled_, right, first, with_own_factor, by_coupled, context);
    }
    if (x && !context.cancelled())
        set_move(*x, solution);
    return solution;
}

} // namespace bot2nurbs
