// SPDX-License-Identifier: MIT
#include "cloud/ball_pivoting.h"
#include "cloud/pivoted_mesh.h"
#include "cloud/surface_coverage.h"
#include "cloud_fixtures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

namespace bot2nurbs {
namespace {

using Triangles = std::vector<std::array<Index, 3>>;

Triangles pivoted(const fixtures::SampledSurface& s)
{
    Context context;
    auto estimate = estimate_normals(s.points, context);
    EXPECT_TRUE(estimate);
    estimate->normals = s.normals;
    auto triangles = pivot_balls(s.points, *estimate, context);
    EXPECT_TRUE(triangles);
    return triangles ? *triangles : Triangles();
}

//! How often each directed edge occurs.
std::map<std::array<Index, 2>, int> edge_uses(const Triangles& triangles)
{
    std::map<std::array<Index, 2>, int> uses;
    for (const auto& t : triangles)
        for (std::size_t k = 0; k < 3; ++k)
            ++uses[{t[k], t[(k + 1) % 3]}];
    return uses;
}

void expect_oriented_edges(const Triangles& triangles)
{
    for (const auto& [edge, count] : edge_uses(triangles))
        EXPECT_EQ(count, 1);
}

std::size_t points_used(const Triangles& triangles)
{
    std::set<Index> used;
    for (const auto& t : triangles)
        used.insert(t.begin(), t.end());
    return used.size();
}

TEST(BallPivoting, evenly_spread_points_of_a_sphere_make_a_closed_surface_of_all_of_them)
{
    const auto s = fixtures::sphere_points(2000);
    const Triangles triangles = pivoted(s);
    expect_oriented_edges(triangles);
    EXPECT_EQ(points_used(triangles), s.points.size());
    // Closed: every edge has its twin; and Euler's formula.
    const auto uses = edge_uses(triangles);
    for (const auto& [edge, count] : uses)
        EXPECT_EQ(uses.count({edge[1], edge[0]}), 1u);
    EXPECT_EQ(triangles.size(), 2 * s.points.size() - 4);
}

TEST(BallPivoting, some_ball_that_touches_a_triangle_of_a_sphere_has_no_point_inside)
{
    const auto s = fixtures::sphere_points(300);
    for (const auto& t : pivoted(s)) {
        // An empty ball that touches three points from outside leaves the cap of the sphere that
        // their circle cuts off empty: the triangle is one of the convex hull.
        const Vec3 n = cross(s.points[t[1]] - s.points[t[0]], s.points[t[2]] - s.points[t[0]]);
        const double height = dot(n, s.points[t[0]]);
        EXPECT_GT(height, 0.0);
        for (const Vec3& p : s.points)
            EXPECT_LE(dot(n, p), height * (1.0 + 1e-9));
    }
}

TEST(BallPivoting,
     triangles_of_a_scattered_torus_face_where_the_normals_do_and_share_edges_in_pairs)
{
    const auto s = fixtures::torus_points(6000);
    const Triangles triangles = pivoted(s);
    expect_oriented_edges(triangles);
    EXPECT_GT(points_used(triangles), 0.98 * double(s.points.size()));
    for (const auto& t : triangles) {
        const Vec3 n = cross(s.points[t[1]] - s.points[t[0]], s.points[t[2]] - s.points[t[0]]);
        for (const Index v : t)
            EXPECT_GT(dot(n, s.normals[v]), 0.0);
    }
}

TEST(BallPivoting, points_of_a_grid_of_which_many_lie_on_one_ball_leave_no_gaps)
{
    // Turned, so that rounding puts some of them a little inside the ball and others outside.
    for (const double turn : {0.0, 0.3, 0.7, 1.1}) {
        const Vec3 along = normalized(Vec3{std::cos(turn), std::sin(turn), turn});
        const Vec3 normal = normalized(cross(along, Vec3{0.2, -0.5, 1.0}));
        const Vec3 across = cross(normal, along);
        fixtures::SampledSurface s;
        constexpr Index side = 30;
        for (Index j = 0; j < side; ++j)
            for (Index i = 0; i < side; ++i) {
                s.points.push_back(double(i) * along + double(j) * across);
                s.normals.push_back(normal);
            }
        const Triangles triangles = pivoted(s);
        expect_oriented_edges(triangles);
        double area = 0.0;
        for (const auto& t : triangles)
            area += 0.5 * dot(normal, cross(s.points[t[1]] - s.points[t[0]],
                                            s.points[t[2]] - s.points[t[0]]));
        EXPECT_NEAR(area, (side - 1.0) * (side - 1.0), 1e-9);
    }
}

TEST(BallPivoting, a_ball_that_comes_down_from_a_ledge_does_not_tie_it_to_the_middle_of_a_floor)
{
    SurfaceEstimate estimate;
    std::vector<Vec3> points;
    for (int j = 0; j < 20; ++j)
        for (int i = 0; i < 20; ++i)
            points.push_back({double(i), double(j), 0.0});
    const auto floor = static_cast<Index>(points.size());
    // Out of the reach of the smallest balls, not of the larger ones.
    points.insert(points.end(), {{9.0, 9.5, 2.45}, {10.0, 9.5, 2.45}, {9.5, 8.6, 2.75}});
    estimate.normals.assign(points.size(), {0.0, 0.0, 1.0});
    estimate.spacing.assign(points.size(), 1.0);
    estimate.outlier.assign(points.size(), 0);
    Context context;
    const auto triangles = pivot_balls(points, estimate, context);
    ASSERT_TRUE(triangles);
    Index of_ledge = 0;
    for (const auto& t : *triangles) {
        const auto high = std::count_if(t.begin(), t.end(), [&](Index v) { return v >= floor; });
        EXPECT_TRUE(high == 0 || high == 3);
        of_ledge += high == 3;
    }
    EXPECT_EQ(of_ledge, 1u);
}

TEST(BallPivoting, two_sheets_that_face_away_from_each_other_stay_apart)
{
    fixtures::SampledSurface s;
    for (const double z : {0.0, 0.8})
        for (int j = 0; j < 25; ++j)
            for (int i = 0; i < 25; ++i) {
                s.points.push_back({double(i), double(j) + 0.1 * (i % 3), z});
                s.normals.push_back({0.0, 0.0, z > 0.0 ? 1.0 : -1.0});
            }
    const Triangles triangles = pivoted(s);
    EXPECT_GT(triangles.size(), 2000u);
    for (const auto& t : triangles)
        EXPECT_TRUE((t[0] < 625) == (t[1] < 625) && (t[1] < 625) == (t[2] < 625));
}

TEST(BallPivoting, a_dense_patch_of_a_sparse_surface_keeps_its_detail_and_joins_the_rest)
{
    // Beyond a ring of its own spacing, points four times as dense.
    fixtures::SampledSurface s;
    const auto add = [&](double x, double y) {
        s.points.push_back({x, y, 0.0});
        s.normals.push_back({0.0, 0.0, 1.0});
    };
    for (int j = -12; j <= 12; ++j)
        for (int i = -12; i <= 12; ++i)
            if (std::max(std::abs(i), std::abs(j)) > 4)
                add(i, j);
    for (int j = -16; j <= 16; ++j)
        for (int i = -16; i <= 16; ++i)
            add(0.25 * i, 0.25 * j);
    const Triangles triangles = pivoted(s);
    expect_oriented_edges(triangles);
    EXPECT_EQ(points_used(triangles), s.points.size());
    double area = 0.0;
    for (const auto& t : triangles)
        area += 0.5 * cross(s.points[t[1]] - s.points[t[0]], s.points[t[2]] - s.points[t[0]]).z;
    EXPECT_NEAR(area, 24.0 * 24.0, 1e-9);
}

TEST(BallPivoting, it_can_be_cancelled)
{
    const auto s = fixtures::sphere_points(500);
    Context context;
    auto estimate = estimate_normals(s.points, context);
    ASSERT_TRUE(estimate);
    context.cancel();
    const auto triangles = pivot_balls(s.points, *estimate, context);
    ASSERT_FALSE(triangles);
    EXPECT_EQ(triangles.error().code, ErrorCode::cancelled);
}

//! Two triangles that meet in a point only, and one beside the first.
const std::vector<Vec3> butterfly{{0, 0, 0},  {1, 0, 0},   {1, 1, 0},
                                  {-1, 0, 0}, {-1, -1, 0}, {0, 1, 0}};

TEST(PivotedMesh, a_point_where_two_fans_meet_becomes_two_vertices)
{
    const TriangleSoup mesh = mesh_of_fans(butterfly, {{0, 1, 2}, {0, 3, 4}, {0, 2, 5}});
    EXPECT_EQ(mesh.positions.size(), 7u);
    EXPECT_EQ(mesh.triangles[0][0], mesh.triangles[2][0]);
    EXPECT_NE(mesh.triangles[0][0], mesh.triangles[1][0]);
    EXPECT_EQ(mesh.positions[mesh.triangles[1][0]], butterfly[0]);
    EXPECT_TRUE(ManifoldMesh::build(mesh.positions, mesh.triangles));
}

//! An open box: a unit cube without its lid.
TriangleSoup open_box()
{
    const std::vector<Vec3> corners{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                    {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    return mesh_of_fans(corners, {{0, 2, 1},
                                  {0, 3, 2},
                                  {0, 1, 5},
                                  {0, 5, 4},
                                  {1, 2, 6},
                                  {1, 6, 5},
                                  {2, 3, 7},
                                  {2, 7, 6},
                                  {3, 0, 4},
                                  {3, 4, 7}});
}

TEST(PivotedMesh, a_loop_is_filled_to_go_on_with_the_surface)
{
    TriangleSoup mesh = open_box();
    const auto holes = fill_loops(mesh, [](const CloudHole&) { return true; });
    ASSERT_EQ(holes.size(), 1u);
    EXPECT_TRUE(holes[0].filled);
    EXPECT_NEAR(holes[0].size, std::sqrt(2.0), 1e-15);
    EXPECT_NEAR(holes[0].spacings, std::sqrt(2.0), 1e-15); // its edges are one long
    EXPECT_NEAR(holes[0].area, 1.0, 1e-15);
    EXPECT_EQ(mesh.triangles.size(), 12u);
    const auto built = ManifoldMesh::build(mesh.positions, mesh.triangles);
    ASSERT_TRUE(built);
    EXPECT_TRUE(built->closed());
    EXPECT_EQ(genus_of(mesh), 0);
}

TEST(PivotedMesh, a_loop_that_may_not_be_filled_stays_and_is_reported)
{
    TriangleSoup mesh = open_box();
    const auto holes = fill_loops(mesh, [](const CloudHole& hole) { return hole.size < 1.0; });
    ASSERT_EQ(holes.size(), 1u);
    EXPECT_FALSE(holes[0].filled);
    EXPECT_EQ(mesh.triangles.size(), 10u);
    EXPECT_NEAR(holes[0].place.z, 1.0, 1e-15);
}

TEST(PivotedMesh, a_loop_is_filled_without_an_edge_that_is_there_already)
{
    // Two triangles back to back, of a tetrahedron: its other two sides would need the edge they
    // share once more, or the edge between the two other corners, which is free.
    const std::vector<Vec3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    TriangleSoup two = mesh_of_fans(corners, {{0, 1, 2}, {1, 0, 3}});
    const auto holes = fill_loops(two, [](const CloudHole&) { return true; });
    ASSERT_EQ(holes.size(), 1u);
    EXPECT_TRUE(holes[0].filled);
    const auto built = ManifoldMesh::build(two.positions, two.triangles);
    ASSERT_TRUE(built);
    EXPECT_TRUE(built->closed());
}

} // namespace
} // namespace bot2nurbs
