// SPDX-License-Identifier: MIT
#include "fit/stacked_rows.h"

#include "fit/bernstein_gram.h"
#include "spline/bernstein.h"

#include <Eigen/OrderingMethods>
#include <Eigen/QR>
#include <Eigen/SparseQR>
#include <algorithm>
#include <cmath>

namespace bot2nurbs {

namespace {

using Rows16 = Eigen::Matrix<double, Eigen::Dynamic, 16>;
using Right = Eigen::Matrix<double, Eigen::Dynamic, 3>;

//! At most 16 rows with the same least-squares problem as the piece's samples.
void sample_rows(const RoundProblem& problem, Index piece, Rows16& rows, Right& right)
{
    const std::size_t first = problem.groups->offset[piece],
                      count = problem.groups->offset[piece + 1] - first;
    rows.resize(static_cast<Eigen::Index>(count), 16);
    right.resize(static_cast<Eigen::Index>(count), 3);
    for (std::size_t o = 0; o < count; ++o) {
        const FitRow& row = (*problem.rows)[problem.groups->order[first + o]];
        const Cubic bs = bernstein(row.s), bt = bernstein(row.t);
        const double w = std::sqrt(row.weight);
        const auto r = static_cast<Eigen::Index>(o);
        for (int i = 0; i < 16; ++i)
            rows(r, i) = w * bs[i / 4] * bt[i % 4];
        right.row(r) << w * row.residual.x, w * row.residual.y, w * row.residual.z;
    }
    if (count <= 16)
        return;
    const Eigen::HouseholderQR<Rows16> qr(rows);
    right = Right(qr.householderQ().adjoint() * right).topRows(16).eval();
    const Matrix16 r = qr.matrixQR().topRows(16).triangularView<Eigen::Upper>();
    rows = r;
}

} // namespace

NormalSystem::Solution solve_stacked_rows(const ReducedNetwork& network,
                                          const RoundProblem& problem, const Context& context)
{
    const auto n = static_cast<Eigen::Index>(network.free_count());
    std::vector<Eigen::Triplet<double, int>> entries;
    std::vector<Eigen::RowVector3d> right_rows;
    Rows16 rows;
    Right right;
    for (Index p = 0; p < network.piece_count(); ++p) {
        if (context.cancelled())
            return {};
        const Index k = network.piece_size(p), *unknown = network.piece_unknowns(p);
        const Eigen::Map<const Eigen::Matrix<double, 16, Eigen::Dynamic, Eigen::RowMajor>> weights(
            network.piece_weights(p), 16, k);
        const auto add = [&](const Rows16& r, const Right& b) {
            const Eigen::MatrixXd composed = r * weights;
            for (Eigen::Index i = 0; i < composed.rows(); ++i) {
                for (Index j = 0; j < k; ++j)
                    if (composed(i, j) != 0.0)
                        entries.emplace_back(static_cast<int>(right_rows.size()),
                                             static_cast<int>(unknown[j]), composed(i, j));
                right_rows.emplace_back(b.row(i));
            }
        };
        sample_rows(problem, p, rows, right);
        add(rows, right);
        const Index q = p / ReducedNetwork::pieces_per_quad;
        const double f = std::sqrt((*problem.fairness)[q]);
        if (f > 0.0) {
            const Rows16 fair = f * thin_plate_rows();
            Eigen::Matrix<double, 16, 3> x = Eigen::Matrix<double, 16, 3>::Zero();
            if (!problem.bezier->empty())
                for (Index i = 0; i < 16; ++i) {
                    const Vec3& c = (*problem.bezier)[bezier_index(p, i)];
                    x.row(i) << c.x, c.y, c.z;
                }
            add(fair, Right(-fair * x));
        }
    }
    const auto m = static_cast<Eigen::Index>(right_rows.size());
    Eigen::SparseMatrix<double, Eigen::ColMajor, int> matrix(m, n);
    matrix.setFromTriplets(entries.begin(), entries.end());
    Eigen::VectorXd scale(n);
    for (Eigen::Index j = 0; j < n; ++j) {
        const double length = matrix.col(j).norm();
        scale[j] = length > 0.0 ? 1.0 / length : 1.0;
        matrix.col(j) *= scale[j];
    }
    matrix.makeCompressed();
    Eigen::MatrixXd b(m, 3);
    for (Eigen::Index i = 0; i < m; ++i)
        b.row(i) = right_rows[static_cast<std::size_t>(i)];
    const Eigen::SparseQR<Eigen::SparseMatrix<double, Eigen::ColMajor, int>,
                          Eigen::COLAMDOrdering<int>>
        qr(matrix);
    NormalSystem::Solution solution;
    if (qr.info() != Eigen::Success || context.cancelled())
        return solution;
    const Eigen::MatrixXd x = qr.solve(b);
    if (qr.info() != Eigen::Success || !x.allFinite())
        return solution;
    double smallest = INFINITY, largest = 0.0;
    for (Eigen::Index i = 0; i < qr.rank(); ++i) {
        const double d = std::abs(qr.matrixR().coeff(i, i));
        smallest = std::min(smallest, d);
        largest = std::max(largest, d);
    }
    solution.condition = (largest / smallest) * (largest / smallest);
    solution.move.resize(static_cast<std::size_t>(n));
    for (Eigen::Index j = 0; j < n; ++j)
        solution.move[static_cast<std::size_t>(j)] = {scale[j] * x(j, 0), scale[j] * x(j, 1),
                                                      scale[j] * x(j, 2)};
    solution.ok = true;
    return solution;
}

} // namespace bot2nurbs
