// SPDX-License-Identifier: MIT
#include "fit/local_system.h"

#include "fit/bernstein_gram.h"
#include "fit/piece_form.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace bot2nurbs {

namespace {

std::vector<double> energy_of(const ReducedNetwork& network, Index piece)
{
    const Index k = network.piece_size(piece);
    const Eigen::Map<const Eigen::Matrix<double, 16, Eigen::Dynamic, Eigen::RowMajor>> weights(
        network.piece_weights(piece), 16, k);
    const Eigen::MatrixXd energy = weights.transpose() * thin_plate_matrix() * weights;
    std::vector<double> pairs;
    for (Index i = 0; i < k; ++i)
        for (Index j = i; j < k; ++j)
            pairs.push_back(energy(i, j));
    return pairs;
}

} // namespace

LocalSystem::LocalSystem(const ReducedNetwork& network) : network_(network)
{
    offset_.assign(network.free_count() + std::size_t{1}, 0);
    for (Index p = 0; p < network.piece_count(); ++p)
        for (Index k = 0; k < network.piece_size(p); ++k)
            ++offset_[network.piece_unknowns(p)[k] + 1];
    for (std::size_t i = 1; i < offset_.size(); ++i)
        offset_[i] += offset_[i - 1];
    piece_.resize(offset_.back());
    std::vector<std::size_t> next(offset_.begin(), offset_.end() - 1);
    for (Index p = 0; p < network.piece_count(); ++p)
        for (Index k = 0; k < network.piece_size(p); ++k)
            piece_[next[network.piece_unknowns(p)[k]]++] = p;
}

bool LocalSystem::solve(const RoundProblem& problem, const std::vector<Index>& quads,
                        std::vector<Vec3>& move) const
{
    std::vector<Index> free, pieces;
    for (const Index q : quads)
        for (Index p = q * ReducedNetwork::pieces_per_quad;
             p < (q + 1) * ReducedNetwork::pieces_per_quad; ++p)
            free.insert(free.end(), network_.piece_unknowns(p),
                        network_.piece_unknowns(p) + network_.piece_size(p));
    const auto unique = [](std::vector<Index>& list) {
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
    };
    unique(free);
    for (const Index u : free)
        pieces.insert(pieces.end(), piece_.begin() + static_cast<std::ptrdiff_t>(offset_[u]),
                      piece_.begin() + static_cast<std::ptrdiff_t>(offset_[u + 1]));
    unique(pieces);

    const auto n = static_cast<Eigen::Index>(free.size());
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
    Eigen::MatrixX3d right = Eigen::MatrixX3d::Zero(n, 3);
    RoundProblem by_points = problem;
    by_points.mu = 1.0;
    std::vector<double> form, scratch;
    std::vector<Eigen::Index> place;
    for (const Index p : pieces) {
        const Index k = network_.piece_size(p);
        form.resize(PieceForm::doubles(k, 1));
        PieceForm sum(network_, p, 1, form.data());
        sum.add_rows(by_points, scratch);
        sum.add_fairness(by_points, energy_of(network_, p).data());
        place.assign(k, -1);
        for (Index i = 0; i < k; ++i) {
            const auto at =
                std::lower_bound(free.begin(), free.end(), network_.piece_unknowns(p)[i]);
            if (at != free.end() && *at == network_.piece_unknowns(p)[i])
                place[i] = at - free.begin();
        }
        const double* in = form.data();
        for (Index i = 0; i < k; ++i)
            for (Index j = i; j < k; ++j, ++in)
                if (place[i] >= 0 && place[j] >= 0)
                    matrix(std::max(place[i], place[j]), std::min(place[i], place[j])) += *in;
        for (Index i = 0; i < k; ++i, in += 3)
            if (place[i] >= 0)
                right.row(place[i]) += Eigen::RowVector3d(in[0], in[1], in[2]);
    }
    const Eigen::VectorXd diagonal = matrix.diagonal();
    if (!(diagonal.minCoeff() > 0.0))
        return false;
    const Eigen::VectorXd scale = diagonal.cwiseSqrt().cwiseInverse();
    matrix = scale.asDiagonal() * matrix * scale.asDiagonal();
    const Eigen::LLT<Eigen::MatrixXd> factor(matrix);
    if (factor.info() != Eigen::Success)
        return false;
    const Eigen::MatrixX3d x =
        scale.asDiagonal() * factor.solve(Eigen::MatrixX3d(scale.asDiagonal() * right));
    for (Eigen::Index i = 0; i < n; ++i)
        move[free[static_cast<std::size_t>(i)]] = {x(i, 0), x(i, 1), x(i, 2)};
    return true;
}

} // namespace bot2nurbs
