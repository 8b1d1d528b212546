// SPDX-License-Identifier: MIT
#include "bot2nurbs/domain_samples.h"

#include "domain/chart_locator.h"
#include "hand_domains.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace bot2nurbs::test {
namespace {

SurfaceSampleSet sampled(const HandDomain& hand, const SampleOptions& options = {})
{
    Context context;
    auto set = make_samples(hand.mesh, hand.charts, options, context);
    EXPECT_TRUE(set.ok());
    return set.ok() ? *set : SurfaceSampleSet{};
}

double mesh_area(const ManifoldMesh& mesh)
{
    double area = 0.0;
    for (Index f = 0; f < mesh.face_count(); ++f)
        area += 0.5 * norm(mesh.area_vector(f));
    return area;
}

//! Bends the parameters of every chart, keeping the square, so that the grid is not the mesh's.
void bend(HandDomain& hand)
{
    for (QuadChart& chart : hand.charts)
        for (QuadChart::Vertex& v : chart.vertices) {
            const double u = v.uv.x, w = v.uv.y;
            v.uv.x = u + 0.3 * u * (1 - u) * (0.4 + w);
            v.uv.y = w - 0.25 * w * (1 - w) * (0.3 + u);
        }
}

TEST(DomainSamples, lie_on_the_source_to_the_bit)
{
    HandDomain hand = genus2_voxels(0, 5 * 4);
    bend(hand);
    const SurfaceSampleSet set = sampled(hand);
    ASSERT_GT(set.size(), 0u);
    ASSERT_EQ(set.normals.size(), set.size());
    ASSERT_EQ(set.weights.size(), set.size());
    ASSERT_EQ(set.source.size(), set.size());
    ASSERT_EQ(set.domain.size(), set.size());
    for (std::size_t i = 0; i < set.size(); ++i) {
        const SourcePoint& p = set.source[i];
        EXPECT_EQ(set.positions[i], hand.mesh.at(p));
        EXPECT_NEAR(p.bary[0] + p.bary[1] + p.bary[2], 1.0, 1e-15);
        for (const double w : p.bary)
            EXPECT_GE(w, 0.0);
        EXPECT_NEAR(norm(set.normals[i]), 1.0, 1e-14);
        EXPECT_GT(set.weights[i], 0.0);
    }
}

TEST(DomainSamples, parameters_agree_with_the_chart_of_the_quad)
{
    HandDomain hand = sphere_cube(1, 12);
    bend(hand);
    const SurfaceSampleSet set = sampled(hand);
    for (std::size_t i = 0; i < set.size(); ++i) {
        const DomainPoint& d = set.domain[i];
        // Interpolating positions over the chart's triangles at (u, v) by brute force.
        const QuadChart& chart = hand.charts[d.quad];
        double best = -1.0;
        Vec3 expected;
        for (const auto& t : chart.triangles) {
            const Vec2 p{d.u, d.v};
            const Vec2 a = chart.vertices[t[0]].uv, b = chart.vertices[t[1]].uv,
                       c = chart.vertices[t[2]].uv;
            const double area = cross(b - a, c - a);
            const double w0 = cross(b - p, c - p) / area, w1 = cross(c - p, a - p) / area;
            const double least = std::min({w0, w1, 1 - w0 - w1});
            if (least > best) {
                best = least;
                expected = w0 * chart.vertices[t[0]].position + w1 * chart.vertices[t[1]].position +
                           (1 - w0 - w1) * chart.vertices[t[2]].position;
            }
        }
        EXPECT_GE(best, -1e-12);
        EXPECT_LT(norm(expected - set.positions[i]), 1e-13);
    }
}

TEST(DomainSamples, every_bezier_piece_has_nine_samples_on_a_mesh_of_two_triangles_a_quad)
{
    HandDomain hand = torus_grid(6, 4, 6);
    // One mesh square per chart: fewer triangles than Bezier pieces.
    hand = sphere_cube(1, 2);
    ASSERT_EQ(hand.charts[0].triangles.size(), 2u);
    const SurfaceSampleSet set = sampled(hand);
    std::vector<int> count(16 * hand.charts.size(), 0);
    for (const DomainPoint& d : set.domain)
        ++count[16 * d.quad + 4 * std::min(3, int(4 * d.u)) + std::min(3, int(4 * d.v))];
    for (const int c : count)
        EXPECT_GE(c, 9);
}

TEST(DomainSamples, weights_of_a_quad_sum_to_its_area)
{
    HandDomain hand = genus2_voxels(1, 8);
    bend(hand);
    for (const Index cap : {0u, 3u, 288u}) {
        SampleOptions options;
        options.max_vertices = cap;
        const SurfaceSampleSet set = sampled(hand, options);
        std::vector<double> sum(hand.charts.size(), 0.0);
        double total = 0.0;
        for (std::size_t i = 0; i < set.size(); ++i) {
            sum[set.domain[i].quad] += set.weights[i];
            total += set.weights[i];
        }
        EXPECT_NEAR(total, mesh_area(hand.mesh), 1e-7 * total);
        for (std::size_t q = 0; q < sum.size(); ++q) {
            double area = 0.0;
            for (const Index f : hand.charts[q].source_face)
                area += 0.5 * norm(hand.mesh.area_vector(f));
            EXPECT_NEAR(sum[q], area, 1e-7 * area);
        }
    }
}

TEST(DomainSamples, every_source_vertex_is_sampled_once_below_the_cap)
{
    const HandDomain hand = sphere_cube(0, 12);
    SampleOptions options;
    options.max_vertices = hand.mesh.vertex_count();
    const SurfaceSampleSet set = sampled(hand, options);
    EXPECT_EQ(set.size(), 6 * 144 + hand.mesh.vertex_count());
    std::vector<int> seen(hand.mesh.vertex_count(), 0);
    for (const SourcePoint& p : set.source)
        for (int k = 0; k < 3; ++k)
            if (p.bary[k] == 1.0)
                ++seen[hand.mesh.triangle(p.face)[k]];
    for (const int s : seen)
        EXPECT_EQ(s, 1);
}

TEST(DomainSamples, beyond_the_cap_vertices_are_thinned_evenly)
{
    const HandDomain hand = sphere_cube(0, 48);
    SampleOptions options;
    options.max_vertices = 144;
    const SurfaceSampleSet set = sampled(hand, options);
    EXPECT_EQ(set.size(), 6u * 288u);
    std::vector<int> count(6 * 144, 0);
    for (std::size_t i = 0; i < set.size(); ++i) {
        const DomainPoint& d = set.domain[i];
        if (i % 288 >= 144)
            ++count[144 * d.quad + 12 * std::min(11, int(12 * d.v)) + std::min(11, int(12 * d.u))];
    }
    for (const int c : count)
        EXPECT_EQ(c, 1);
}

TEST(DomainSamples, normals_follow_a_smooth_shape)
{
    const HandDomain hand = sphere_cube(0, 16);
    const SurfaceSampleSet set = sampled(hand);
    double smooth = 0.0, flat = 0.0; // Sums of squared angles to the sphere's normal.
    for (std::size_t i = 0; i < set.size(); ++i) {
        const Vec3 exact = normalized(set.positions[i]);
        smooth += norm_squared(set.normals[i] - exact);
        flat += norm_squared(normalized(hand.mesh.area_vector(set.source[i].face)) - exact);
        EXPECT_LT(norm(set.normals[i] - exact), 0.02);
    }
    EXPECT_LT(std::sqrt(smooth), 0.1 * std::sqrt(flat));
}

TEST(DomainSamples, normals_keep_to_the_sides_of_a_sharp_shape)
{
    // The unit cube: project the sphere's cube back.
    HandDomain hand = sphere_cube(0, 4);
    std::vector<Vec3> positions = hand.mesh.positions();
    for (Vec3& p : positions)
        p = p / std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
    auto mesh = ManifoldMesh::build(positions, hand.mesh.triangles());
    ASSERT_TRUE(mesh.ok());
    hand.mesh = *mesh;
    for (QuadChart& chart : hand.charts)
        for (auto& v : chart.vertices)
            v.position = v.position / std::max({std::fabs(v.position.x), std::fabs(v.position.y),
                                                std::fabs(v.position.z)});
    const SurfaceSampleSet set = sampled(hand);
    for (std::size_t i = 0; i < set.size(); ++i) {
        const Vec3 face = normalized(hand.mesh.area_vector(set.source[i].face));
        EXPECT_LT(norm(set.normals[i] - face), 1e-12);
    }
}

TEST(DomainSamples, follow_computed_charts_over_a_refined_carrier)
{
    HandDomain hand = with_refined_carrier(torus_askew(2, 2));
    Context context;
    auto charts = compute_charts(hand.mesh, hand.domain, context);
    ASSERT_TRUE(charts.ok()) << charts.error().message;
    hand.charts = *charts;
    const SurfaceSampleSet set = sampled(hand);
    EXPECT_EQ(set.size(), hand.charts.size() * 144 + hand.mesh.vertex_count());
    double total = 0.0;
    std::vector<int> per_piece(16 * hand.charts.size(), 0);
    for (std::size_t i = 0; i < set.size(); ++i) {
        const DomainPoint& d = set.domain[i];
        total += set.weights[i];
        EXPECT_EQ(set.positions[i], hand.mesh.at(set.source[i]));
        ++per_piece[16 * d.quad + 4 * std::min(3, int(4 * d.u)) + std::min(3, int(4 * d.v))];
        // The chart leads back to the same place.
        const ChartLocator locator(hand.charts[d.quad]);
        const SourcePoint there = source_point(hand.charts[d.quad], locator.locate({d.u, d.v}));
        EXPECT_LT(norm(hand.mesh.at(there) - set.positions[i]), 1e-12);
    }
    for (const int count : per_piece)
        EXPECT_GE(count, 9);
    EXPECT_NEAR(total, mesh_area(hand.mesh), 1e-7 * total);
}

TEST(DomainSamples, are_the_same_for_any_thread_count)
{
    HandDomain hand = genus2_voxels(0, 8);
    bend(hand);
    Context one, four;
    one.threads = 1;
    four.threads = 4;
    const auto a = make_samples(hand.mesh, hand.charts, {}, one);
    const auto b = make_samples(hand.mesh, hand.charts, {}, four);
    ASSERT_TRUE(a.ok() && b.ok());
    EXPECT_EQ(a->positions, b->positions);
    EXPECT_EQ(a->normals, b->normals);
    EXPECT_EQ(a->weights, b->weights);
}

TEST(DomainSamples, refuse_bad_options_and_empty_charts_and_can_be_cancelled)
{
    HandDomain hand = sphere_cube(0, 4);
    Context context;
    SampleOptions options;
    options.per_side = 3;
    EXPECT_EQ(make_samples(hand.mesh, hand.charts, options, context).error().code,
              ErrorCode::bad_option);
    options = {};
    options.smooth_angle = NAN;
    EXPECT_EQ(make_samples(hand.mesh, hand.charts, options, context).error().code,
              ErrorCode::bad_option);
    context.cancel();
    EXPECT_EQ(make_samples(hand.mesh, hand.charts, {}, context).error().code, ErrorCode::cancelled);
    Context fresh;
    hand.charts[2] = {};
    const auto empty = make_samples(hand.mesh, hand.charts, {}, fresh);
    ASSERT_FALSE(empty.ok());
    EXPECT_EQ(empty.error().code, ErrorCode::invalid_domain);
    EXPECT_EQ(empty.error().element, 2u);
}

TEST(ChartLocator, finds_the_triangle_that_brute_force_finds)
{
    HandDomain hand = sphere_cube(0, 24);
    bend(hand);
    const QuadChart& chart = hand.charts[3];
    const ChartLocator locator(chart);
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    for (int i = 0; i < 2000; ++i) {
        // Some points on sides and corners.
        const Vec2 uv{i % 5 == 0 ? double(i % 2) : uniform(random),
                      i % 7 == 0 ? double(i % 2) : uniform(random)};
        const auto hit = locator.locate(uv);
        ASSERT_NE(hit.triangle, invalid_index);
        Vec2 back;
        for (int k = 0; k < 3; ++k)
            back = back + hit.weights[k] * chart.vertices[chart.triangles[hit.triangle][k]].uv;
        EXPECT_LT(norm(back - uv), 1e-14);
    }
}

TEST(ChartLocator, gives_a_nearby_triangle_for_a_point_outside)
{
    const HandDomain hand = sphere_cube(0, 4);
    const ChartLocator locator(hand.charts[0]);
    for (const Vec2 uv : {Vec2{-0.5, 0.5}, Vec2{1.0 + 1e-12, 1.0}, Vec2{0.3, 40.0}}) {
        const auto hit = locator.locate(uv);
        ASSERT_NE(hit.triangle, invalid_index);
        EXPECT_NEAR(hit.weights[0] + hit.weights[1] + hit.weights[2], 1.0, 1e-15);
    }
}

} // namespace
} // namespace bot2nurbs::test
