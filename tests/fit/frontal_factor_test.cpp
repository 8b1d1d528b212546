// SPDX-License-Identifier: MIT
#include "fit/frontal_factor.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <random>
#include <thread>

namespace bot2nurbs {
namespace {

//! A positive definite matrix of b x b blocks on the pattern of a grid whose places within two
//! steps of each other are coupled: like splines, and with fronts that grow towards the root.
struct GridMatrix {
    int block;
    std::vector<std::vector<int>> neighbours;
    FactorPlan plan;
    std::vector<double> values;
    Eigen::MatrixXd dense;

    GridMatrix(int side, int block_size) : block(block_size), neighbours(side * side)
    {
        for (int i = 0; i < side * side; ++i)
            for (int j = 0; j < side * side; ++j)
                if (std::abs(i / side - j / side) <= 2 && std::abs(i % side - j % side) <= 2)
                    neighbours[i].push_back(j);
        plan = FactorPlan(neighbours, Context());
        const int n = plan.size();
        values.resize(plan.row.size() * (block == 1 ? 1 : 6));
        dense = Eigen::MatrixXd::Zero(block * n, block * n);
        std::mt19937 generator(7);
        std::uniform_real_distribution<double> value(-1.0, 1.0);
        for (int j = 0; j < n; ++j)
            for (int e = plan.column[j]; e < plan.column[j + 1]; ++e) {
                const int i = plan.row[e];
                int next = 0;
                for (int a = 0; a < block; ++a)
                    for (int c = a; c < block; ++c, ++next) {
                        // 25 blocks a row at most: the diagonal dominates.
                        const double v = value(generator) + (i == j && a == c ? 30.0 * block : 0.0);
                        values[static_cast<std::size_t>(e) * (block == 1 ? 1 : 6) + next] = v;
                        dense(block * i + a, block * j + c) = dense(block * i + c, block * j + a) =
                            dense(block * j + a, block * i + c) =
                                dense(block * j + c, block * i + a) = v;
                    }
            }
    }
    Eigen::VectorXd ones() const { return Eigen::VectorXd::Ones(dense.rows()); }
    Eigen::VectorXd right() const
    {
        return Eigen::VectorXd::LinSpaced(dense.rows(), -1.0, 2.0).array().cos();
    }
};

template <class Real> double distance_to_dense(const GridMatrix& m)
{
    FrontalFactor<Real> factor(m.plan, m.block);
    EXPECT_TRUE(factor.factorize(m.values, m.ones(), Context()));
    Eigen::Matrix<Real, Eigen::Dynamic, 1> x = m.right().cast<Real>();
    factor.solve(x, Context());
    const Eigen::VectorXd expected = m.dense.llt().solve(m.right());
    return (x.template cast<double>() - expected).norm() / expected.norm();
}

TEST(FrontalFactor, solves_like_a_dense_factor_to_the_precision_of_its_numbers)
{
    for (const int block : {1, 3})
        for (const int side : {1, 4, 20}) {
            const GridMatrix m(side, block);
            EXPECT_LT(distance_to_dense<double>(m), 1e-14) << side << " " << block;
            EXPECT_LT(distance_to_dense<float>(m), 1e-5) << side << " " << block;
        }
}

TEST(FrontalFactor, works_on_subtrees_and_on_a_top_that_cover_the_tree)
{
    const GridMatrix m(20, 1);
    std::vector<int> seen;
    for (const FactorPlan::Subtree& t : m.plan.subtrees)
        for (int s = t.first; s < t.last; ++s) {
            seen.push_back(s);
            // Only the root of a subtree has a parent outside.
            if (s + 1 < t.last) {
                EXPECT_LT(m.plan.supernodes[s].parent, t.last);
            }
        }
    EXPECT_GT(m.plan.subtrees.size(), 4u);
    EXPECT_GT(m.plan.top.size(), 1u);
    seen.insert(seen.end(), m.plan.top.begin(), m.plan.top.end());
    std::sort(seen.begin(), seen.end());
    ASSERT_EQ(seen.size(), m.plan.supernodes.size());
    for (std::size_t s = 0; s < seen.size(); ++s)
        EXPECT_EQ(seen[s], static_cast<int>(s));
}

TEST(FrontalFactor, applies_the_scale_on_both_sides)
{
    const GridMatrix m(8, 3);
    const Eigen::VectorXd scale = m.dense.diagonal().cwiseSqrt().cwiseInverse();
    FrontalFactor<double> factor(m.plan, 3);
    ASSERT_TRUE(factor.factorize(m.values, scale, Context()));
    Eigen::VectorXd x = scale.cwiseProduct(m.right());
    factor.solve(x, Context());
    x = scale.cwiseProduct(x);
    EXPECT_LT((m.dense * x - m.right()).norm(), 1e-13);
}

TEST(FrontalFactor, has_the_same_bytes_for_any_number_of_threads)
{
    // Large enough for fronts of several tasks.
    const GridMatrix m(24, 3);
    Eigen::VectorXf first;
    for (const unsigned threads : {1u, 2u, 8u}) {
        Context context;
        context.threads = threads;
        FrontalFactor<float> factor(m.plan, 3);
        ASSERT_TRUE(factor.factorize(m.values, m.ones(), context));
        Eigen::VectorXf x = m.right().cast<float>();
        factor.solve(x, context);
        if (first.size() == 0)
            first = x;
        EXPECT_EQ(x, first) << threads;
    }
}

TEST(FrontalFactor, says_so_when_the_matrix_is_not_positive_definite)
{
    GridMatrix m(12, 1);
    for (const int column : {0, 77, 143}) {
        std::vector<double> values = m.values;
        values[m.plan.column[column + 1] - 1] = -1.0;
        EXPECT_FALSE(FrontalFactor<double>(m.plan, 1).factorize(values, m.ones(), Context()));
        EXPECT_FALSE(FrontalFactor<float>(m.plan, 1).factorize(values, m.ones(), Context()));
    }
}

} // namespace
} // namespace bot2nurbs
