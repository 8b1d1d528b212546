// SPDX-License-Identifier: MIT
#include "bot2nurbs/orient_normals.h"
#include "bot2nurbs/reconstruct_surface.h"
#include "cloud/point_tree.h"
#include "cloud/surface_coverage.h"
#include "cloud_fixtures.h"

#include <functional>
#include <gtest/gtest.h>

namespace bot2nurbs {
namespace {

using fixtures::SampledSurface;

struct Case {
    Reconstruction result;
    ManifoldMesh mesh;
    double noise = 0.0;
};

Case reconstructed(const std::vector<Vec3>& points, const ReconstructOptions& options = {},
                   unsigned threads = 0, const std::vector<Vec3>& normals = {})
{
    Context context;
    context.threads = threads;
    auto estimate = estimate_normals(points, context);
    EXPECT_TRUE(estimate);
    auto oriented = orient_normals(points, *estimate, {}, context);
    EXPECT_TRUE(oriented);
    if (!normals.empty())
        estimate->normals = normals;
    auto result = reconstruct_surface(points, *estimate, oriented->disagreement, options, context);
    EXPECT_TRUE(result) << result.error().message;
    Case c;
    c.result = std::move(result.value());
    c.noise = estimate->noise;
    auto mesh = ManifoldMesh::build(c.result.mesh.positions, c.result.mesh.triangles);
    EXPECT_TRUE(mesh) << mesh.error().message;
    c.mesh = std::move(mesh.value());
    return c;
}

double rms(const ManifoldMesh& mesh, const std::function<double(const Vec3&)>& distance)
{
    double sum = 0.0;
    for (const Vec3& p : mesh.positions())
        sum += distance(p) * distance(p);
    return std::sqrt(sum / mesh.vertex_count());
}

double from_torus(const Vec3& p)
{
    return std::hypot(std::hypot(p.x, p.y) - 1.0, p.z) - 0.4;
}

TEST(ReconstructSurface, a_sphere_comes_back_closed_at_any_scale_and_place)
{
    for (const double scale : {1e-6, 1.0, 1e6}) {
        const Vec3 centre = scale * Vec3{3.0, -2.0, 1.0};
        const auto s = fixtures::sphere_points(4000, scale, centre);
        const Case c = reconstructed(s.points);
        EXPECT_EQ(c.result.topology, CloudTopology::closed);
        EXPECT_TRUE(c.result.evidence.doubts.empty());
        EXPECT_TRUE(c.mesh.closed());
        EXPECT_EQ(c.mesh.genus(), 0);
        EXPECT_GT(c.mesh.volume(), 0.0);
        EXPECT_LT(rms(c.mesh, [&](const Vec3& p) { return norm(p - centre) - scale; }),
                  0.002 * scale);
    }
}

TEST(ReconstructSurface, a_torus_has_genus_one_and_lies_where_the_points_are)
{
    const auto s = fixtures::torus_points(8000);
    const Case c = reconstructed(s.points);
    EXPECT_EQ(c.result.topology, CloudTopology::closed);
    EXPECT_EQ(c.mesh.genus(), 1);
    EXPECT_EQ(c.result.evidence.genus, 1);
    EXPECT_EQ(c.result.evidence.finer_genus, 1);
    EXPECT_LT(rms(c.mesh, from_torus), 0.003);
}

TEST(ReconstructSurface, noise_is_smoothed)
{
    const double noise = 0.02;
    const auto s = fixtures::torus_points(20000);
    const Case c = reconstructed(fixtures::with_noise(s.points, noise));
    EXPECT_EQ(c.result.topology, CloudTopology::closed);
    EXPECT_EQ(c.mesh.genus(), 1);
    EXPECT_LT(rms(c.mesh, from_torus), 0.5 * noise);
}

TEST(ReconstructSurface, half_a_sphere_is_open_with_one_loop_near_its_rim)
{
    SampledSurface s = fixtures::sphere_points(8000);
    std::vector<Vec3> half;
    for (const Vec3& p : s.points)
        if (p.z > 0.0)
            half.push_back(p);
    const Case c = reconstructed(half);
    EXPECT_EQ(c.result.topology, CloudTopology::open);
    ASSERT_EQ(c.result.evidence.holes.size(), 1u);
    EXPECT_FALSE(c.result.evidence.holes[0].filled);
    EXPECT_EQ(c.result.evidence.genus, 0);
    EXPECT_FALSE(c.mesh.closed());
    const double spacing = std::sqrt(4.0 * fixtures::pi / 8000.0);
    for (const Vec3& p : c.mesh.positions())
        EXPECT_GT(p.z, -2.5 * spacing);
}

TEST(ReconstructSurface, a_hole_within_the_size_allowed_is_filled_and_said_so)
{
    SampledSurface s = fixtures::sphere_points(8000);
    std::vector<Vec3> pierced;
    for (const Vec3& p : s.points)
        if (p.z < 0.97) // a cap 0.5 across, of a diagonal of 3.5
            pierced.push_back(p);
    ReconstructOptions options;
    options.fill_holes = 0.2;
    const Case filled = reconstructed(pierced, options);
    EXPECT_EQ(filled.result.topology, CloudTopology::holes_filled);
    ASSERT_EQ(filled.result.evidence.holes.size(), 1u);
    EXPECT_TRUE(filled.result.evidence.holes[0].filled);
    EXPECT_NEAR(filled.result.evidence.holes[0].size, 0.5, 0.1);
    EXPECT_GT(filled.result.evidence.holes[0].place.z, 0.9);
    EXPECT_TRUE(filled.mesh.closed());
    const Case open = reconstructed(pierced);
    EXPECT_EQ(open.result.topology, CloudTopology::open);
    EXPECT_FALSE(open.mesh.closed());
    EXPECT_NEAR(open.result.evidence.holes[0].spacings,
                0.5 / std::sqrt(4.0 * fixtures::pi / 8000.0), 4.0);
}

//! Points of a sphere without those up to so many spacings from its pole.
std::vector<Vec3> pierced_sphere(double spacings)
{
    const double spacing = std::sqrt(4.0 * fixtures::pi / 8000.0);
    std::vector<Vec3> pierced;
    for (const Vec3& p : fixtures::sphere_points(8000).points)
        if (norm(p - Vec3{0.0, 0.0, 1.0}) > spacings * spacing)
            pierced.push_back(p);
    return pierced;
}

TEST(ReconstructSurface,
     a_gap_that_chance_may_leave_is_filled_unless_none_may_be_and_a_wider_one_not)
{
    const std::vector<Vec3> pierced = pierced_sphere(2.4);
    const Case filled = reconstructed(pierced);
    EXPECT_EQ(filled.result.topology, CloudTopology::holes_filled);
    EXPECT_TRUE(filled.mesh.closed());
    ReconstructOptions options;
    options.fill_holes = 0.0;
    EXPECT_EQ(reconstructed(pierced, options).result.topology, CloudTopology::open);
    EXPECT_EQ(reconstructed(pierced_sphere(2.7)).result.topology, CloudTopology::open);
}

TEST(ChanceGap, is_wider_than_the_widest_gap_of_nearly_every_cloud_but_not_by_much)
{
    // Clouds in a square, 20 spacings wide; gaps are sought on a grid in its middle.
    constexpr std::size_t count = 400;
    constexpr int clouds = 150, side = 70;
    const double gap = chance_gap(count);
    std::mt19937 random(4);
    std::uniform_real_distribution<double> coordinate(0.0, 20.0);
    int wider = 0, nearly = 0;
    for (int c = 0; c < clouds; ++c) {
        std::vector<Vec3> points;
        while (points.size() < count)
            points.push_back({coordinate(random), coordinate(random), 0.0});
        Context context;
        const auto tree = PointTree::build(points, context);
        ASSERT_TRUE(tree);
        double widest = 0.0;
        for (int j = 0; j < side; ++j)
            for (int i = 0; i < side; ++i) {
                const Vec3 p{3.0 + 0.2 * i, 3.0 + 0.2 * j, 0.0};
                widest = std::max(widest, 2.0 * std::sqrt(tree->nearest(p).distance2));
            }
        wider += widest > gap;
        nearly += widest > 0.65 * gap;
    }
    EXPECT_LE(wider, 5);
    EXPECT_GT(nearly, 9 * clouds / 10);
    EXPECT_GT(chance_gap(1000000), gap);
}

TEST(ReconstructSurface, a_flat_sheet_of_points_is_open)
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    std::vector<Vec3> points;
    for (int i = 0; i < 3000; ++i)
        points.push_back({uniform(random), uniform(random), 0.0});
    const Case c = reconstructed(points);
    EXPECT_NE(c.result.topology, CloudTopology::closed);
    EXPECT_NE(c.result.topology, CloudTopology::holes_filled);
    EXPECT_FALSE(c.mesh.closed());
}

TEST(ReconstructSurface, points_that_fill_space_are_uncertain)
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    std::vector<Vec3> points;
    for (int i = 0; i < 4000; ++i)
        points.push_back({uniform(random), uniform(random), uniform(random)});
    const Case c = reconstructed(points);
    EXPECT_EQ(c.result.topology, CloudTopology::uncertain);
    EXPECT_FALSE(c.result.evidence.doubts.empty());
}

