// SPDX-License-Identifier: MIT
#include "bot2nurbs/detect_features.h"

#include "mesh_fixtures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace bot2nurbs::fixtures {
namespace {

MeshFeatures detect(const ManifoldMesh& mesh, const FeatureOptions& options = {})
{
    Context context;
    auto features = detect_features(mesh, options, context);
    EXPECT_TRUE(features.ok());
    return std::move(*features);
}

ManifoldMesh noisy(const ManifoldMesh& mesh, double size, unsigned seed)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-size, size);
    return moved(mesh, [&](const Vec3& p) {
        return p + Vec3{uniform(random), uniform(random), uniform(random)};
    });
}

// A sheet folded along the middle, by an angle that goes from 90 degrees at one end to none.
ManifoldMesh fading_fold(int n)
{
    return moved(square(n), [](const Vec3& p) {
        const double x = p.x - 0.5, fold = std::max(0.0, 0.7 - p.y);
        return Vec3{x, p.y, std::fabs(x) * fold * 1.4};
    });
}

TEST(DetectFeatures, of_a_cube_are_its_twelve_edges)
{
    for (const int n : {1, 2, 5}) {
        const MeshFeatures f = detect(cube(n));
        EXPECT_EQ(f.creases.size(), 12u) << n;
        EXPECT_EQ(f.kept_edges, 12u * static_cast<Index>(n));
        EXPECT_EQ(f.sharp_edges, f.kept_edges);
        EXPECT_TRUE(f.smoothed.empty());
        EXPECT_EQ(f.clear_share, 1.0);
    }
}

TEST(DetectFeatures, of_smooth_shapes_are_none)
{
    for (const ManifoldMesh& mesh : {icosphere(3), torus(40, 20), smoothed(genus_two(2), 8)}) {
        const MeshFeatures f = detect(mesh);
        EXPECT_TRUE(f.creases.empty());
        EXPECT_EQ(f.kept_edges, 0u);
        EXPECT_TRUE(f.corners.empty());
    }
}

TEST(DetectFeatures, the_grain_of_a_rough_surface_is_smoothed_and_listed)
{
    // An edge of icosphere(4) is about 0.08 long: this noise turns many by more than 35 degrees.
    for (const double size : {0.025, 0.03, 0.04, 0.05}) {
        const ManifoldMesh mesh = noisy(icosphere(4), size, 7);
        const MeshFeatures f = detect(mesh);
        EXPECT_GT(f.sharp_edges, 100u);
        EXPECT_TRUE(f.creases.empty()) << size;
        EXPECT_EQ(f.smoothed.size(), f.sharp_edges);
        for (const auto& [a, b] : f.smoothed)
            EXPECT_TRUE(mesh.find_halfedge(a, b) != invalid_index);
    }
}

TEST(DetectFeatures, of_a_noisy_cube_are_still_its_edges)
{
    const ManifoldMesh mesh = noisy(cube(10), 0.01, 3);
    const MeshFeatures f = detect(mesh);
    EXPECT_GE(f.kept_edges, 115u);
    EXPECT_LE(f.kept_edges, 125u);
}

TEST(DetectFeatures, a_crease_that_fades_is_kept_to_where_it_is_weak)
{
    const MeshFeatures f = detect(fading_fold(24));
    ASSERT_EQ(f.creases.size(), 1u);
    // Strong down to 35 degrees, then weak down to half of that.
    EXPECT_GT(f.kept_edges, 8u);
    EXPECT_LT(f.kept_edges, 18u);
}

TEST(DetectFeatures, the_corners_of_a_boundary_are_where_it_turns_and_not_along_arcs)
{
    const MeshFeatures sheet = detect(square(6));
    EXPECT_EQ(sheet.corners.size(), 4u);
    for (const Index v : sheet.corners) {
        const Vec3 p = square(6).position(v);
        EXPECT_TRUE((p.x == 0.0 || p.x == 1.0) && (p.y == 0.0 || p.y == 1.0));
    }
    // Rims in few edges are still round.
    for (const int m : {8, 12, 40})
        EXPECT_TRUE(detect(open_cylinder(m, 4)).corners.empty()) << m;
}

TEST(DetectFeatures, do_not_depend_on_scale_and_place)
{
    const ManifoldMesh mesh = noisy(cube(6), 0.01, 5);
    const MeshFeatures first = detect(mesh);
    for (const double scale : {1e-6, 1e6}) {
        const MeshFeatures other = detect(moved(mesh, [scale](const Vec3& p) {
            return scale * p + Vec3{scale, 0.0, 0.0};
        }));
        EXPECT_EQ(other.creases, first.creases);
        EXPECT_EQ(other.corners, first.corners);
    }
}

TEST(DetectFeatures, options_out_of_range_are_named)
{
    Context context;
    FeatureOptions bad;
    bad.angle = 0.0;
    EXPECT_EQ(detect_features(cube(1), bad, context).error().code, ErrorCode::bad_option);
    bad = {};
    bad.weak_share = 2.0;
    EXPECT_EQ(detect_features(cube(1), bad, context).error().code, ErrorCode::bad_option);
    bad = {};
    bad.least_clear_share = -1.0;
    EXPECT_EQ(detect_features(cube(1), bad, context).error().code, ErrorCode::bad_option);
}

} // namespace
} // namespace bot2nurbs::fixtures
