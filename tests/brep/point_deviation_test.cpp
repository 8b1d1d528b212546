// SPDX-License-Identifier: MIT
#include "bot2nurbs/point_deviation.h"

#include "hausdorff_fixtures.h"

#include <cmath>
#include <gtest/gtest.h>

namespace bot2nurbs {
namespace {

TEST(PointDeviation, of_points_above_and_beside_a_square_is_known)
{
    const fixtures::Domain disk = fixtures::disk_grid(1, 1);
    const SplineSurface surface = fixtures::flat_patches(disk);
    Vec3 low{INFINITY, INFINITY, 0.0}, high{-INFINITY, -INFINITY, 0.0};
    for (const Vec3& p : disk.positions) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), 0.0};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), 0.0};
    }
    const Vec3 middle = 0.5 * (low + high);
    Context context;
    const auto d = find_point_feet({middle, middle + Vec3{0.0, 0.0, 0.5},
                                    middle + Vec3{0.1, -0.1, -0.25}, high + Vec3{3.0, 4.0, 0.0}},
                                   disk.complex, surface, context);
    ASSERT_TRUE(d.ok());
    EXPECT_NEAR((*d)[0].distance, 0.0, 1e-14);
    EXPECT_NEAR((*d)[1].distance, 0.5, 1e-14);
    EXPECT_NEAR((*d)[2].distance, 0.25, 1e-14);
    EXPECT_NEAR((*d)[3].distance, 5.0, 1e-9);
}

TEST(PointDeviation, statistics_are_those_of_the_distances)
{
    std::vector<double> distances;
    for (int i = 1; i <= 100; ++i)
        distances.push_back(0.01 * i);
    std::swap(distances[3], distances[99]); // the largest is point 3
    const PointDeviation d = summarise_distances(distances);
    EXPECT_EQ(d.points, 100u);
    EXPECT_EQ(d.max, 1.0);
    EXPECT_EQ(d.worst, 3u);
    EXPECT_NEAR(d.rms, std::sqrt(0.33835), 1e-12); // sum of squares n (n + 1) (2 n + 1) / 6
    EXPECT_NEAR(d.median, 0.51, 1e-12);
    EXPECT_NEAR(d.percentile_95, 0.96, 1e-12);
    EXPECT_EQ(share_within(distances, 0.255), 0.25);
    EXPECT_EQ(share_within({}, 1.0), 1.0);
}

TEST(PointDeviation, far_points_are_beyond_three_deviations_of_the_median_or_of_what_is_expected)
{
    std::vector<double> distances(100, 0.1);
    distances[7] = 0.44; // three times 1.4826 times 0.1 is 0.445
    distances[8] = 0.45;
    EXPECT_EQ(summarise_distances(distances).far_points, 1u);
    EXPECT_EQ(summarise_distances(distances, 0.149).far_points, 1u);
    EXPECT_EQ(summarise_distances(distances, 0.2).far_points, 0u);
    EXPECT_EQ(summarise_distances({}).points, 0u);
}

TEST(PointDeviation, stops_when_cancelled_and_refuses_an_empty_surface)
{
    const fixtures::Domain disk = fixtures::disk_grid(1, 1);
    Context context;
    EXPECT_EQ(find_point_feet({}, disk.complex, SplineSurface(), context).error().code,
              ErrorCode::empty_input);
    context.cancel();
    EXPECT_EQ(find_point_feet({{0, 0, 0}}, disk.complex, fixtures::flat_patches(disk), context)
                  .error()
                  .code,
              ErrorCode::cancelled);
}

} // namespace
} // namespace bot2nurbs
