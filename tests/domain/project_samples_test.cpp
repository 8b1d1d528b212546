// SPDX-License-Identifier: MIT
#include "bot2nurbs/domain_samples.h"

#include "hand_domains.h"

#include <gtest/gtest.h>

namespace bot2nurbs::test {
namespace {

PointData data_of(const HandDomain& hand, const std::vector<Vec3>& points, Context& context)
{
    PointData data;
    data.positions = points;
    data.weights.assign(points.size(), 1.0);
    const auto places = closest_places(hand.mesh, points, context);
    EXPECT_TRUE(places.ok());
    data.source = *places;
    return data;
}

SurfaceSampleSet projected(const HandDomain& hand, const std::vector<Vec3>& points,
                           unsigned threads = 0)
{
    Context context;
    context.threads = threads;
    auto set = project_samples(hand.mesh, hand.charts, data_of(hand, points, context), context);
    EXPECT_TRUE(set.ok()) << set.error().message;
    return set.ok() ? *set : SurfaceSampleSet{};
}

TEST(ProjectSamples, points_on_the_source_come_to_where_the_charts_have_them)
{
    HandDomain hand = with_refined_carrier(torus_askew(2, 2));
    Context context;
    auto charts = compute_charts(hand.mesh, hand.domain, context);
    ASSERT_TRUE(charts.ok()) << charts.error().message;
    hand.charts = *charts;
    SampleOptions grid;
    grid.max_vertices = 0; // grid places lie inside their quads, so that these are the only answer
    const auto expected = make_samples(hand.mesh, hand.charts, grid, context);
    ASSERT_TRUE(expected.ok());
    const SurfaceSampleSet found = projected(hand, expected->positions);
    ASSERT_EQ(found.size(), expected->size());
    for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_EQ(found.domain[i].quad, expected->domain[i].quad);
        EXPECT_NEAR(found.domain[i].u, expected->domain[i].u, 1e-7);
        EXPECT_NEAR(found.domain[i].v, expected->domain[i].v, 1e-7);
        EXPECT_EQ(found.positions[i], expected->positions[i]);
    }
}

TEST(ProjectSamples, points_off_the_source_keep_their_place_and_start_below_it)
{
    const HandDomain hand = sphere_cube(1, 8);
    std::vector<Vec3> points;
    for (const Vec3& p : hand.mesh.positions())
        points.push_back(1.2 * p);
    const SurfaceSampleSet found = projected(hand, points);
    for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_EQ(found.positions[i], points[i]);
        EXPECT_LT(norm(hand.mesh.at(found.source[i]) - hand.mesh.positions()[i]), 1e-9);
        EXPECT_TRUE(found.domain[i].u >= 0.0 && found.domain[i].u <= 1.0);
        EXPECT_TRUE(found.domain[i].v >= 0.0 && found.domain[i].v <= 1.0);
    }
}

TEST(ProjectSamples, are_the_same_for_any_thread_count_and_stop_when_cancelled)
{
    const HandDomain hand = sphere_cube(1, 8);
    const auto one = projected(hand, hand.mesh.positions(), 1);
    const auto three = projected(hand, hand.mesh.positions(), 3);
    for (std::size_t i = 0; i < one.size(); ++i) {
        EXPECT_EQ(one.domain[i].quad, three.domain[i].quad);
        EXPECT_EQ(one.domain[i].u, three.domain[i].u);
    }
    Context context;
    const PointData data = data_of(hand, hand.mesh.positions(), context);
    context.cancel();
    const auto set = project_samples(hand.mesh, hand.charts, data, context);
    ASSERT_FALSE(set.ok());
    EXPECT_EQ(set.error().code, ErrorCode::cancelled);
    const auto places = closest_places(hand.mesh, data.positions, context);
    ASSERT_FALSE(places.ok());
    EXPECT_EQ(places.error().code, ErrorCode::cancelled);
}

TEST(AnchorSamples, are_added_where_a_piece_has_no_sample_and_nowhere_else)
{
    const HandDomain hand = sphere_cube(1, 8);
    Context context;
    SurfaceSampleSet none;
    const auto all = add_anchor_samples(hand.mesh, hand.charts, none, context);
    ASSERT_TRUE(all.ok());
    EXPECT_EQ(*all, 16 * hand.charts.size());
    double area = 0.0, weight = 0.0;
    for (Index f = 0; f < hand.mesh.face_count(); ++f)
        area += 0.5 * norm(hand.mesh.area_vector(f));
    for (const double w : none.weights)
        weight += w;
    EXPECT_NEAR(weight, area, 1e-9);

    SampleOptions grid;
    auto full = make_samples(hand.mesh, hand.charts, grid, context);
    ASSERT_TRUE(full.ok());
    full->normals.clear();
    const std::size_t before = full->size();
    const auto added = add_anchor_samples(hand.mesh, hand.charts, *full, context);
    ASSERT_TRUE(added.ok());
    EXPECT_EQ(*added, 0u);
    EXPECT_EQ(full->size(), before);
}

TEST(NearestPlace, is_on_the_side_of_a_thin_wall_that_looks_along_the_direction)
{
    // Two squares, a hundredth apart, that look away from each other.
    const Vec3 corners[4] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    std::vector<Vec3> positions;
    for (const double z : {0.0, -0.01})
        for (const Vec3& c : corners)
            positions.push_back(c + Vec3{0, 0, z});
    const auto wall = ManifoldMesh::build(positions, {{0, 1, 2}, {0, 2, 3}, {4, 6, 5}, {4, 7, 6}});
    ASSERT_TRUE(wall.ok()) << wall.error().message;
    const NearestPlace nearest = nearest_place(*wall, Context());
    const auto above = nearest({0.3, 0.4, 0.001}, {0, 0.6, 0.8});
    const auto below = nearest({0.3, 0.4, 0.001}, {0, 0.6, -0.8});
    ASSERT_TRUE(above && below);
    EXPECT_LT(norm(above->position - Vec3{0.3, 0.4, 0}), 1e-15);
    EXPECT_EQ(above->normal, (Vec3{0, 0, 1}));
    EXPECT_LT(norm(below->position - Vec3{0.3, 0.4, -0.01}), 1e-15);
    EXPECT_EQ(below->normal, (Vec3{0, 0, -1}));
    EXPECT_FALSE(nearest({0.3, 0.4, 0.001}, {1, 0, 0}));
}

} // namespace
} // namespace bot2nurbs::test
