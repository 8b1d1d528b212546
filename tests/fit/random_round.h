// SPDX-License-Identifier: MIT
#pragma once

#include "fit/bernstein_gram.h"
#include "fit/normal_system.h"
#include "spline/bernstein.h"

#include "domain_fixtures.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <random>

namespace bot2nurbs::test {

//! A random round on a domain with a constraint (valence 6), and its dense least-squares rows.
struct RandomRound {
    Result<SplineNetwork> network =
        build_spline_network(fixtures::radial_bipyramid(6).complex, SplineScheme::peters);
    Result<ReducedNetwork> reduced = ReducedNetwork::build(*network, Context());
    std::vector<FitRow> rows;
    RowsByPiece groups;
    std::vector<Vec3> bezier;
    std::vector<double> fairness;
    RoundProblem problem;

    explicit RandomRound(double mu, int rows_per_piece = 22)
    {
        std::mt19937 generator(3);
        std::uniform_real_distribution<double> value(0.0, 1.0);
        const auto vector = [&] {
            return Vec3{value(generator) - 0.5, value(generator) - 0.5, value(generator) - 0.5};
        };
        for (int k = 0; k < rows_per_piece; ++k)
            for (Index p = 0; p < reduced->piece_count(); ++p)
                rows.push_back({p, value(generator), value(generator), 0.1 + value(generator),
                                vector(), k % 5 == 0 ? Vec3{} : normalized(vector())});
        groups = group_by_piece(rows, reduced->piece_count());
        std::vector<Vec3> free(reduced->free_count());
        for (Vec3& x : free)
            x = vector();
        bezier = SplineSurface(*network, reduced->expand(free)).bezier();
        for (Index q = 0; q < network->complex.quad_count(); ++q)
            fairness.push_back(0.01 * (1.0 + q));
        problem = {&rows, &groups, &bezier, &fairness, mu};
    }

    //! Matrix and right-hand side of the normal equations over all 3 N unknowns, x y z of unknown 0
    //! first, summed row by row.
    std::pair<Eigen::MatrixXd, Eigen::VectorXd> dense() const
    {
        const Eigen::Index n = 3 * static_cast<Eigen::Index>(reduced->free_count());
        Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
        Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
        const auto add = [&](Index piece, const Eigen::VectorXd& coefficients, const Vec3& along,
                             double wanted, double weight) {
            const Index k = reduced->piece_size(piece);
            std::vector<std::pair<Index, double>> row;
            for (Index i = 0; i < k; ++i) {
                double sum = 0.0;
                for (Index c = 0; c < 16; ++c)
                    sum += coefficients[c] * reduced->piece_weights(piece)[k * c + i];
                for (int a = 0; a < 3; ++a)
                    if (along[a] != 0.0)
                        row.emplace_back(3 * reduced->piece_unknowns(piece)[i] + a, sum * along[a]);
            }
            for (const auto& [r, x] : row) {
                for (const auto& [c, y] : row)
                    matrix(r, c) += weight * x * y;
                right[r] += weight * x * wanted;
            }
        };
        const Vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        for (const FitRow& r : rows) {
            const Cubic bs = bernstein(r.s), bt = bernstein(r.t);
            Eigen::VectorXd phi(16);
            for (int i = 0; i < 16; ++i)
                phi[i] = bs[i / 4] * bt[i % 4];
            const bool free = r.normal == Vec3{};
            const double mu = std::max(problem.mu, r.least_mu);
            if (!free)
                add(r.piece, phi, r.normal, dot(r.normal, r.residual), r.weight * (1.0 - mu));
            for (const Vec3& axis : axes)
                add(r.piece, phi, axis, dot(axis, r.residual), r.weight * (free ? 1.0 : mu));
        }
        for (Index p = 0; p < reduced->piece_count(); ++p)
            for (int e = 0; e < 13; ++e) {
                const Eigen::VectorXd row = thin_plate_rows().row(e);
                Vec3 now;
                for (Index c = 0; c < 16; ++c)
                    now += row[c] * bezier[bezier_index(p, c)];
                for (const Vec3& axis : axes)
                    add(p, row, axis, -dot(axis, now), fairness[p / 16]);
            }
        return {matrix, right};
    }

    double distance_to_dense(const std::vector<Vec3>& move) const
    {
        const auto [matrix, right] = dense();
        const Eigen::VectorXd x = matrix.ldlt().solve(right);
        double largest = 0.0;
        for (Index i = 0; i < reduced->free_count(); ++i)
            largest =
                std::fmax(largest, norm(move[i] - Vec3{x[3 * i], x[3 * i + 1], x[3 * i + 2]}));
        return largest;
    }
};

} // namespace bot2nurbs::test
