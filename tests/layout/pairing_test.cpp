// SPDX-License-Identifier: MIT
#include "layout/pairing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace bot2nurbs {
namespace {

struct Best {
    double worst = INFINITY, cost = INFINITY;
};

// All perfect matchings by depth-first search: the smallest worst distortion, then, up to `limit`,
// the smallest cost.
void search(Index faces, const std::vector<PairCandidate>& all, std::vector<char>& used,
            double worst, double cost, double limit, Best& best)
{
    const auto first = std::find(used.begin(), used.end(), 0);
    if (first == used.end()) {
        best.worst = std::min(best.worst, worst);
        if (worst <= limit)
            best.cost = std::min(best.cost, cost);
        return;
    }
    const Index f = static_cast<Index>(first - used.begin());
    for (const PairCandidate& c : all) {
        const Index other = c.face_a == f ? c.face_b : c.face_b == f ? c.face_a : invalid_index;
        if (other == invalid_index || used[other])
            continue;
        used[f] = used[other] = 1;
        search(faces, all, used, std::max(worst, c.distortion), cost + c.cost, limit, best);
        used[f] = used[other] = 0;
    }
}

TEST(Pairing, equals_exhaustive_search_on_random_cubic_graphs)
{
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(1.0, 3.0);
    int matched = 0;
    for (int round = 0; round < 60; ++round) {
        // A ring with random diagonals: degree at most three, always a perfect matching.
        const Index n = 12;
        std::vector<PairCandidate> all;
        for (Index i = 0; i < n; ++i)
            all.push_back({i, (i + 1) % n, uniform(random), uniform(random)});
        for (Index i = 0; i < n / 2; ++i)
            all.push_back({i, i + n / 2, uniform(random), uniform(random)});
        const double slack = round % 2 ? 1.0 : 1.3;
        std::vector<char> used(n, 0);
        Best bottleneck;
        search(n, all, used, 0.0, 0.0, 0.0, bottleneck);
        Best best;
        search(n, all, used, 0.0, 0.0, bottleneck.worst * slack, best);
        const auto chosen = match_faces(n, all, slack);
        ASSERT_TRUE(chosen);
        double worst = 0.0, cost = 0.0;
        std::vector<int> count(n, 0);
        for (const Index c : *chosen) {
            worst = std::max(worst, all[c].distortion);
            cost += all[c].cost;
            ++count[all[c].face_a], ++count[all[c].face_b];
        }
        EXPECT_TRUE(std::all_of(count.begin(), count.end(), [](int k) { return k == 1; }));
        EXPECT_LE(worst, bottleneck.worst * slack);
        EXPECT_NEAR(cost, best.cost, 1e-7);
        ++matched;
    }
    EXPECT_EQ(matched, 60);
}

TEST(Pairing, without_a_perfect_matching_is_empty)
{
    // A star of three leaves.
    const std::vector<PairCandidate> all{{0, 1, 1.0, 1.0}, {0, 2, 1.0, 1.0}, {0, 3, 1.0, 1.0}};
    EXPECT_FALSE(match_faces(4, all, 1.0));
    EXPECT_FALSE(match_faces(2, {}, 1.0));
}

} // namespace
} // namespace bot2nurbs