TEST(ReconstructSurface, a_cluster_of_a_few_points_far_away_makes_no_component)
{
    SampledSurface s = fixtures::sphere_points(4000);
    const auto speck = fixtures::sphere_points(20, 0.03, {1.6, 0.0, 0.0});
    s = fixtures::joined(s, speck);
    const Case c = reconstructed(s.points);
    EXPECT_EQ(c.result.evidence.components, 1u);
    for (const Vec3& p : c.mesh.positions())
        EXPECT_LT(norm(p), 1.2);
}

TEST(ReconstructSurface, inward_normals_give_the_same_surface_facing_inward)
{
    auto s = fixtures::sphere_points(3000);
    for (Vec3& n : s.normals)
        n = -n;
    const Case c = reconstructed(s.points, {}, 0, s.normals);
    EXPECT_TRUE(c.mesh.closed());
    EXPECT_NEAR(c.mesh.volume(), -4.0 / 3.0 * fixtures::pi, 0.05);
}

TEST(ReconstructSurface, the_mesh_stays_near_the_size_asked_for)
{
    const auto s = fixtures::sphere_points(40000);
    ReconstructOptions options;
    options.most_vertices = 4000;
    const Case c = reconstructed(s.points, options);
    EXPECT_LT(c.mesh.vertex_count(), 4.0 * 4000);
    EXPECT_GT(c.mesh.vertex_count(), 4000 / 4.0);
}

