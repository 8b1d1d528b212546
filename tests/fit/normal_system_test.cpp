// SPDX-License-Identifier: MIT
#include "fit/normal_system.h"

#include "fit/stacked_rows.h"
#include "random_round.h"

#include <gtest/gtest.h>

namespace bot2nurbs {
namespace {

using test::RandomRound;

constexpr double any_condition = 1e300;

TEST(NormalSystem, point_rows_give_the_dense_least_squares_solution)
{
    const RandomRound round(1.0);
    NormalSystem system(*round.reduced, Context());
    const auto solution = system.solve(round.problem, any_condition, Context());
    ASSERT_TRUE(solution.ok);
    EXPECT_LT(round.distance_to_dense(solution.move), 1e-9);
}

TEST(NormalSystem, tangent_rows_give_the_dense_least_squares_solution)
{
    const RandomRound round(0.01);
    NormalSystem system(*round.reduced, Context());
    const auto solution = system.solve(round.problem, any_condition, Context());
    ASSERT_TRUE(solution.ok);
    EXPECT_LT(round.distance_to_dense(solution.move), 1e-8);
}

TEST(NormalSystem, point_rows_are_affine_equivariant)
{
    const RandomRound round(1.0);
    RandomRound mapped(1.0);
    const auto linear = [](const Vec3& p) {
        return Vec3{2 * p.x + p.y, p.y - 0.5 * p.z, p.x + p.y + p.z};
    };
    const Vec3 offset{3, -1, 2};
    // Samples and surface are mapped by p -> linear(p) + offset, where the surface lags behind by
    // the offset: points have to follow it, vectors have to stay.
    for (FitRow& r : mapped.rows)
        r.residual = linear(r.residual) + offset;
    for (Vec3& c : mapped.bezier)
        c = linear(c);
    NormalSystem system(*round.reduced, Context());
    const auto a = system.solve(round.problem, any_condition, Context());
    const auto b = system.solve(mapped.problem, any_condition, Context());
    ASSERT_TRUE(a.ok && b.ok);
    for (Index i = 0; i < round.reduced->free_count(); ++i) {
        const Vec3 expected = linear(a.move[i]) + (round.reduced->is_point(i) ? offset : Vec3{});
        EXPECT_LT(norm(b.move[i] - expected), 1e-10);
    }
}

// Conjugate gradients stop at 1e-3 of the step; the moves are of order one.
constexpr double with_other_factor = 1e-2;

TEST(NormalSystem, the_factor_of_point_rows_serves_the_first_tangent_rows)
{
    const RandomRound round(0.1);
    NormalSystem system(*round.reduced, Context());
    RoundProblem before = round.problem;
    before.mu = 1.0;
    ASSERT_TRUE(system.solve(before, any_condition, Context()).ok);
    const auto solution = system.solve(round.problem, any_condition, Context());
    ASSERT_TRUE(solution.ok);
    EXPECT_EQ(solution.condition, 0.0); // of no factor of its own
    EXPECT_LT(round.distance_to_dense(solution.move), with_other_factor);
}

TEST(NormalSystem, an_answer_starts_from_the_solution_before_it_and_its_factor)
{
    RandomRound round(1e-3);
    NormalSystem system(*round.reduced, Context());
    const auto before = system.solve(round.problem, any_condition, Context());
    ASSERT_TRUE(before.ok);
    for (std::size_t i = 0; i < round.rows.size() / 16; ++i)
        round.rows[i].least_mu = 0.1;
    round.problem.start = &before.move;
    EXPECT_GT(round.distance_to_dense(before.move), with_other_factor);
    const auto solution = system.solve(round.problem, any_condition, Context());
    ASSERT_TRUE(solution.ok);
    EXPECT_EQ(solution.condition, before.condition);
    EXPECT_LT(round.distance_to_dense(solution.move), with_other_factor);
}

//! Solves a round, and once more from `share` of the solution with its factor.
std::pair<NormalSystem::Solution, NormalSystem::Solution> solved_twice(RandomRound& round,
                                                                       double share)
{
    NormalSystem system(*round.reduced, Context());
    const auto before = system.solve(round.problem, any_condition, Context());
    EXPECT_TRUE(before.ok);
    std::vector<Vec3> start = before.move;
    for (Vec3& m : start)
        m *= share;
    round.problem.start = &start;
    const auto after = system.solve(round.problem, any_condition, Context());
    EXPECT_TRUE(after.ok);
    EXPECT_EQ(after.condition, before.condition);
    return {before, after};
}

TEST(NormalSystem, a_start_that_is_the_solution_is_returned)
{
    RandomRound round(0.01);
    const auto [before, after] = solved_twice(round, 1.0);
    EXPECT_EQ(after.move, before.move);
}

TEST(NormalSystem, a_start_that_points_the_wrong_way_does_no_harm)
{
    RandomRound round(0.01);
    const auto [before, after] = solved_twice(round, -1.0);
    EXPECT_LT(round.distance_to_dense(after.move), with_other_factor);
}

TEST(NormalSystem, reports_the_condition_within_a_factor_of_two)
{
    const RandomRound round(1.0);
    NormalSystem system(*round.reduced, Context());
    const auto solution = system.solve(round.problem, any_condition, Context());
    Eigen::MatrixXd normal = round.dense().first;
    const Eigen::VectorXd scale = normal.diagonal().cwiseSqrt().cwiseInverse();
    normal = scale.asDiagonal() * normal * scale.asDiagonal();
    const Eigen::VectorXd values =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(normal).eigenvalues();
    const double exact = values[values.size() - 1] / values[0];
    EXPECT_LE(solution.condition, exact * (1.0 + 1e-9));
    EXPECT_GE(solution.condition, 0.5 * exact);
}

TEST(NormalSystem, refuses_to_solve_above_the_condition_limit)
{
    const RandomRound round(1.0), coupled(0.1);
    NormalSystem system(*round.reduced, Context());
    EXPECT_FALSE(system.solve(round.problem, 1.5, Context()).ok);
    EXPECT_FALSE(system.solve(coupled.problem, 1.5, Context()).ok);
}

TEST(NormalSystem, has_the_same_bytes_for_any_number_of_threads)
{
    for (const double mu : {1.0, 0.01}) {
        const RandomRound round(mu);
        Context one, many;
        one.threads = 1;
        many.threads = 8;
        NormalSystem a(*round.reduced, one), b(*round.reduced, many);
        const auto x = a.solve(round.problem, any_condition, one);
        const auto y = b.solve(round.problem, any_condition, many);
        ASSERT_TRUE(x.ok && y.ok);
        EXPECT_EQ(x.move, y.move);
    }
}

TEST(StackedRows, agree_with_the_normal_equations)
{
    // With 20 rows a piece the dense compression is used, with 3 it is not.
    for (const int rows : {3, 20}) {
        const RandomRound round(1.0, rows);
        const auto solution = solve_stacked_rows(*round.reduced, round.problem, Context());
        ASSERT_TRUE(solution.ok);
        EXPECT_LT(round.distance_to_dense(solution.move), 1e-8);
    }
}

TEST(StackedRows, solve_what_the_normal_equations_cannot)
{
    // Only four of the quads have rows and there is no fairness, so most unknowns are free. The
    // rows are made from a known move, so a solution leaves nothing.
    RandomRound round(1.0, 20);
    round.fairness.assign(round.fairness.size(), 0.0);
    std::vector<Vec3> known(round.reduced->free_count());
    for (std::size_t i = 0; i < known.size(); ++i)
        known[i] = {std::sin(1.0 * i), std::sin(2.0 * i), std::sin(3.0 * i)};
    const auto surface_move = [&](const FitRow& r, const std::vector<Vec3>& move) {
        const Cubic bs = bernstein(r.s), bt = bernstein(r.t);
        const Index k = round.reduced->piece_size(r.piece);
        Vec3 sum;
        for (Index c = 0; c < 16; ++c)
            for (Index i = 0; i < k; ++i)
                sum += bs[c / 4] * bt[c % 4] * round.reduced->piece_weights(r.piece)[k * c + i] *
                       move[round.reduced->piece_unknowns(r.piece)[i]];
        return sum;
    };
    round.rows.erase(std::remove_if(round.rows.begin(), round.rows.end(),
                                    [](const FitRow& r) { return r.piece >= 4 * 16; }),
                     round.rows.end());
    round.groups = group_by_piece(round.rows, round.reduced->piece_count());
    for (FitRow& r : round.rows)
        r.residual = surface_move(r, known);
    NormalSystem system(*round.reduced, Context());
    EXPECT_FALSE(system.solve(round.problem, 1e10, Context()).ok);
    const auto solution = solve_stacked_rows(*round.reduced, round.problem, Context());
    ASSERT_TRUE(solution.ok);
    for (const FitRow& r : round.rows)
        EXPECT_LT(norm(surface_move(r, solution.move) - r.residual), 1e-10);
}

} // namespace
} // namespace bot2nurbs
