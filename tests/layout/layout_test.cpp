// SPDX-License-Identifier: MIT
#include "bot2nurbs/layout.h"

#include "mesh_fixtures.h"

#include <gtest/gtest.h>

#include <thread>

namespace bot2nurbs::fixtures {
namespace {

TEST(Layout, of_every_fixture_has_its_genus_and_proven_charts)
{
    for (const auto& [name, mesh, genus] : closed_meshes()) {
        Context context;
        const auto layout = build_layout(mesh, {}, context);
        ASSERT_TRUE(layout.ok()) << name << ": " << layout.error().message;
        const QuadDomain& domain = layout->domain;
        EXPECT_EQ(domain.complex.euler_characteristic(), 2 - 2 * genus) << name;
        EXPECT_TRUE(domain.complex.closed());
        EXPECT_LE(domain.complex.max_valence(), 8u) << name;
        const auto charts = compute_charts(mesh, domain, context);
        ASSERT_TRUE(charts.ok()) << name << ": " << charts.error().message;
        EXPECT_EQ(charts->size(), domain.complex.quad_count());
        // Chart corners lie on the source where their weights say.
        for (const QuadChart& chart : *charts)
            for (std::size_t t = 0; t < chart.triangles.size(); ++t)
                for (int k = 0; k < 3; ++k)
                    ASSERT_LT(norm(mesh.at({chart.source_face[t], chart.bary[t][k]}) -
                                   chart.vertices[chart.triangles[t][k]].position),
                              1e-12)
                        << name;
    }
}

TEST(Layout, patch_count_is_within_a_factor_of_one_and_a_half_of_the_wish)
{
    for (const auto& [name, mesh, genus] : closed_meshes())
        for (const Index wish : {40u, 120u}) {
            if (genus > 2)
                continue;
            Context context;
            LayoutOptions options;
            options.patches = wish;
            const auto layout = build_layout(mesh, options, context);
            ASSERT_TRUE(layout.ok()) << name << ": " << layout.error().message;
            const double count = layout->domain.complex.quad_count();
            EXPECT_LE(count, 1.5 * wish) << name;
            EXPECT_GE(count, wish / 1.5) << name;
        }
}

TEST(Layout, charts_of_neighbours_agree_along_their_side)
{
    const ManifoldMesh mesh = icosphere(3);
    Context context;
    const auto layout = build_layout(mesh, {}, context);
    ASSERT_TRUE(layout.ok());
    const auto charts = compute_charts(mesh, layout->domain, context);
    ASSERT_TRUE(charts.ok());
    const QuadComplex& k = layout->domain.complex;
    // Border vertices of a chart on one of its sides, as (parameter along the side, position).
    const auto side = [&](Index h) {
        std::vector<std::pair<double, Vec3>> points;
        for (const auto& v : (*charts)[QuadComplex::quad_of(h)].vertices) {
            const double s[4] = {v.uv.y, 1.0 - v.uv.x, 1.0 - v.uv.y, v.uv.x};
            const double along[4] = {v.uv.x, v.uv.y, 1.0 - v.uv.x, 1.0 - v.uv.y};
            if (s[QuadComplex::side_of(h)] == 0.0)
                points.emplace_back(along[QuadComplex::side_of(h)], v.position);
        }
        std::sort(points.begin(), points.end(),
                  [](const auto& a, const auto& b) { return a.first < b.first; });
        return points;
    };
    for (Index h = 0; h < k.halfedge_count(); ++h) {
        const auto mine = side(h), theirs = side(k.twin(h));
        ASSERT_EQ(mine.size(), theirs.size());
        for (std::size_t i = 0; i < mine.size(); ++i) {
            EXPECT_NEAR(mine[i].first, 1.0 - theirs[theirs.size() - 1 - i].first, 1e-12);
            EXPECT_TRUE(mine[i].second == theirs[theirs.size() - 1 - i].second);
        }
    }
}

TEST(Layout, is_the_same_for_any_thread_count_and_run_after_run)
{
    const ManifoldMesh mesh = genus_two(2);
    const auto run = [&mesh](unsigned threads) {
        Context context;
        context.threads = threads;
        auto layout = build_layout(mesh, {}, context);
        EXPECT_TRUE(layout.ok());
        return std::move(layout->domain);
    };
    const QuadDomain first = run(1);
    for (const unsigned threads : {1u, 2u, 8u}) {
        const QuadDomain other = run(threads);
        ASSERT_EQ(other.complex.quads(), first.complex.quads());
        ASSERT_EQ(other.vertices, first.vertices);
        for (std::size_t e = 0; e < first.edges.size(); ++e) {
            ASSERT_EQ(other.edges[e].path.size(), first.edges[e].path.size());
            for (std::size_t i = 0; i < first.edges[e].path.size(); ++i)
                ASSERT_EQ(other.edges[e].path[i].t, first.edges[e].path[i].t);
        }
    }
}

TEST(Layout, refuses_zero_patches)
{
    Context context;
    LayoutOptions none;
    none.patches = 0;
    const auto zero = build_layout(octahedron(), none, context);
    ASSERT_FALSE(zero.ok());
    EXPECT_EQ(zero.error().code, ErrorCode::bad_option);
}

TEST(Layout, stops_soon_after_a_cancel)
{
    const ManifoldMesh mesh = icosphere(6);
    Context context;
    context.cancel();
    const auto layout = build_layout(mesh, {}, context);
    ASSERT_FALSE(layout.ok());
    EXPECT_EQ(layout.error().code, ErrorCode::cancelled);
}

} // namespace
} // namespace bot2nurbs::fixtures