TEST(ReconstructSurface, the_same_for_any_thread_count)
{
    const auto s = fixtures::torus_points(3000);
    const Case one = reconstructed(s.points, {}, 1), three = reconstructed(s.points, {}, 3);
    EXPECT_EQ(one.mesh.positions(), three.mesh.positions());
    EXPECT_EQ(one.mesh.triangles(), three.mesh.triangles());
}

TEST(ReconstructSurface, balls_find_a_torus_and_half_a_sphere_without_adding_to_them)
{
    ReconstructOptions balls;
    balls.method = ReconstructionMethod::ball_pivoting;
    const auto torus = fixtures::torus_points(6000);
    const Case whole = reconstructed(torus.points, balls);
    EXPECT_TRUE(whole.mesh.closed());
    EXPECT_EQ(whole.result.evidence.genus, 1);
    EXPECT_TRUE(whole.result.topology == CloudTopology::closed ||
                whole.result.topology == CloudTopology::holes_filled);
    EXPECT_LT(rms(whole.mesh, from_torus), 1e-12); // its vertices are the points

    std::vector<Vec3> half;
    for (const Vec3& p : fixtures::sphere_points(8000).points)
        if (p.z > 0.0)
            half.push_back(p);
    const Case open = reconstructed(half, balls);
    EXPECT_EQ(open.result.topology, CloudTopology::open);
    EXPECT_EQ(open.result.evidence.genus, 0);
    for (const Vec3& p : open.mesh.positions())
        EXPECT_GT(p.z, 0.0);
}

TEST(ReconstructSurface, balls_that_miss_points_in_noise_leave_the_topology_uncertain)
{
    ReconstructOptions balls;
    balls.method = ReconstructionMethod::ball_pivoting;
    const Case c =
        reconstructed(fixtures::with_noise(fixtures::torus_points(6000).points, 0.05), balls);
    EXPECT_GT(c.result.evidence.unused_points, 0.1);
    EXPECT_EQ(c.result.topology, CloudTopology::uncertain);
}

TEST(ReconstructSurface, options_out_of_range_are_refused)
{
    ReconstructOptions options;
    options.depth = 2;
    EXPECT_TRUE(options.check());
    options = {};
    options.fill_holes = -0.1;
    EXPECT_TRUE(options.check());
    options = {};
    options.method = ReconstructionMethod::ball_pivoting;
    EXPECT_FALSE(options.check());
    options.depth = 8; // balls have none
    EXPECT_TRUE(options.check());
    options = {};
    options.most_vertices = 0;
    EXPECT_TRUE(options.check());
}

} // namespace
} // namespace bot2nurbs
