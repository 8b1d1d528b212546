// SPDX-License-Identifier: MIT
#include "bot2nurbs/layout_quality.h"

#include "hand_domains.h"

#include <gtest/gtest.h>

#include <cmath>

namespace bot2nurbs::test {
namespace {

LayoutQuality quality(const HandDomain& hand)
{
    Context context;
    const auto charts = compute_charts(hand.mesh, hand.domain, context);
    EXPECT_TRUE(charts.ok());
    return measure_layout(hand.domain, *charts);
}

TEST(LayoutQuality, of_rectangles_follows_from_their_sides)
{
    // Patches of a cylinder are developable: rectangles of sides a and b, mapped linearly, have
    // stretch (a / b + b / a) / 2.
    for (const int along : {1, 2, 5}) {
        const LayoutQuality q = quality(open_cylinder(4, along, 20));
        const double r = q.aspect.most;
        EXPECT_NEAR(q.aspect.least, r, 1e-9);
        EXPECT_NEAR(q.stretch.most, 0.5 * (r + 1.0 / r), 1e-6);
        EXPECT_NEAR(q.angle.least, 90.0, 1e-6);
        EXPECT_NEAR(q.area_ratio.most, 1.0, 1e-6);
        EXPECT_NEAR(q.size.least, 1.0, 1e-9);
        // Edges along the axis are straight, those around are quarters of a circle.
        EXPECT_NEAR(q.straightness.least, 1.0, 1e-12);
        EXPECT_NEAR(q.straightness.most, 0.25 * M_PI / std::sin(0.25 * M_PI), 2e-3);
    }
}

TEST(LayoutQuality, of_the_cube_on_a_sphere_is_the_same_for_its_six_sides)
{
    const LayoutQuality q = quality(sphere_cube(0, 16));
    EXPECT_NEAR(q.stretch.most, q.stretch.least, 1e-2);
    EXPECT_NEAR(q.size.most, 1.0, 1e-6);
    EXPECT_NEAR(q.aspect.most, 1.0, 1e-6);
    EXPECT_GT(q.stretch.least, 1.0);
    EXPECT_LT(q.angle.most, 90.0);
    EXPECT_GT(q.angle.least, 70.0);
}

TEST(CornerAngles, add_up_to_the_angle_of_the_mesh_around_a_vertex)
{
    for (const HandDomain& hand :
         {sphere_cube(1, 8), with_refined_carrier(torus_askew()), open_cylinder(4, 2, 5)}) {
        Context context;
        const auto charts = compute_charts(hand.mesh, hand.domain, context);
        ASSERT_TRUE(charts.ok());
        const std::vector<double> angles = corner_angles(*charts);
        const QuadComplex& k = hand.domain.complex;
        ASSERT_EQ(angles.size(), k.halfedge_count());
        std::vector<double> sum(k.vertex_count(), 0.0), around(k.vertex_count(), 0.0);
        for (Index h = 0; h < k.halfedge_count(); ++h)
            sum[k.from(h)] += angles[h];
        const ManifoldMesh& mesh = hand.domain.carrier.mesh;
        for (Index v = 0; v < k.vertex_count(); ++v)
            for (Index h = 0; h < mesh.halfedge_count(); ++h)
                if (mesh.from(h) == hand.domain.vertices[v]) {
                    const Vec3 a = mesh.position(mesh.to(h)) - mesh.position(mesh.from(h));
                    const Vec3 b = mesh.position(mesh.from(ManifoldMesh::prev(h))) -
                                   mesh.position(mesh.from(h));
                    around[v] += std::atan2(norm(cross(a, b)), dot(a, b));
                }
        for (Index v = 0; v < k.vertex_count(); ++v)
            EXPECT_NEAR(sum[v], around[v], 1e-9) << v;
    }
}

TEST(LayoutQuality, names_the_patch_that_is_worst)
{
    // On a torus the outermost quads are the largest, the innermost the smallest.
    const HandDomain hand = torus_grid(8, 4, 6);
    const LayoutQuality q = quality(hand);
    const auto radius = [&](Index quad) {
        Vec3 sum;
        for (const Index v : hand.domain.complex.quad(quad))
            sum += hand.mesh.position(hand.domain.vertices[v]);
        return std::hypot(sum.x, sum.y);
    };
    EXPECT_GT(radius(q.size.most_at), radius(q.size.least_at));
    EXPECT_GT(q.size.most, q.size.median);
    EXPECT_LT(q.size.least, q.size.median);
}

} // namespace
} // namespace bot2nurbs::test
