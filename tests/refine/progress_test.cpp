// SPDX-License-Identifier: MIT
#include "refine/progress.h"

#include <gtest/gtest.h>

namespace bot2nurbs {
namespace {

RefinementRound round_of(Index patches, double distance, Index exceeding)
{
    RefinementRound round;
    round.patches = patches;
    round.distance.lower = distance;
    round.exceeding = exceeding;
    return round;
}

TEST(Stalled, rounds_in_vain_count_when_their_patches_grew_by_a_fifth)
{
    std::vector<RefinementRound> rounds{round_of(500, 1.0, 5), round_of(515, 1.0, 5),
                                        round_of(530, 0.95, 5)};
    EXPECT_FALSE(stalled(rounds, 0, 2));
    rounds.push_back(round_of(600, 0.95, 5));
    EXPECT_TRUE(stalled(rounds, 0, 2));
    EXPECT_TRUE(stalled(rounds, 0, 3));
    EXPECT_FALSE(stalled(rounds, 0, 4));
    EXPECT_FALSE(stalled(rounds, 2, 2)); // Two of them had other rows.
}

TEST(Stalled, eight_rounds_are_enough_however_few_patches_were_cut)
{
    std::vector<RefinementRound> rounds{round_of(500, 1.0, 1)};
    for (int i = 1; i <= 8; ++i) {
        EXPECT_FALSE(stalled(rounds, 0, 2)) << i;
        rounds.push_back(round_of(500 + i, 1.0, 1));
    }
    EXPECT_TRUE(stalled(rounds, 0, 2));
}

TEST(Stalled, fewer_patches_beyond_or_a_distance_that_falls_slowly_are_progress)
{
    std::vector<RefinementRound> rounds{round_of(100, 1.0, 10), round_of(200, 1.1, 10),
                                        round_of(300, 1.1, 9)};
    EXPECT_FALSE(stalled(rounds, 0, 2));
    // By five hundredths each: the second makes up a tenth.
    rounds = {round_of(100, 1.0, 10), round_of(200, 0.95, 10), round_of(300, 0.9, 10),
              round_of(400, 0.86, 10)};
    EXPECT_FALSE(stalled(rounds, 0, 2));
    EXPECT_TRUE(
        stalled({round_of(100, 1.0, 10), round_of(200, 0.95, 10), round_of(300, 0.91, 10)}, 0, 2));
    // Making good what was lost meanwhile is none.
    EXPECT_TRUE(stalled({round_of(100, 1.0, 5), round_of(200, 0.5, 20), round_of(300, 0.5, 12),
                         round_of(400, 0.5, 8)},
                        0, 2));
}

} // namespace
} // namespace bot2nurbs
