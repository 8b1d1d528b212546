// SPDX-License-Identifier: MIT
#include "bot2nurbs/find_normals.h"
#include "cloud_fixtures.h"

#include <gtest/gtest.h>

namespace bot2nurbs {
namespace {

using fixtures::SampledSurface;

CleanPoints cleaned(const SampledSurface& s)
{
    Context context;
    PointCloud cloud;
    cloud.positions = s.points;
    cloud.normals = s.normals;
    auto clean = clean_points(cloud, context);
    EXPECT_TRUE(clean);
    return std::move(clean.value());
}

CloudNormals must_find(const SampledSurface& s, NormalMode mode)
{
    Context context;
    auto found = find_normals(cleaned(s), mode, {}, context);
    EXPECT_TRUE(found);
    return std::move(found.value());
}

TEST(FindNormals, normals_of_the_file_that_agree_are_used_as_they_are)
{
    const auto s = fixtures::torus_points(3000);
    const CloudNormals found = must_find(s, NormalMode::automatic);
    EXPECT_TRUE(found.report.given);
    EXPECT_TRUE(found.report.file_has_normals);
    EXPECT_EQ(found.report.given_contradicted, 0.0);
    for (std::size_t i = 0; i < s.points.size(); ++i)
        EXPECT_NEAR(norm(found.estimate.normals[i] - s.normals[i]), 0.0, 1e-12);
}

TEST(FindNormals, flipped_normals_are_noticed_counted_and_replaced)
{
    auto s = fixtures::torus_points(4000);
    const auto right = s.normals;
    for (std::size_t i = 0; i < s.normals.size(); ++i)
        if (i % 10 < 3)
            s.normals[i] = -s.normals[i];
    const CloudNormals found = must_find(s, NormalMode::automatic);
    EXPECT_FALSE(found.report.given);
    EXPECT_NEAR(found.report.given_contradicted, 0.3, 0.1);
    EXPECT_NEAR(found.report.given_flipped, 0.3, 0.001);
    EXPECT_EQ(fixtures::right_share(found.estimate.normals, right), 1.0);
    // Asked for, they are taken, with the contradiction reported.
    const CloudNormals given = must_find(s, NormalMode::given);
    EXPECT_TRUE(given.report.given);
    EXPECT_EQ(given.report.disagreement, given.report.given_contradicted);
    EXPECT_NEAR(norm(given.estimate.normals[0] - s.normals[0]), 0.0, 1e-12);
}

TEST(FindNormals, a_missing_normal_is_filled_in_on_the_side_of_those_around_it)
{
    auto s = fixtures::torus_points(4000);
    const auto right = s.normals;
    for (std::size_t i = 0; i < s.normals.size(); i += 4)
        s.normals[i] = {};
    const CloudNormals found = must_find(s, NormalMode::automatic);
    EXPECT_TRUE(found.report.given);
    EXPECT_EQ(found.report.filled_in, 1000u);
    EXPECT_EQ(fixtures::right_share(found.estimate.normals, right), 1.0);
}

TEST(FindNormals, asking_for_normals_that_are_not_there_is_refused)
{
    auto s = fixtures::torus_points(500);
    s.normals.assign(500, Vec3{});
    Context context;
    const auto refused = find_normals(cleaned(s), NormalMode::given, {}, context);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::bad_geometry);
    EXPECT_NE(refused.error().message.find("500 of 500"), std::string::npos);
    EXPECT_TRUE(find_normals(cleaned(s), NormalMode::automatic, {}, context));
}

TEST(FindNormals, the_confidence_of_the_file_scales_that_of_the_estimate)
{
    const auto s = fixtures::torus_points(1000);
    CleanPoints points = cleaned(s);
    Context context;
    const auto plain = find_normals(points, NormalMode::estimate, {}, context);
    points.confidence.assign(1000, 1.0);
    points.confidence[5] = 0.25;
    const auto scaled = find_normals(points, NormalMode::estimate, {}, context);
    ASSERT_TRUE(plain && scaled);
    EXPECT_EQ(scaled->estimate.confidence[4], plain->estimate.confidence[4]);
    EXPECT_EQ(scaled->estimate.confidence[5], 0.25 * plain->estimate.confidence[5]);
}

} // namespace
} // namespace bot2nurbs
