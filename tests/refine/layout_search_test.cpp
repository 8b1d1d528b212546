// SPDX-License-Identifier: MIT
#include "refine/layout_search.h"

#include <gtest/gtest.h>

namespace bot2nurbs {
namespace {

TEST(LayoutSearch, the_next_layout_is_finer_by_the_measured_power_of_the_distance_within_bounds)
{
    const auto growth = [](double ratio) {
        LayoutSearch search(5000);
        const double before = search.patches();
        search.look_at(search.patches(), 10, ratio);
        return search.patches() / before;
    };
    EXPECT_NEAR(growth(2.83), 2.0, 0.05);
    EXPECT_NEAR(growth(1.01), 1.4, 0.05);
    EXPECT_NEAR(growth(1000.0), 4.0, 0.05);
}

TEST(LayoutSearch, a_layout_that_is_no_nearer_than_a_coarser_one_is_forgiven_once_in_a_row)
{
    LayoutSearch search(5000);
    EXPECT_TRUE(search.look_at(30, 20, 3.0).best);
    const Index before = search.patches();
    const auto worse = search.look_at(60, 40, 30.0);
    EXPECT_FALSE(worse.best);
    EXPECT_FALSE(worse.done);
    // It says little about how many patches there should be.
    EXPECT_LT(search.patches(), 1.5 * before);
    EXPECT_TRUE(search.look_at(90, 50, 2.0).best);
    EXPECT_FALSE(search.look_at(150, 80, 2.5).done);
    const auto again = search.look_at(250, 120, 2.2);
    EXPECT_FALSE(again.best);
    EXPECT_TRUE(again.done);
}

TEST(LayoutSearch, where_few_patches_are_left_the_one_that_may_end_with_the_fewest_is_the_best)
{
    LayoutSearch search(5000);
    // Expected are 40 + 600 patches, for the proof says that many more are beyond than samples did.
    const auto first = search.look_at(40, 20, 0.8);
    EXPECT_TRUE(first.best);
    EXPECT_FALSE(first.done);
    EXPECT_EQ(search.patches(), 30u);
    const auto many_left = search.look_at(55, 6, 1.2); // Of samples alone: nothing was proven.
    EXPECT_FALSE(many_left.best);
    EXPECT_FALSE(many_left.done);
    // 60 + 30, and any that is finer by a quarter has 75.
    const auto fewer_left = search.look_at(60, 1, 0.6);
    EXPECT_TRUE(fewer_left.best);
    EXPECT_FALSE(fewer_left.done);
    // 78 + 60, and any that is finer by a quarter has more than 90.
    const auto more_left = search.look_at(78, 2, 0.5);
    EXPECT_FALSE(more_left.best);
    EXPECT_TRUE(more_left.done);
}

TEST(LayoutSearch, finer_layouts_are_tried_four_times_at_most)
{
    LayoutSearch search(5000);
    for (int i = 0; i < 4; ++i)
        EXPECT_FALSE(search.look_at(100, 20, 0.9).done) << i;
    EXPECT_TRUE(search.look_at(100, 20, 0.9).done);
}

TEST(LayoutSearch, layouts_that_topology_keeps_above_what_is_asked_for_are_not_made_again)
{
    LayoutSearch search(5000);
    search.look_at(480, 100, 2.0);
    EXPECT_GT(search.patches(), 480u);
}

TEST(LayoutSearch, no_more_patches_than_the_limit_are_asked_for_and_only_once)
{
    LayoutSearch search(60);
    EXPECT_FALSE(search.look_at(30, 20, 8.0).done); // 96 by the distance
    EXPECT_EQ(search.patches(), 60u);
    EXPECT_TRUE(search.look_at(60, 20, 4.0).done);
}

} // namespace
} // namespace bot2nurbs
