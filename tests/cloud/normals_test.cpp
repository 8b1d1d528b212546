// SPDX-License-Identifier: MIT
#include "bot2nurbs/estimate_normals.h"
#include "bot2nurbs/orient_normals.h"
#include "cloud_fixtures.h"

#include <algorithm>
#include <gtest/gtest.h>

namespace bot2nurbs {
namespace {

using fixtures::SampledSurface;

SurfaceEstimate must_estimate(const std::vector<Vec3>& points)
{
    Context context;
    auto estimate = estimate_normals(points, context);
    EXPECT_TRUE(estimate);
    return std::move(estimate.value());
}

std::vector<Vec3> oriented(const std::vector<Vec3>& points, const OrientOptions& options = {},
                           unsigned threads = 0)
{
    Context context;
    context.threads = threads;
    SurfaceEstimate estimate = must_estimate(points);
    EXPECT_TRUE(orient_normals(points, estimate, options, context));
    return estimate.normals;
}

TEST(EstimateNormals, of_a_sphere_they_are_radial_and_the_spacing_is_the_root_of_the_area_a_point)
{
    constexpr std::size_t n = 5000;
    for (const double scale : {1e-6, 1.0, 1e6}) {
        const auto s = fixtures::sphere_points(n, scale);
        const SurfaceEstimate e = must_estimate(s.points);
        for (std::size_t i = 0; i < n; ++i)
            EXPECT_GT(std::abs(dot(e.normals[i], s.normals[i])), std::cos(0.05));
        const double spacing = scale * std::sqrt(4.0 * fixtures::pi / n);
        EXPECT_NEAR(e.median_spacing, spacing, 0.1 * spacing);
        EXPECT_LT(e.noise, 0.01 * spacing);
        EXPECT_LT(e.noise_ratio, 0.01);
        EXPECT_EQ(std::count(e.outlier.begin(), e.outlier.end(), 1), 0);
    }
}

TEST(EstimateNormals, the_noise_is_that_which_was_added)
{
    const auto s = fixtures::sphere_points(10000);
    for (const double noise : {0.005, 0.01, 0.02}) {
        const SurfaceEstimate e = must_estimate(fixtures::with_noise(s.points, noise));
        EXPECT_NEAR(e.noise, noise, 0.15 * noise);
    }
}

TEST(EstimateNormals, points_that_fill_space_are_told_from_a_surface)
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    std::vector<Vec3> points;
    for (int i = 0; i < 5000; ++i)
        points.push_back({uniform(random), uniform(random), uniform(random)});
    EXPECT_GT(must_estimate(points).noise_ratio, 0.25);
}

TEST(EstimateNormals, far_points_are_outliers_without_confidence_and_the_others_are_not)
{
    auto s = fixtures::sphere_points(5000);
    for (int k = 0; k < 6; ++k)
        s.points.push_back(Vec3{0.4 * k - 1.0, 1.5, 0.3 * k});
    const SurfaceEstimate e = must_estimate(s.points);
    EXPECT_EQ(std::count(e.outlier.begin(), e.outlier.begin() + 5000, 1), 0);
    for (std::size_t i = 5000; i < s.points.size(); ++i) {
        EXPECT_EQ(e.outlier[i], 1);
        EXPECT_EQ(e.confidence[i], 0.0);
    }
}

TEST(EstimateNormals, confidence_is_high_on_a_smooth_surface_and_low_at_an_edge)
{
    // Two half planes that meet at a right angle.
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    std::vector<Vec3> points;
    for (int i = 0; i < 4000; ++i) {
        const double u = uniform(random), v = uniform(random);
        points.push_back(i % 2 == 0 ? Vec3{u, v, 0.0} : Vec3{0.0, v, u});
    }
    const SurfaceEstimate e = must_estimate(points);
    std::vector<double> edge, flat;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double away = std::max(points[i].x, points[i].z);
        if (away < 0.02)
            edge.push_back(e.confidence[i]);
        else if (away > 0.2 && away < 0.8)
            flat.push_back(e.confidence[i]);
    }
    const auto mean = [](const std::vector<double>& v) {
        double sum = 0.0;
        for (const double x : v)
            sum += x;
        return sum / double(v.size());
    };
    EXPECT_GT(mean(flat), 0.85);
    EXPECT_LT(mean(edge), mean(flat) - 0.2);
}

TEST(EstimateNormals, too_few_points_and_points_that_are_not_finite_are_refused_by_name)
{
    Context context;
    const auto few = estimate_normals({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, context);
    ASSERT_FALSE(few);
    EXPECT_EQ(few.error().code, ErrorCode::bad_geometry);
    auto s = fixtures::sphere_points(50);
    s.points[17].z = INFINITY;
    const auto bad = estimate_normals(s.points, context);
    ASSERT_FALSE(bad);
    EXPECT_EQ(bad.error().element, 17u);
}

TEST(EstimateNormals, coinciding_points_and_points_on_a_grid_line_do_no_harm)
{
    std::vector<Vec3> points(40, Vec3{1.0, 2.0, 3.0});
    for (int i = 0; i < 40; ++i)
        points.push_back({double(i), 0.0, 0.0});
    const SurfaceEstimate e = must_estimate(points);
    for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_NEAR(norm(e.normals[i]), 1.0, 1e-12);
        EXPECT_TRUE(e.confidence[i] >= 0.0 && e.confidence[i] <= 1.0);
    }
}

