// SPDX-License-Identifier: MIT
#include "cloud/point_tree.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <random>

namespace bot2nurbs {
namespace {

// On a coarse grid, so that many points are equally near and some coincide.
std::vector<Vec3> grid_points(std::size_t n)
{
    std::mt19937 random(5);
    std::uniform_int_distribution<int> step(0, 9);
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < n; ++i)
        points.push_back({double(step(random)), double(step(random)), double(step(random))});
    return points;
}

std::vector<PointTree::Neighbor> brute_force(const std::vector<Vec3>& points, const Vec3& p)
{
    std::vector<PointTree::Neighbor> all;
    for (Index i = 0; i < points.size(); ++i)
        all.push_back({i, norm_squared(points[i] - p)});
    std::stable_sort(all.begin(), all.end(),
                     [](const auto& a, const auto& b) { return a.distance2 < b.distance2; });
    return all;
}

TEST(PointTree,
     nearest_points_are_as_near_as_those_of_brute_force_in_the_order_of_distance_and_number)
{
    const auto points = grid_points(600);
    Context context;
    const auto tree = PointTree::build(points, context);
    ASSERT_TRUE(tree);
    std::vector<PointTree::Neighbor> found;
    for (Index q = 0; q < 50; ++q) {
        const Vec3 p = 0.5 * (points[q] + points[q + 50]);
        const auto expected = brute_force(points, p);
        for (const std::size_t k : {std::size_t{1}, std::size_t{13}, std::size_t{600}}) {
            tree->nearest(p, k, found);
            ASSERT_EQ(found.size(), k);
            for (std::size_t i = 0; i < k; ++i) {
                EXPECT_EQ(found[i].distance2, expected[i].distance2);
                EXPECT_EQ(found[i].distance2, norm_squared(points[found[i].point] - p));
                const bool tie = i > 0 && found[i].distance2 == found[i - 1].distance2;
                EXPECT_TRUE(!tie || found[i - 1].point < found[i].point);
            }
        }
        tree->within(p, 3.0, found);
        const auto count = std::count_if(expected.begin(), expected.end(),
                                         [](const auto& n) { return n.distance2 < 9.0; });
        EXPECT_EQ(found.size(), static_cast<std::size_t>(count));
    }
}

TEST(PointTree, a_point_is_not_its_own_neighbour_even_among_copies)
{
    auto points = grid_points(40);
    points.insert(points.end(), 20, points[0]);
    Context context;
    const auto tree = PointTree::build(points, context);
    ASSERT_TRUE(tree);
    const auto graph = find_neighbors(*tree, points, 12, context);
    ASSERT_TRUE(graph);
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t k = 0; k < 12; ++k)
            EXPECT_NE(graph->of(i)[k].point, i);
    EXPECT_EQ(graph->radius(0), 0.0); // 20 copies
}

TEST(PointTree, a_cancelled_build_says_so)
{
    const auto points = grid_points(100);
    Context context;
    context.cancel();
    const auto tree = PointTree::build(points, context);
    ASSERT_FALSE(tree);
    EXPECT_EQ(tree.error().code, ErrorCode::cancelled);
}

} // namespace
} // namespace bot2nurbs
