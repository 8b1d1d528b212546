// SPDX-License-Identifier: MIT
#include "fit/fold_easing.h"

#include "domain_fixtures.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace bot2nurbs::test {
namespace {

//! Of a flat grid of patches, most of which touch no other at the same time.
struct Grid {
    fixtures::Domain domain = fixtures::disk_grid(7, 5);
    Result<SplineNetwork> network = build_spline_network(domain.complex, SplineScheme::peters);
    Result<ReducedNetwork> reduced = ReducedNetwork::build(*network, Context());
    FoldResponse response{domain.complex, *reduced};
    std::vector<Index> folds = std::vector<Index>(domain.complex.quad_count(), 0);
    FoldEasing easing{response, domain.complex.quad_count()};
};

TEST(FoldEasing, nothing_that_folds_is_nothing_to_try)
{
    Grid grid;
    EXPECT_TRUE(grid.easing.next(grid.folds).empty());
}

TEST(FoldEasing, fairness_rises_by_tens_then_around_the_quad_too_and_then_it_is_given_up)
{
    Grid grid;
    const Index quad = 16; // In the middle: eight around it.
    grid.folds[quad] = 3;
    std::vector<double> own;
    for (int pass = 0; pass < 10; ++pass) {
        auto regions = grid.easing.next(grid.folds);
        ASSERT_EQ(regions.size(), 1u) << pass;
        EXPECT_FALSE(regions[0].back);
        EXPECT_EQ(regions[0].core, std::vector<Index>{quad});
        EXPECT_EQ(regions[0].quads.size(), pass < 5 ? 1u : 9u);
        EXPECT_EQ(regions[0].near, grid.response.with_neighbours(regions[0].quads));
        const std::vector<double> raised = grid.easing.raised();
        own.push_back(raised[quad]);
        EXPECT_EQ(std::count_if(raised.begin(), raised.end(), [](double r) { return r > 1.0; }),
                  pass < 5 ? 1 : 9);
        regions[0].out = true;
        grid.easing.learn(regions, grid.folds);
    }
    EXPECT_EQ(own, (std::vector<double>{1e1, 1e2, 1e3, 1e4, 1e5, 1e1, 1e2, 1e3, 1e4, 1e5}));
    EXPECT_TRUE(grid.easing.next(grid.folds).empty());
}

TEST(FoldEasing, what_has_fewer_folds_is_tried_with_the_same_once_more)
{
    Grid grid;
    grid.folds[0] = 3;
    auto regions = grid.easing.next(grid.folds);
    regions[0].out = true;
    grid.easing.learn(regions, grid.folds);
    regions = grid.easing.next(grid.folds);
    EXPECT_EQ(grid.easing.raised()[0], 100.0);
    grid.folds[0] = 2;
    grid.easing.learn(regions, grid.folds);
    grid.easing.next(grid.folds);
    EXPECT_EQ(grid.easing.raised()[0], 100.0);
}

TEST(FoldEasing, what_has_unfolded_comes_back_by_tens_as_far_as_it_stays_so)
{
    Grid grid;
    grid.folds[0] = 1;
    for (int pass = 0; pass < 3; ++pass) {
        auto regions = grid.easing.next(grid.folds);
        regions[0].out = pass < 2;
        if (pass == 2)
            grid.folds[0] = 0;
        grid.easing.learn(regions, grid.folds);
    }
    for (const double factor : {100.0, 10.0, 1.0}) {
        auto regions = grid.easing.next(grid.folds);
        ASSERT_EQ(regions.size(), 1u) << factor;
        EXPECT_TRUE(regions[0].back);
        EXPECT_EQ(grid.easing.raised()[0], factor);
        grid.easing.learn(regions, grid.folds);
    }
    EXPECT_TRUE(grid.easing.next(grid.folds).empty());

    Grid other;
    other.folds[0] = 1;
    auto regions = other.easing.next(other.folds);
    other.folds[0] = 0;
    other.easing.learn(regions, other.folds);
    regions = other.easing.next(other.folds);
    regions[0].out = true; // It would fold again.
    other.easing.learn(regions, other.folds);
    EXPECT_TRUE(other.easing.next(other.folds).empty());
}

TEST(FoldEasing, quads_that_touch_move_together_and_others_do_not)
{
    Grid grid;
    const std::vector<Index> near = grid.response.with_neighbours({0});
    const Index far = grid.domain.complex.quad_count() - 1;
    grid.folds[near[0]] = grid.folds[near[1]] = grid.folds[far] = 1;
    const auto regions = grid.easing.next(grid.folds);
    ASSERT_EQ(regions.size(), 2u);
    EXPECT_EQ(regions[0].core, (std::vector<Index>{near[0], near[1]}));
    EXPECT_EQ(regions[1].core, std::vector<Index>{far});
}

} // namespace
} // namespace bot2nurbs::test