TEST(OrientNormals, of_a_torus_all_turn_outward)
{
    const auto s = fixtures::torus_points(6000);
    EXPECT_EQ(fixtures::right_share(oriented(s.points), s.normals), 1.0);
}

TEST(OrientNormals, of_separate_bodies_each_turns_outward)
{
    SampledSurface s = fixtures::joined(fixtures::sphere_points(3000),
                                        fixtures::sphere_points(3000, 1.0, {2.3, 0.0, 0.0}));
    s = fixtures::joined(s, fixtures::sphere_points(800, 0.5, {0.0, 3.0, 0.0}));
    EXPECT_EQ(fixtures::right_share(oriented(s.points), s.normals), 1.0);
}

TEST(OrientNormals, the_wall_of_a_hollow_turns_into_the_hollow)
{
    SampledSurface s = fixtures::sphere_points(2500, 0.6);
    for (Vec3& n : s.normals)
        n = -n;
    s = fixtures::joined(s, fixtures::sphere_points(6000));
    EXPECT_GE(fixtures::right_share(oriented(s.points), s.normals), 0.999);
}

TEST(OrientNormals, thin_plates_are_told_apart)
{
    // An ellipsoid two spacings thick in the middle.
    auto s = fixtures::sphere_points(6000);
    for (std::size_t i = 0; i < s.points.size(); ++i) {
        s.points[i].z *= 0.05;
        s.normals[i].z /= 0.05;
    }
    EXPECT_GE(fixtures::right_share(oriented(s.points), s.normals), 0.999);
}

TEST(OrientNormals, noise_of_two_percent_of_the_size_leaves_99_percent_right)
{
    const auto s = fixtures::torus_points(8000);
    const auto noisy = fixtures::with_noise(s.points, 0.04);
    EXPECT_GE(fixtures::right_share(oriented(noisy), s.normals), 0.99);
}

TEST(OrientNormals, more_points_than_are_solved_follow_a_subset)
{
    const auto s = fixtures::torus_points(20000);
    OrientOptions options;
    options.most_points = 2000;
    EXPECT_GE(fixtures::right_share(oriented(s.points, options), s.normals), 0.999);
}

TEST(OrientNormals, a_viewpoint_turns_all_normals_towards_it)
{
    auto s = fixtures::sphere_points(8000);
    std::vector<Vec3> seen; // what a scanner at (5, 0, 0) sees
    for (const Vec3& p : s.points)
        if (dot(p, Vec3{5.0, 0.0, 0.0} - p) > 0.0)
            seen.push_back(p);
    OrientOptions options;
    options.viewpoint = Vec3{5.0, 0.0, 0.0};
    const auto normals = oriented(seen, options);
    EXPECT_EQ(fixtures::right_share(normals, seen), 1.0);
}

TEST(OrientNormals, the_same_for_any_thread_count)
{
    const auto s = fixtures::torus_points(3000);
    EXPECT_EQ(oriented(s.points, {}, 1), oriented(s.points, {}, 3));
}

TEST(OrientNormals, options_out_of_range_are_refused)
{
    OrientOptions options;
    options.viewpoint = Vec3{NAN, 0.0, 0.0};
    EXPECT_TRUE(options.check());
    options = {};
    options.most_points = 10;
    EXPECT_TRUE(options.check());
}

TEST(OrientNormals, a_cancelled_call_says_so)
{
    const auto s = fixtures::torus_points(500);
    SurfaceEstimate estimate = must_estimate(s.points);
    Context context;
    context.cancel();
    const auto summary = orient_normals(s.points, estimate, {}, context);
    ASSERT_FALSE(summary);
    EXPECT_EQ(summary.error().code, ErrorCode::cancelled);
}

TEST(ContradictedNormals, are_the_flipped_ones_and_no_others)
{
    Context context;
    auto s = fixtures::torus_points(5000);
    auto found = contradicted_normals(s.points, s.normals, context);
    ASSERT_TRUE(found);
    EXPECT_EQ(std::count(found->begin(), found->end(), 1), 0);
    for (std::size_t i = 0; i < s.points.size(); i += 50)
        s.normals[i] = -s.normals[i];
    found = contradicted_normals(s.points, s.normals, context);
    ASSERT_TRUE(found);
    EXPECT_EQ(std::count(found->begin(), found->end(), 1), 100);
    EXPECT_EQ((*found)[50], 1);
}

} // namespace
} // namespace bot2nurbs
