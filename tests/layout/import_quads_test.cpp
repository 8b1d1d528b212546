// SPDX-License-Identifier: MIT
#include "bot2nurbs/import_quads.h"

#include "bot2nurbs/closest_point.h"
#include "bot2nurbs/domain_file.h"
#include "bot2nurbs/validate_domain.h"
#include "layout/crease_fixtures.h"
#include "layout/quad_fixtures.h"

#include <gtest/gtest.h>

#include <random>

namespace bot2nurbs::fixtures {
namespace {

// Imports, and expects a domain that the validator has nothing against and whose topology is that
// of the quads, number by number.
std::optional<QuadImport> imported(const ManifoldMesh& mesh, const QuadMesh& quads,
                                   const MeshFeatures& features = {})
{
    Context context;
    Result<QuadImport> result = import_quads(mesh, quads, features, context);
    if (!result) {
        ADD_FAILURE() << result.error().message;
        return std::nullopt;
    }
    const QuadDomain& domain = result->domain;
    const auto found = validate_domain(mesh, domain, context);
    EXPECT_TRUE(found && found->valid())
        << (found && !found->defects.empty() ? found->defects[0].message : "");
    EXPECT_EQ(domain.vertices.size(), quads.positions.size());
    EXPECT_EQ(domain.complex.quad_count(), quads.quads.size());
    EXPECT_EQ(domain.origin, "quads");
    return std::move(*result);
}

void expect_refused(const ManifoldMesh& mesh, const QuadMesh& quads, const std::string& words)
{
    Context context;
    const auto result = import_quads(mesh, quads, {}, context);
    ASSERT_FALSE(result) << words;
    EXPECT_EQ(result.error().code, ErrorCode::invalid_domain);
    EXPECT_NE(result.error().message.find(words), std::string::npos) << result.error().message;
}

QuadMesh ball(int n)
{
    return moved(quads_of_pairs(cube(n)), [](const Vec3& p) { return normalized(p); });
}

MeshFeatures creases_of(const ManifoldMesh& mesh)
{
    MeshFeatures features;
    std::vector<int> ends(mesh.vertex_count(), 0);
    for (const FeaturePath& path : crease_paths(mesh)) {
        features.creases.push_back(path.vertices);
        for (const Index v : path.vertices)
            ++ends[v];
    }
    for (Index v = 0; v < ends.size(); ++v)
        if (ends[v] > 2)
            features.corners.push_back(v);
    features.kept_edges = static_cast<Index>(features.creases.size());
    return features;
}

TEST(ImportQuads, draws_coarse_and_fine_cubes_on_a_ball)
{
    const ManifoldMesh mesh = icosphere(3);
    for (const int n : {1, 2, 3, 5, 9, 16}) {
        SCOPED_TRACE(n);
        const auto made = imported(mesh, ball(n));
        ASSERT_TRUE(made);
        EXPECT_EQ(made->domain.complex.quads(), ball(n).quads);
        EXPECT_EQ(made->crease_edges, 0u);
    }
}

TEST(ImportQuads, puts_vertices_at_their_closest_points_but_for_snapping)
{
    const ManifoldMesh mesh = icosphere(3);
    const QuadMesh quads = ball(3);
    const auto made = imported(mesh, quads);
    ASSERT_TRUE(made);
    const ClosestPoint closest(mesh);
    // The shortest side of a quad, and the share of it that a vertex may be moved by.
    const double side = 0.5, snap = 0.08;
    double largest = 0.0;
    for (std::size_t v = 0; v < quads.positions.size(); ++v) {
        const Vec3 at = made->domain.carrier.mesh.position(made->domain.vertices[v]);
        EXPECT_LT(norm(at - closest.query(quads.positions[v]).position), snap * side);
        largest = std::max(largest, norm(at - quads.positions[v]));
    }
    EXPECT_EQ(made->largest_move, largest);
}

TEST(ImportQuads, accepts_quads_that_turn_inward)
{
    const ManifoldMesh mesh = icosphere(2);
    QuadMesh quads = ball(2);
    for (auto& q : quads.quads)
        std::swap(q[1], q[3]);
    const auto made = imported(mesh, quads);
    ASSERT_TRUE(made);
    EXPECT_EQ(made->domain.complex.quads(), ball(2).quads);
}

TEST(ImportQuads, draws_grids_around_the_handles_of_surfaces)
{
    for (const int m : {3, 7, 20}) {
        SCOPED_TRACE(m);
        EXPECT_TRUE(imported(torus(24, 11), quads_of_pairs(torus(m, 4))));
    }
    const ManifoldMesh plate = genus_two(0);
    EXPECT_TRUE(imported(split_in_four(split_in_four(plate)), quads_of_pairs(plate)));
}

TEST(ImportQuads, quads_of_the_mesh_itself_run_along_its_edges)
{
    const ManifoldMesh mesh = torus(12, 8);
    const auto made = imported(mesh, quads_of_pairs(mesh));
    ASSERT_TRUE(made);
    EXPECT_LT(made->largest_move, 1e-12);
    for (const DomainEdge& edge : made->domain.edges)
        for (const PathPoint& p : edge.path)
            EXPECT_TRUE(p.is_vertex());
}

TEST(ImportQuads, vertices_pushed_about_still_make_a_valid_domain)
{
    const ManifoldMesh mesh = torus(24, 11);
    std::mt19937 random(1);
    for (const double amount : {0.05, 0.15, 0.3}) {
        SCOPED_TRACE(amount);
        std::uniform_real_distribution<double> push(-amount, amount);
        const QuadMesh quads = moved(quads_of_pairs(torus(10, 5)), [&](const Vec3& p) {
            const double x = push(random), y = push(random), z = push(random);
            return p + Vec3{x, y, z};
        });
        EXPECT_TRUE(imported(mesh, quads));
    }
}

TEST(ImportQuads, the_boundary_of_the_quads_becomes_that_of_the_mesh)
{
    const ManifoldMesh cylinder = open_cylinder(24, 10);
    for (const int m : {4, 9, 30}) {
        SCOPED_TRACE(m);
        // Turned by a bit, and too short by a bit.
        const QuadMesh quads = moved(quads_of_pairs(open_cylinder(m, 3)), [](const Vec3& p) {
            return Vec3{p.x * std::cos(0.1) - p.y * std::sin(0.1),
                        p.x * std::sin(0.1) + p.y * std::cos(0.1), 0.9 * p.z};
        });
        const auto made = imported(cylinder, quads);
        ASSERT_TRUE(made);
        const QuadDomain& d = made->domain;
        for (Index e = 0; e < d.complex.edge_count(); ++e) {
            if (!d.complex.is_boundary_edge(e))
                continue;
            EXPECT_TRUE(d.carrier.mesh.is_boundary_vertex(d.vertices[d.edges[e].a]));
            EXPECT_TRUE(d.carrier.mesh.is_boundary_vertex(d.vertices[d.edges[e].b]));
        }
    }
    EXPECT_TRUE(imported(square(12), quads_of_pairs(square(5))));
}

TEST(ImportQuads, creases_that_edges_follow_become_creases)
{
    const ManifoldMesh mesh = cube(6);
    for (const int n : {1, 2, 4}) {
        SCOPED_TRACE(n);
        const auto made = imported(mesh, quads_of_pairs(cube(n)), creases_of(mesh));
        ASSERT_TRUE(made);
        EXPECT_EQ(made->crease_edges, static_cast<Index>(12 * n));
        EXPECT_TRUE(made->smoothed.empty());
        for (Index v = 0; v < made->domain.complex.vertex_count(); ++v) {
            const Vec3 at = made->domain.carrier.mesh.position(made->domain.vertices[v]);
            const bool corner = std::fabs(at.x * at.y * at.z) > 1.0 - 1e-9;
            EXPECT_EQ(made->domain.complex.is_corner(v), corner);
        }
    }
}

TEST(ImportQuads, creases_that_no_edge_follows_are_listed)
{
    const ManifoldMesh mesh = cube(6);
    // Every edge of the part runs through the middles of quads.
    const QuadMesh quads = moved(quads_of_pairs(cube(3)), [](const Vec3& p) {
        return Vec3{0.8 * p.x * std::cos(0.6) - 0.8 * p.y * std::sin(0.6),
                    0.8 * p.x * std::sin(0.6) + 0.8 * p.y * std::cos(0.6), p.z * 0.8};
    });
    const auto made = imported(mesh, quads, creases_of(mesh));
    ASSERT_TRUE(made);
    // 12 edges of 6 mesh edges; those that are followed by chance are creases of the domain.
    EXPECT_GT(made->smoothed.size(), 60u);
}

TEST(ImportQuads, quads_of_another_topology_are_refused)
{
    expect_refused(icosphere(2), quads_of_pairs(torus(6, 4)), "genus 1");
    expect_refused(open_cylinder(12, 4), quads_of_pairs(square(4)), "boundary loop");
    QuadMesh open = ball(2);
    open.quads.pop_back();
    expect_refused(icosphere(2), open, "boundary loop");
}

TEST(ImportQuads, quads_away_from_the_mesh_are_refused)
{
    const QuadMesh quads = moved(ball(4), [](const Vec3& p) { return p + Vec3{3.0, 0.0, 0.0}; });
    expect_refused(icosphere(2), quads, "must lie near");
}

TEST(ImportQuads, a_vertex_with_two_quads_is_refused_by_its_number_in_the_file)
{
    // A pillow: two quads over each other.
    const auto pieces = split_quads(
        polygons({{9, 9, 9}, {-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0, 0, 1}, {0, 0, -1}},
                 {{1, 2, 5, 4}, {2, 3, 4, 5}, {1, 4, 6, 2}, {2, 6, 4, 3}}));
    ASSERT_TRUE(pieces) << pieces.error().message;
    Context context;
    const auto result = import_quads(icosphere(2), pieces->front(), {}, context);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().element, 1u) << result.error().message;
    EXPECT_NE(result.error().message.find("vertex 1 "), std::string::npos);
}

TEST(ImportQuads, the_domain_does_not_depend_on_the_number_of_threads)
{
    const ManifoldMesh mesh = torus(24, 11);
    std::vector<std::string> text;
    for (const unsigned threads : {1u, 4u}) {
        Context context;
        context.threads = threads;
        const auto made = import_quads(mesh, quads_of_pairs(torus(7, 4)), {}, context);
        ASSERT_TRUE(made) << made.error().message;
        text.push_back(domains_to_json({made->domain}));
    }
    EXPECT_EQ(text[0], text[1]);
}

TEST(ImportQuads, can_be_cancelled)
{
    Context context;
    context.cancel();
    const auto made = import_quads(icosphere(2), ball(2), {}, context);
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().code, ErrorCode::cancelled);
}

} // namespace
} // namespace bot2nurbs::fixtures
