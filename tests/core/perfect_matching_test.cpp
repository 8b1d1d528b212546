// SPDX-License-Identifier: MIT
#include "core/perfect_matching.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace bot2nurbs {
namespace {

constexpr double none = std::numeric_limits<double>::infinity();

//! Least cost of covering the nodes that are not yet covered, by trying everything.
double brute_force(Index nodes, const std::vector<MatchingEdge>& edges, std::uint32_t covered)
{
    Index first = 0;
    while (first < nodes && (covered >> first & 1u) != 0)
        ++first;
    if (first == nodes)
        return 0.0;
    double best = none;
    for (const MatchingEdge& e : edges) {
        if (e.a != first && e.b != first)
            continue;
        const Index other = e.a == first ? e.b : e.a;
        if ((covered >> other & 1u) == 0)
            best = std::min(
                best, e.cost + brute_force(nodes, edges, covered | 1u << first | 1u << other));
    }
    return best;
}

TEST(PerfectMatching, is_the_cheapest_of_all_on_random_graphs)
{
    std::mt19937 random(7);
    Index without = 0;
    for (int trial = 0; trial < 300; ++trial) {
        const Index nodes = 2 + random() % 9;
        std::vector<MatchingEdge> edges;
        for (Index a = 0; a < nodes; ++a)
            for (Index b = a + 1; b < nodes; ++b)
                if (random() % 3 != 0)
                    edges.push_back({a, b, static_cast<double>(random() % 2001) - 1000.0});
        const double expected = brute_force(nodes, edges, 0);
        const auto chosen = cheapest_perfect_matching(nodes, edges);
        ASSERT_EQ(chosen.has_value(), expected < none) << "trial " << trial;
        without += !chosen;
        if (!chosen)
            continue;
        std::vector<int> covered(nodes, 0);
        double cost = 0.0;
        for (const Index i : *chosen) {
            ++covered[edges[i].a];
            ++covered[edges[i].b];
            cost += edges[i].cost;
        }
        EXPECT_EQ(covered, std::vector<int>(nodes, 1));
        EXPECT_DOUBLE_EQ(cost, expected) << "trial " << trial;
    }
    EXPECT_GT(without, 20u); // Odd numbers of nodes among others.
}

} // namespace
} // namespace bot2nurbs
