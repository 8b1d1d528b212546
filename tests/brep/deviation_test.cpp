// SPDX-License-Identifier: MIT
#include "bot2nurbs/deviation.h"

#include "hausdorff_fixtures.h"

#include <cmath>
#include <gtest/gtest.h>

namespace bot2nurbs {
namespace {

using fixtures::flat_patches;

TEST(Deviation, is_zero_for_a_cube_against_its_own_flat_patches)
{
    const fixtures::Domain cube = fixtures::cube();
    Context context;
    const auto d = measure_deviation(fixtures::cube(5), cube.complex, flat_patches(cube), context);
    ASSERT_TRUE(d.ok());
    EXPECT_LT(d->max(), 1e-14);
    EXPECT_LT(d->rms(), 1e-14);
    EXPECT_GE(d->source_to_surface.samples, 4000u);
    EXPECT_GT(d->surface_to_source.samples, 1000u);
}

TEST(Deviation, of_a_shifted_square_is_the_shift_both_ways)
{
    const fixtures::Domain disk = fixtures::disk_grid(1, 1);
    SplineSurface surface = flat_patches(disk);
    surface.transform(1.0, {0.0, 0.0, 0.25});
    Context context;
    const auto d = measure_deviation(fixtures::square(6), disk.complex, surface, context);
    ASSERT_TRUE(d.ok());
    for (const DistanceStatistics* s : {&d->source_to_surface, &d->surface_to_source}) {
        EXPECT_NEAR(s->max, 0.25, 1e-14);
        EXPECT_NEAR(s->rms, 0.25, 1e-14);
    }
    EXPECT_NEAR(d->source_to_surface.worst.z, 0.0, 1e-15);
    EXPECT_NEAR(d->surface_to_source.worst.z, 0.25, 1e-15);
}

TEST(Deviation, sees_what_only_one_direction_shows)
{
    // The mesh covers one of three unit squares: from the mesh nothing is wrong; the far end of the
    // surface is two away, and its mean square distance is the integral of (x - 1)^2 over [1, 3]
    // divided by the area 3.
    const fixtures::Domain strip = fixtures::disk_grid(3, 1);
    Context context;
    const auto d =
        measure_deviation(fixtures::square(4), strip.complex, flat_patches(strip), context);
    ASSERT_TRUE(d.ok());
    EXPECT_LT(d->source_to_surface.max, 1e-14);
    EXPECT_NEAR(d->surface_to_source.max, 2.0, 1e-14);
    EXPECT_NEAR(d->surface_to_source.rms, std::sqrt(8.0 / 9.0), 1e-4);
    EXPECT_EQ(d->worst_patch, 2u);
    EXPECT_EQ(d->max(), d->surface_to_source.max);
}

TEST(Deviation, weighs_by_area_and_not_by_triangle_or_vertex)
{
    // Rows of triangles crowd towards x = 0, where the distance is small: the mean square of
    // z = x is 1 / 3 however the square is cut.
    const ManifoldMesh crowded = fixtures::moved(fixtures::square(40), [](const Vec3& p) -> Vec3 {
        return {p.x * p.x * p.x * p.x, p.y, 0.0};
    });
    const fixtures::Domain disk = fixtures::disk_grid(1, 1);
    SplineSurface surface = flat_patches(disk);
    // A tilted plane above the square, narrow enough in slope that the foot stays above it.
    constexpr double slope = 1e-3;
    for (Vec3& c : surface.bezier())
        c.z = slope * c.x;
    Context context;
    const auto d = measure_deviation(crowded, disk.complex, surface, context);
    ASSERT_TRUE(d.ok());
    EXPECT_NEAR(d->source_to_surface.rms / slope, std::sqrt(1.0 / 3.0), 1e-3);
    EXPECT_NEAR(d->surface_to_source.rms / slope, std::sqrt(1.0 / 3.0), 1e-3);
}

TEST(Deviation, is_the_same_for_any_number_of_threads)
{
    const fixtures::Domain cube = fixtures::refine(fixtures::cube());
    Context one, many;
    one.threads = 1;
    many.threads = 8;
    const ManifoldMesh sphere = fixtures::icosphere(3);
    const auto a = measure_deviation(sphere, cube.complex, flat_patches(cube), one);
    const auto b = measure_deviation(sphere, cube.complex, flat_patches(cube), many);
    ASSERT_TRUE(a.ok() && b.ok());
    EXPECT_EQ(a->source_to_surface.rms, b->source_to_surface.rms);
    EXPECT_EQ(a->surface_to_source.rms, b->surface_to_source.rms);
    EXPECT_EQ(a->source_to_surface.max, b->source_to_surface.max);
    EXPECT_EQ(a->worst_patch, b->worst_patch);
}

TEST(Deviation, of_a_sphere_in_its_cube_is_known_at_corners_and_centres)
{
    // From the cube's corners the unit sphere is sqrt(3) - 1 away. Towards them the sphere is
    // 1 - 1/sqrt(3) from the cube, which falls linearly with the distance of the nearest sample. Of
    // eight corners one has a sample near.
    const fixtures::Domain cube = fixtures::cube();
    Context context;
    const auto d =
        measure_deviation(fixtures::icosphere(5), cube.complex, flat_patches(cube), context);
    ASSERT_TRUE(d.ok());
    EXPECT_NEAR(d->surface_to_source.max, std::sqrt(3.0) - 1.0, 1e-3);
    EXPECT_LE(d->source_to_surface.max, 1.0 - 1.0 / std::sqrt(3.0) + 1e-14);
    EXPECT_GE(d->source_to_surface.max, 1.0 - 1.0 / std::sqrt(3.0) - 1e-2);
}

TEST(Deviation, stops_when_cancelled)
{
    const fixtures::Domain cube = fixtures::cube();
    Context context;
    context.cancel();
    const auto d = measure_deviation(fixtures::cube(2), cube.complex, flat_patches(cube), context);
    ASSERT_FALSE(d.ok());
    EXPECT_EQ(d.error().code, ErrorCode::cancelled);
}

TEST(Deviation, refuses_an_empty_surface)
{
    Context context;
    const auto d = measure_deviation(fixtures::cube(2), fixtures::cube().complex, {}, context);
    ASSERT_FALSE(d.ok());
    EXPECT_EQ(d.error().code, ErrorCode::empty_input);
}

} // namespace
} // namespace bot2nurbs
