// SPDX-License-Identifier: MIT
#include "fit/reduced_network.h"

#include "domain_fixtures.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace bot2nurbs {
namespace {

std::vector<Vec3> random_points(std::size_t n, unsigned seed)
{
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> value(-1.0, 1.0);
    std::vector<Vec3> points(n);
    for (Vec3& p : points)
        p = {value(generator), value(generator), value(generator)};
    return points;
}

double largest_constraint(const SplineNetwork& network, const std::vector<Vec3>& unknowns)
{
    double largest = 0.0;
    const SparseRows& c = network.constraints;
    for (Index r = 0; r < c.row_count(); ++r) {
        Vec3 sum;
        for (std::size_t e = c.offset[r]; e < c.offset[r + 1]; ++e)
            sum += c.weight[e] * unknowns[c.column[e]];
        largest = std::fmax(largest, norm(sum));
    }
    return largest;
}

TEST(ReducedNetwork, satisfies_the_constraints_for_any_free_unknowns)
{
    for (const SplineScheme scheme : {SplineScheme::peters, SplineScheme::eck_hoppe})
        for (const fixtures::Domain& d : fixtures::closed_domains()) {
            const auto network = build_spline_network(d.complex, scheme);
            ASSERT_TRUE(network.ok()) << d.name;
            const auto reduced = ReducedNetwork::build(*network, Context());
            ASSERT_TRUE(reduced.ok()) << d.name;
            EXPECT_EQ(reduced->free_count() + network->constraints.row_count(),
                      network->unknown_count);
            const auto all = reduced->expand(random_points(reduced->free_count(), 7));
            EXPECT_LT(largest_constraint(*network, all), 1e-13) << d.name;
        }
}

TEST(ReducedNetwork, pieces_give_the_coefficients_of_the_surface)
{
    for (const fixtures::Domain& d : {fixtures::genus2(), fixtures::radial_bipyramid(6)}) {
        const auto network = build_spline_network(d.complex, SplineScheme::peters);
        ASSERT_TRUE(network.ok());
        const auto reduced = ReducedNetwork::build(*network, Context());
        ASSERT_TRUE(reduced.ok());
        const auto free = random_points(reduced->free_count(), 11);
        const SplineSurface surface(*network, reduced->expand(free));
        for (Index p = 0; p < reduced->piece_count(); ++p)
            for (Index c = 0; c < 16; ++c) {
                Vec3 sum;
                const Index k = reduced->piece_size(p);
                for (Index i = 0; i < k; ++i)
                    sum +=
                        reduced->piece_weights(p)[k * c + i] * free[reduced->piece_unknowns(p)[i]];
                EXPECT_LT(norm(sum - surface.bezier()[bezier_index(p, c)]), 1e-14);
            }
    }
}

TEST(ReducedNetwork, refuses_rows_that_share_an_unknown)
{
    auto network =
        build_spline_network(fixtures::radial_bipyramid(6).complex, SplineScheme::peters);
    ASSERT_TRUE(network.ok());
    SparseRows& c = network->constraints;
    ASSERT_GT(c.row_count(), 0u);
    c.column.push_back(c.column[0]);
    c.weight.push_back(1.0);
    c.offset.push_back(c.column.size());
    const auto reduced = ReducedNetwork::build(*network, Context());
    ASSERT_FALSE(reduced.ok());
    EXPECT_EQ(reduced.error().code, ErrorCode::fit_failed);
    EXPECT_EQ(reduced.error().element, c.row_count() - 1);
}

} // namespace
} // namespace bot2nurbs
