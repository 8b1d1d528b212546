// SPDX-License-Identifier: MIT
#include "fit/normal_system.h"

#include "core/parallel.h"
#include "fit/bernstein_gram.h"
#include "spline/bernstein.h"

#include <Eigen/OrderingMethods>
#include <algorithm>
#include <array>

namespace bot2nurbs {

namespace {

//! Pieces assembled in parallel before their blocks are added to the matrix in piece order.
constexpr Index batch_pieces = 512;
constexpr Index chunk_pieces = 16;
//! Conjugate gradients with the factor of an earlier round: at most this many iterations, which
//! cost about as much as half a factorisation, down to this share of the preconditioned residual:
//! far below what moving feet change about a round.
constexpr int reuse_iterations = 30;
constexpr double reuse_tolerance = 1e-4;
//! Coefficient pairs (i <= j) of a piece.
constexpr int pairs16 = 136;

std::size_t pair_count(Index k)
{
    return static_cast<std::size_t>(k) * (k + 1) / 2;
}

//! Quadratic form of one piece in its 16 coefficients: `blocks` symmetric matrices (1: the same
//! for x, y, z; 6: xx, xy, xz, yy, yz, zz), as full 16 x 16 arrays, and the right-hand side.
struct PieceForm {
    std::array<Matrix16, 6> block;
    Eigen::Matrix<double, 16, 3> right;
};

void accumulate_rows(const RoundProblem& problem, Index piece, int blocks, PieceForm& form)
{
    double upper[6][pairs16] = {};
    double right[16][3] = {};
    const double mu = problem.mu;
    for (std::size_t o = problem.groups->offset[piece]; o < problem.groups->offset[piece + 1];
         ++o) {
        const FitRow& row = (*problem.rows)[problem.groups->order[o]];
        const Cubic bs = bernstein(row.s), bt = bernstein(row.t);
        double phi[16];
        for (int i = 0; i < 16; ++i)
            phi[i] = bs[i / 4] * bt[i % 4];
        const Vec3 &n = row.normal, &r = row.residual;
        // A row without a normal counts in full in every direction.
        const double along = n == Vec3{} ? 0.0 : (1.0 - mu) * row.weight;
        const double all = n == Vec3{} ? row.weight : mu * row.weight;
        const Vec3 wanted = along * dot(n, r) * n + all * r;
        for (int i = 0; i < 16; ++i)
            for (int c = 0; c < 3; ++c)
                right[i][c] += phi[i] * wanted[c];
        if (blocks == 1) {
            int e = 0;
            for (int i = 0; i < 16; ++i) {
                const double w = row.weight * phi[i];
                for (int j = i; j < 16; ++j, ++e)
                    upper[0][e] += w * phi[j];
            }
            continue;
        }
        const double w[6] = {along * n.x * n.x + all, along * n.x * n.y, along * n.x * n.z,
                             along * n.y * n.y + all, along * n.y * n.z, along * n.z * n.z + all};
        double product[pairs16];
        int e = 0;
        for (int i = 0; i < 16; ++i)
            for (int j = i; j < 16; ++j, ++e)
                product[e] = phi[i] * phi[j];
        for (int k = 0; k < 6; ++k)
            for (int m = 0; m < pairs16; ++m)
                upper[k][m] += w[k] * product[m];
    }
    for (int k = 0; k < blocks; ++k) {
        int e = 0;
        for (int i = 0; i < 16; ++i)
            for (int j = i; j < 16; ++j, ++e)
                form.block[k](i, j) = form.block[k](j, i) = upper[k][e];
    }
    for (int i = 0; i < 16; ++i)
        for (int c = 0; c < 3; ++c)
            form.right(i, c) = right[i][c];
}

void add_fairness(const RoundProblem& problem, Index piece, int blocks, PieceForm& form)
{
    const Index q = piece / ReducedNetwork::pieces_per_quad;
    const double f = (*problem.fairness)[q];
    const Matrix16& energy = thin_plate_matrix();
    form.block[0] += f * energy;
    if (blocks == 6) {
        form.block[3] += f * energy;
        form.block[5] += f * energy;
    }
    if (problem.bezier->empty())
        return;
    Eigen::Matrix<double, 16, 3> x;
    for (Index i = 0; i < 16; ++i) {
        const Vec3& p = (*problem.bezier)[bezier_index(piece, i)];
        x.row(i) << p.x, p.y, p.z;
    }
    form.right.noalias() -= f * (energy * x);
}

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
    : network_(network)
{
    const int n = static_cast<int>(network.free_count());
    std::vector<std::vector<int>> neighbours(n);
    for (Index p = 0; p < network.piece_count(); ++p) {
        const Index k = network.piece_size(p), *u = network.piece_unknowns(p);
        for (Index i = 0; i < k; ++i)
            for (Index j = 0; j < k; ++j)
                neighbours[u[i]].push_back(static_cast<int>(u[j]));
    }
    if (context.cancelled())
        return;
    std::vector<Eigen::Triplet<double, int>> entries;
    for (int i = 0; i < n; ++i) {
        std::vector<int>& list = neighbours[i];
        list.push_back(i); // An unknown no piece uses still has a diagonal.
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
        for (const int j : list)
            entries.emplace_back(j, i, 1.0);
    }
    if (context.cancelled())
        return;
    ScaledFactor::Matrix pattern(n, n);
    pattern.setFromTriplets(entries.begin(), entries.end());
    Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
    Eigen::AMDOrdering<int>()(pattern, order);
    place_.resize(n);
    for (int i = 0; i < n; ++i)
        place_[order.indices()[i]] = i;

    if (context.cancelled())
        return;
    std::vector<std::vector<int>> upper(n);
    for (int i = 0; i < n; ++i)
        for (const int j : neighbours[i])
            if (place_[j] <= place_[i])
                upper[place_[i]].push_back(place_[j]);
    column_.assign(1, 0);
    for (std::vector<int>& list : upper) {
        std::sort(list.begin(), list.end());
        row_.insert(row_.end(), list.begin(), list.end());
        column_.push_back(static_cast<int>(row_.size()));
    }

    pair_offset_.assign(1, 0);
    for (Index p = 0; p < network.piece_count(); ++p) {
        const Index k = network.piece_size(p), *u = network.piece_unknowns(p);
        for (Index i = 0; i < k; ++i)
            for (Index j = i; j < k; ++j) {
                const int col = std::max(place_[u[i]], place_[u[j]]);
                const int row = std::min(place_[u[i]], place_[u[j]]);
                const auto first = row_.begin() + column_[col];
                const auto last = row_.begin() + column_[col + 1];
                slot_.push_back(
                    static_cast<int>(std::lower_bound(first, last, row) - row_.begin()));
            }
        pair_offset_.push_back(slot_.size());
    }

    if (context.cancelled())
        return;
    // Column counts of the factor by the row-subtree walk, for the cost rule and reports.
    std::vector<int> parent(n, -1), mark(n, -1);
    std::vector<std::size_t> count(n, 1);
    for (int col = 0; col < n; ++col) {
        mark[col] = col;
        for (int e = column_[col]; e < column_[col + 1]; ++e)
            for (int i = row_[e]; mark[i] != col; i = parent[i]) {
                if (parent[i] < 0)
                    parent[i] = col;
                ++count[i];
                mark[i] = col;
            }
    }
    for (const std::size_t c : count) {
        factor_entries_ += c;
        factor_work_ += static_cast<double>(c) * static_cast<double>(c);
    }
}

bool NormalSystem::assemble(const RoundProblem& problem, bool coupled, const Context& context)
{
    const int blocks = coupled ? 6 : 1;
    value_.assign(row_.size() * blocks, 0.0);
    right_.assign(3 * place_.size(), 0.0);
    const Index pieces = network_.piece_count();
    // Per piece of a batch: its upper blocks pair by pair, then its right-hand side.
    std::vector<double> local;
    std::vector<std::size_t> local_offset;
    for (Index begin = 0; begin < pieces; begin += batch_pieces) {
        const Index end = std::min(pieces, begin + batch_pieces);
        local_offset.assign(1, 0);
        for (Index p = begin; p < end; ++p) {
            const Index k = network_.piece_size(p);
            local_offset.push_back(local_offset.back() + blocks * pair_count(k) + 3 * k);
        }
        local.resize(local_offset.back());
        const bool finished = for_each_chunk(
            context, end - begin, chunk_pieces, [&](std::size_t first, std::size_t last) {
                PieceForm form;
                Eigen::Matrix<double, 16, Eigen::Dynamic> half;
                Eigen::MatrixXd block;
                for (std::size_t o = first; o < last; ++o) {
                    const Index p = begin + static_cast<Index>(o);
                    accumulate_rows(problem, p, blocks, form);
                    add_fairness(problem, p, blocks, form);
                    const Index k = network_.piece_size(p);
                    const Eigen::Map<
                        const Eigen::Matrix<double, 16, Eigen::Dynamic, Eigen::RowMajor>>
                        weights(network_.piece_weights(p), 16, k);
                    double* out = local.data() + local_offset[o];
                    for (int m = 0; m < blocks; ++m) {
                        half.noalias() = form.block[m] * weights;
                        block.noalias() = weights.transpose() * half;
                        std::size_t e = 0;
                        for (Index i = 0; i < k; ++i)
                            for (Index j = i; j < k; ++j, ++e)
                                out[blocks * e + m] = block(i, j);
                    }
                    Eigen::Map<Eigen::Matrix<double, 3, Eigen::Dynamic>> right(
                        out + blocks * pair_count(k), 3, k);
                    right.noalias() = form.right.transpose() * weights;
                }
            });
        if (!finished)
            return false;
        for (Index p = begin; p < end; ++p) {
            const double* in = local.data() + local_offset[p - begin];
            for (std::size_t e = pair_offset_[p]; e < pair_offset_[p + 1]; ++e)
                for (int m = 0; m < blocks; ++m)
                    value_[static_cast<std::size_t>(slot_[e]) * blocks + m] += *in++;
            for (Index i = 0; i < network_.piece_size(p); ++i)
                for (int c = 0; c < 3; ++c)
                    right_[3 * place_[network_.piece_unknowns(p)[i]] + c] += *in++;
        }
    }
    return true;
}

void NormalSystem::add_damping(const std::vector<double>& damping, int blocks)
{
    for (std::size_t i = 0; i < place_.size(); ++i) {
        // The diagonal is the last entry of its column.
        double* d = &value_[static_cast<std::size_t>(column_[place_[i] + 1] - 1) * blocks];
        if (blocks == 1) {
            d[0] += damping[i] * d[0];
            continue;
        }
        const double added = damping[i] * (d[0] + d[3] + d[5]) / 3.0;
        for (const int k : {0, 3, 5})
            d[k] += added;
    }
}

NormalSystem::Solution NormalSystem::solve(const RoundProblem& problem, double condition_limit,
                                           const Context& context)
{
    const bool coupled = problem.mu < 1.0;
    if (!assemble(problem, coupled, context))
        return {};
    if (problem.damping)
        add_damping(*problem.damping, coupled ? 6 : 1);
    return coupled ? solve_coupled(condition_limit, context)
                   : solve_decoupled(condition_limit, context);
}

NormalSystem::Solution NormalSystem::solve_decoupled(double condition_limit, const Context& context)
{
    const auto n = static_cast<Eigen::Index>(place_.size());
    ScaledFactor::Matrix& matrix = scalar_.matrix();
    if (matrix.cols() != n) {
        matrix.resize(n, n);
        matrix.resizeNonZeros(static_cast<Eigen::Index>(row_.size()));
        std::copy(column_.begin(), column_.end(), matrix.outerIndexPtr());
        std::copy(row_.begin(), row_.end(), matrix.innerIndexPtr());
    }
    std::copy(value_.begin(), value_.end(), matrix.valuePtr());
    Solution solution;
    if (!scalar_.factorize(context) || context.cancelled())
        return solution;
    solution.condition = scalar_.condition(context);
    if (!(solution.condition <= condition_limit)) {
        scalar_.drop_factor();
        return solution;
    }
    solution.move.resize(place_.size());
    for (int c = 0; c < 3; ++c) {
        Eigen::VectorXd right(n);
        for (Eigen::Index i = 0; i < n; ++i)
            right[i] = right_[3 * i + c];
        const Eigen::VectorXd x = scalar_.solve(right);
        for (std::size_t i = 0; i < place_.size(); ++i)
            solution.move[i][c] = x[place_[i]];
    }
    solution.ok = true;
    return solution;
}

Eigen::VectorXd NormalSystem::solve_by_scalar(const Eigen::VectorXd& right) const
{
    const auto n = static_cast<Eigen::Index>(place_.size());
    Eigen::VectorXd x(3 * n);
    using Strided = Eigen::Map<Eigen::VectorXd, 0, Eigen::InnerStride<3>>;
    using ConstStrided = Eigen::Map<const Eigen::VectorXd, 0, Eigen::InnerStride<3>>;
    for (int c = 0; c < 3; ++c)
        Strided(x.data() + c, n) = scalar_.solve(ConstStrided(right.data() + c, n));
    return x;
}

NormalSystem::Solution NormalSystem::solve_coupled(double condition_limit, const Context& context)
{
    const auto n = static_cast<Eigen::Index>(place_.size());
    ScaledFactor::Matrix& matrix = coupled_.matrix();
    // Every column of blocks ends with its diagonal block, of which the upper triangle is stored.
    if (matrix.cols() != 3 * n) {
        matrix.resize(3 * n, 3 * n);
        matrix.resizeNonZeros(9 * (static_cast<Eigen::Index>(row_.size()) - n) + 6 * n);
        int *outer = matrix.outerIndexPtr(), *inner = matrix.innerIndexPtr();
        *outer++ = 0;
        int next = 0;
        for (Eigen::Index j = 0; j < n; ++j)
            for (int b = 0; b < 3; ++b) {
                for (int e = column_[j]; e < column_[j + 1]; ++e)
                    for (int a = 0; a <= (row_[e] == j ? b : 2); ++a)
                        inner[next++] = 3 * row_[e] + a;
                *outer++ = next;
            }
    }
    static constexpr int block_of[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
    double* value = matrix.valuePtr();
    for (Eigen::Index j = 0; j < n; ++j)
        for (int b = 0; b < 3; ++b)
            for (int e = column_[j]; e < column_[j + 1]; ++e)
                for (int a = 0; a <= (row_[e] == j ? b : 2); ++a)
                    *value++ = value_[6 * static_cast<std::size_t>(e) + block_of[a][b]];
    const Eigen::VectorXd right = Eigen::Map<const Eigen::VectorXd>(right_.data(), 3 * n);
    const auto cancelled = [&] { return context.cancelled(); };
    Solution solution;
    std::optional<Eigen::VectorXd> x;
    if (coupled_.has_factor()) {
        // Rounds differ little: a factor of an earlier one still preconditions well, and a few
        // iterations cost much less than a factorisation.
        x = conjugate_gradients(
            matrix, right, reuse_iterations, reuse_tolerance,
            [&](const Eigen::VectorXd& r) { return coupled_.solve(r); }, cancelled);
        solution.condition = coupled_condition_;
    } else if (scalar_.has_factor()) {
        x = conjugate_gradients(
            matrix, right, reuse_iterations, reuse_tolerance,
            [&](const Eigen::VectorXd& r) { return solve_by_scalar(r); }, cancelled);
        solution.condition = 0.0;
    }
    if (!x && !context.cancelled()) {
        if (!coupled_.factorize(context) || context.cancelled())
            return solution;
        solution.condition = coupled_condition_ = coupled_.condition(context);
        if (!(solution.condition <= condition_limit)) {
            coupled_.drop_factor();
            return solution;
        }
        x = coupled_.solve(right);
    }
    if (!x)
        return solution;
    solution.move.resize(place_.size());
    for (std::size_t i = 0; i < place_.size(); ++i)
        solution.move[i] = {(*x)[3 * place_[i]], (*x)[3 * place_[i] + 1], (*x)[3 * place_[i] + 2]};
    solution.ok = true;
    return solution;
}

} // namespace bot2nurbs
