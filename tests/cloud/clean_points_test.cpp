// SPDX-License-Identifier: MIT
#include "bot2nurbs/clean_points.h"
#include "cloud_fixtures.h"

#include <gtest/gtest.h>
#include <limits>

namespace bot2nurbs {
namespace {

const double nan_value = std::numeric_limits<double>::quiet_NaN();

PointCloud sphere_cloud(std::size_t n)
{
    const auto s = fixtures::sphere_points(n);
    PointCloud cloud;
    cloud.positions = s.points;
    cloud.normals = s.normals;
    return cloud;
}

TEST(CleanPoints, a_clean_cloud_stays_as_it_is)
{
    Context context;
    const PointCloud cloud = sphere_cloud(200);
    const auto clean = clean_points(cloud, context);
    ASSERT_TRUE(clean);
    EXPECT_EQ(clean->positions, cloud.positions);
    EXPECT_EQ(clean->not_finite + clean->duplicates + clean->without_normal, 0u);
    for (Index i = 0; i < 200; ++i)
        EXPECT_EQ(clean->source[i], i);
}

TEST(CleanPoints, points_that_are_not_finite_are_dropped_and_counted)
{
    Context context;
    PointCloud cloud = sphere_cloud(100);
    cloud.positions[3].y = nan_value;
    cloud.positions[50].z = std::numeric_limits<double>::infinity();
    const auto clean = clean_points(cloud, context);
    ASSERT_TRUE(clean);
    EXPECT_EQ(clean->not_finite, 2u);
    EXPECT_EQ(clean->positions.size(), 98u);
    EXPECT_EQ(clean->source[3], 4u);
    EXPECT_EQ(clean->positions[3], cloud.positions[4]);
}

TEST(CleanPoints, points_at_one_place_become_one_with_their_mean_normal)
{
    Context context;
    PointCloud cloud = sphere_cloud(100);
    cloud.positions.push_back(cloud.positions[10]);
    cloud.normals.push_back(5.0 * cloud.normals[10]); // the length counts for nothing
    cloud.positions.push_back({0.0, 0.0, 0.0});
    cloud.normals.push_back({1.0, 0.0, 0.0});
    cloud.positions.push_back({0.0, -0.0, 0.0});
    cloud.normals.push_back({0.0, 1.0, 0.0});
    const auto clean = clean_points(cloud, context);
    ASSERT_TRUE(clean);
    EXPECT_EQ(clean->duplicates, 2u);
    ASSERT_EQ(clean->positions.size(), 101u);
    EXPECT_NEAR(norm(clean->normals[10] - cloud.normals[10]), 0.0, 1e-15);
    EXPECT_NEAR(clean->normals[100].x, std::sqrt(0.5), 1e-15);
    EXPECT_NEAR(clean->normals[100].y, std::sqrt(0.5), 1e-15);
}

TEST(CleanPoints, zero_normals_are_counted_and_none_but_zero_ones_are_none)
{
    Context context;
    PointCloud cloud = sphere_cloud(100);
    cloud.normals[7] = {};
    cloud.normals[8].x = nan_value;
    auto clean = clean_points(cloud, context);
    ASSERT_TRUE(clean);
    EXPECT_EQ(clean->without_normal, 2u);
    cloud.normals.assign(100, Vec3{});
    clean = clean_points(cloud, context);
    ASSERT_TRUE(clean);
    EXPECT_TRUE(clean->normals.empty());
}

TEST(CleanPoints, confidence_counts_relative_to_its_median)
{
    Context context;
    PointCloud cloud = sphere_cloud(101);
    cloud.confidence.assign(101, 40.0);
    cloud.confidence[0] = 10.0;
    cloud.confidence[1] = 1000.0;
    cloud.confidence[2] = -3.0;
    cloud.confidence[3] = nan_value;
    const auto clean = clean_points(cloud, context);
    ASSERT_TRUE(clean);
    EXPECT_EQ(clean->confidence[0], 0.25);
    EXPECT_EQ(clean->confidence[1], 1.0);
    EXPECT_EQ(clean->confidence[2], 0.0);
    EXPECT_EQ(clean->confidence[3], 0.0);
    EXPECT_EQ(clean->confidence[4], 1.0);
}

TEST(CleanPoints, too_few_points_are_refused_with_their_number)
{
    Context context;
    PointCloud cloud = sphere_cloud(29);
    cloud.positions.insert(cloud.positions.end(), 100, cloud.positions[0]);
    cloud.normals.resize(129);
    const auto clean = clean_points(cloud, context);
    ASSERT_FALSE(clean);
    EXPECT_EQ(clean.error().code, ErrorCode::bad_geometry);
    EXPECT_NE(clean.error().message.find("29 of 129"), std::string::npos);
    EXPECT_FALSE(clean_points({}, context));
}

TEST(CleanPoints, points_on_a_line_are_refused_at_any_scale)
{
    Context context;
    for (const double scale : {1e-6, 1.0, 1e6}) {
        PointCloud cloud;
        for (int i = 0; i < 100; ++i)
            cloud.positions.push_back(scale * Vec3{0.1 * i, 0.2 * i, 1.0 - 0.3 * i});
        const auto line = clean_points(cloud, context);
        ASSERT_FALSE(line);
        EXPECT_NE(line.error().message.find("line"), std::string::npos);
        cloud.positions.push_back(scale * Vec3{0.0, 1.0, 0.0});
        EXPECT_TRUE(clean_points(cloud, context));
    }
}

} // namespace
} // namespace bot2nurbs
