// SPDX-License-Identifier: MIT
#include "fit/local_system.h"

#include "random_round.h"

#include <gtest/gtest.h>

namespace bot2nurbs {
namespace {

using test::RandomRound;

TEST(LocalSystem, is_stationary_in_the_unknowns_of_its_quads_and_leaves_all_others)
{
    const RandomRound round(1.0);
    const LocalSystem system(*round.reduced);
    const Index quad = 4;
    std::vector<char> own(round.reduced->free_count(), 0);
    for (Index p = 16 * quad; p < 16 * (quad + 1); ++p)
        for (Index k = 0; k < round.reduced->piece_size(p); ++k)
            own[round.reduced->piece_unknowns(p)[k]] = 1;
    std::vector<Vec3> move(own.size());
    ASSERT_TRUE(system.solve(round.problem, {quad}, move));

    const auto [matrix, right] = round.dense();
    Eigen::VectorXd x(right.size());
    for (std::size_t i = 0; i < move.size(); ++i)
        for (int c = 0; c < 3; ++c)
            x[static_cast<Eigen::Index>(3 * i) + c] = move[i][c];
    const Eigen::VectorXd gradient = matrix * x - right;
    const double scale = right.lpNorm<Eigen::Infinity>();
    Index held = 0;
    for (std::size_t i = 0; i < own.size(); ++i) {
        const auto at = static_cast<Eigen::Index>(3 * i);
        if (own[i]) {
            EXPECT_LT(gradient.segment<3>(at).norm(), 1e-9 * scale) << i;
        } else {
            EXPECT_EQ(move[i], Vec3{}) << i;
            held += gradient.segment<3>(at).norm() > 1e-3 * scale;
        }
    }
    EXPECT_GT(held, 0u); // The others are not where they would like to be.
}

TEST(LocalSystem, of_all_quads_is_the_whole_problem_with_point_rows)
{
    // Whatever mu the problem has.
    const RandomRound tangent(0.01), point(1.0);
    std::vector<Index> all(point.network->complex.quad_count());
    for (Index q = 0; q < all.size(); ++q)
        all[q] = q;
    std::vector<Vec3> move(point.reduced->free_count());
    ASSERT_TRUE(LocalSystem(*tangent.reduced).solve(tangent.problem, all, move));
    EXPECT_LT(point.distance_to_dense(move), 1e-9);
}

TEST(LocalSystem, moves_nothing_where_nothing_decides)
{
    RandomRound round(1.0);
    round.rows.clear();
    round.groups = group_by_piece(round.rows, round.reduced->piece_count());
    std::fill(round.fairness.begin(), round.fairness.end(), 0.0);
    std::vector<Vec3> move(round.reduced->free_count(), Vec3{1, 2, 3});
    const std::vector<Vec3> before = move;
    EXPECT_FALSE(LocalSystem(*round.reduced).solve(round.problem, {0}, move));
    EXPECT_EQ(move, before);
}

} // namespace
} // namespace bot2nurbs
