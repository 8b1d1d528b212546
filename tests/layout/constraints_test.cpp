// SPDX-License-Identifier: MIT
#include "bot2nurbs/layout.h"
#include "bot2nurbs/validate_domain.h"

#include "layout/crease_fixtures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <set>

namespace bot2nurbs::fixtures {
namespace {

using Edge = std::pair<Index, Index>;

Edge edge_of(Index a, Index b)
{
    return {std::min(a, b), std::max(a, b)};
}

Result<LayoutResult> lay_out(const ManifoldMesh& mesh, const DomainConstraints& constraints,
                             Index patches = 30)
{
    LayoutOptions options;
    options.patches = patches;
    options.constraints = constraints;
    Context context;
    auto layout = build_layout(mesh, options, context);
    if (layout) {
        layout->domain.source_signature = signature(mesh);
        const auto validation = validate_domain(mesh, layout->domain, context);
        EXPECT_TRUE(validation.ok() && validation->valid())
            << (validation.ok() && !validation->defects.empty() ? validation->defects[0].message
                                                                : "");
    }
    return layout;
}

// Edges and diagonals of the quads, as carrier vertices.
std::set<Edge> edges_of(const QuadDomain& domain)
{
    std::set<Edge> edges;
    for (const DomainEdge& e : domain.edges)
        edges.insert(edge_of(domain.vertices[e.a], domain.vertices[e.b]));
    return edges;
}
std::set<Edge> diagonals_of(const QuadDomain& domain)
{
    std::set<Edge> diagonals;
    for (const auto& q : domain.complex.quads())
        for (int k = 0; k < 2; ++k)
            diagonals.insert(edge_of(domain.vertices[q[k]], domain.vertices[q[k + 2]]));
    return diagonals;
}

Index nearest_vertex(const ManifoldMesh& mesh, const Vec3& p)
{
    Index best = 0;
    for (Index v = 1; v < mesh.vertex_count(); ++v)
        if (norm(mesh.position(v) - p) < norm(mesh.position(best) - p))
            best = v;
    return best;
}

// Sites at all vertices of an unconstrained layout that are source vertices.
DomainConstraints sites_of_layout(const ManifoldMesh& mesh, Index patches, QuadDomain& domain)
{
    auto layout = lay_out(mesh, {}, patches);
    EXPECT_TRUE(layout.ok());
    domain = std::move(layout->domain);
    DomainConstraints constraints;
    for (const Index v : domain.vertices)
        if (v < mesh.vertex_count())
            constraints.sites.push_back({v, {}, {}});
    return constraints;
}

Index number_of(const DomainConstraints& constraints, Index vertex)
{
    for (Index i = 0; i < constraints.sites.size(); ++i)
        if (constraints.sites[i].vertex == vertex)
            return i;
    return invalid_index;
}

// A ring of mesh edges around the z axis of the cube on [-1, 1]^3.
std::vector<Index> ring(const ManifoldMesh& mesh, double z)
{
    std::vector<Index> on;
    for (Index v = 0; v < mesh.vertex_count(); ++v)
        if (std::fabs(mesh.position(v).z - z) < 1e-9)
            on.push_back(v);
    std::vector<Index> path{on.front()};
    for (std::size_t step = 0; step < on.size(); ++step) {
        for (const Index v : on) {
            const bool known = std::find(path.begin(), path.end(), v) != path.end();
            const bool closes = step + 1 == on.size() && v == path.front();
            if ((!known || closes) && (mesh.find_halfedge(path.back(), v) != invalid_index)) {
                path.push_back(v);
                break;
            }
        }
    }
    return path;
}

Error conflict_of(const ManifoldMesh& mesh, const DomainConstraints& constraints,
                  Index patches = 30)
{
    const auto layout = lay_out(mesh, constraints, patches);
    EXPECT_FALSE(layout.ok());
    if (layout.ok())
        return {};
    EXPECT_EQ(layout.error().code, ErrorCode::constraint_conflict) << layout.error().message;
    return layout.error();
}

TEST(Constraints, sites_are_vertices_of_the_domain)
{
    for (const ManifoldMesh& mesh : {icosphere(3), torus(30, 16), square(12)}) {
        DomainConstraints c;
        for (const Index v : {3u, 50u, 100u, 120u})
            c.sites.push_back({v, {}, {}});
        c.sites.push_back({std::nullopt, {20, {0.3, 0.3, 0.4}}, {}});
        c.sites.push_back({std::nullopt, {140, {0.5, 0.5, 0.0}}, {}});
        const auto layout = lay_out(mesh, c);
        ASSERT_TRUE(layout.ok()) << layout.error().message;
        for (const ConstraintSite& s : c.sites) {
            const Vec3 p = s.vertex ? mesh.position(*s.vertex) : mesh.at(s.point);
            EXPECT_TRUE(std::any_of(
                layout->domain.vertices.begin(), layout->domain.vertices.end(), [&](Index v) {
                    return norm(layout->domain.carrier.mesh.position(v) - p) < 1e-14;
                }));
        }
    }
}

TEST(Constraints, two_sites_at_one_place_are_a_conflict)
{
    const ManifoldMesh mesh = icosphere(2);
    DomainConstraints c;
    c.sites = {{mesh.triangle(5)[0], {}, {}}, {std::nullopt, {5, {1.0, 0.0, 0.0}}, {}}};
    EXPECT_NE(conflict_of(mesh, c).message.find("sites 0 and 1"), std::string::npos);
}

TEST(Constraints, paths_are_smooth_edges_of_the_domain_and_creases_sharp_ones)
{
    const ManifoldMesh mesh = moved(cube(8), [](const Vec3& p) { return p; });
    const std::vector<Index> around =
        ring(mesh, mesh.position(0).z + 0.5 * (mesh.box().max.z - mesh.box().min.z));
    ASSERT_GE(around.size(), 10u);
    ASSERT_EQ(around.front(), around.back());
    for (const bool crease : {false, true}) {
        DomainConstraints c;
        if (crease)
            c.features.push_back({FeatureKind::crease, around});
        else
            c.paths.push_back({around});
        const auto layout = lay_out(mesh, c);
        ASSERT_TRUE(layout.ok()) << layout.error().message;
        Index creases = 0;
        for (const DomainEdge& e : layout->domain.edges)
            creases += e.crease;
        EXPECT_EQ(creases > 0, crease);
    }
}

TEST(Constraints, features_of_two_kinds_on_one_edge_are_a_conflict_and_so_is_a_boundary_inside)
{
    const ManifoldMesh mesh = icosphere(2);
    const std::vector<Index> edge{mesh.triangle(0)[0], mesh.triangle(0)[1]};
    DomainConstraints c;
    c.features = {{FeatureKind::crease, edge}, {FeatureKind::smooth_seam, edge}};
    EXPECT_NE(conflict_of(mesh, c).message.find("features 0 and 1"), std::string::npos);
    c.features = {{FeatureKind::boundary, edge}};
    EXPECT_NE(conflict_of(mesh, c).message.find("feature 0"), std::string::npos);
}

TEST(Constraints, a_corner_makes_its_vertex_one_where_the_boundary_may_turn)
{
    const ManifoldMesh mesh = open_cylinder(16, 6);
    DomainConstraints c;
    Index rim = 0;
    while (!mesh.is_boundary_vertex(rim))
        ++rim;
    c.features = {{FeatureKind::corner, {rim}}};
    const auto layout = lay_out(mesh, c);
    ASSERT_TRUE(layout.ok()) << layout.error().message;
    const auto& vertices = layout->domain.vertices;
    const auto at = std::find(vertices.begin(), vertices.end(), rim);
    ASSERT_NE(at, vertices.end());
    EXPECT_TRUE(layout->domain.complex.is_corner(static_cast<Index>(at - vertices.begin())));
}

TEST(Constraints, a_required_adjacency_is_an_edge)
{
    const ManifoldMesh mesh = icosphere(4);
    DomainConstraints c;
    c.sites = {{nearest_vertex(mesh, {1, 0, 0}), {}, {}},
               {nearest_vertex(mesh, {0, 1, 0}), {}, {}}};
    c.adjacencies = {{Demand::required, {0, 1}}};
    const auto layout = lay_out(mesh, c);
    ASSERT_TRUE(layout.ok()) << layout.error().message;
    EXPECT_EQ(edges_of(layout->domain).count(edge_of(*c.sites[0].vertex, *c.sites[1].vertex)), 1u);
}

TEST(Constraints, a_required_adjacency_across_a_closed_feature_is_a_conflict)
{
    const ManifoldMesh mesh = cube(8);
    const Box3 box = mesh.box();
    DomainConstraints c;
    c.features = {{FeatureKind::crease, ring(mesh, 0.5 * (box.min.z + box.max.z))}};
    c.sites = {{nearest_vertex(mesh, box.min), {}, {}}, {nearest_vertex(mesh, box.max), {}, {}}};
    c.adjacencies = {{Demand::required, {0, 1}}};
    EXPECT_NE(conflict_of(mesh, c).message.find("adjacency 0"), std::string::npos);
}

TEST(Constraints, a_forbidden_adjacency_is_no_edge)
{
    const ManifoldMesh mesh = icosphere(4);
    QuadDomain before;
    DomainConstraints c = sites_of_layout(mesh, 20, before);
    // Forbid an edge that comes out when it is not forbidden.
    const auto free = lay_out(mesh, c, 20);
    ASSERT_TRUE(free.ok());
    for (const Edge& e : edges_of(free->domain)) {
        const Index a = number_of(c, e.first), b = number_of(c, e.second);
        if (a == invalid_index || b == invalid_index)
            continue;
        c.adjacencies = {{Demand::forbidden, {a, b}}};
        const auto layout = lay_out(mesh, c, 20);
        ASSERT_TRUE(layout.ok()) << layout.error().message;
        EXPECT_EQ(edges_of(layout->domain).count(e), 0u);
        return;
    }
    FAIL() << "no edge between two sites";
}

TEST(Constraints, a_forbidden_adjacency_of_neighbours_without_anything_between_is_a_conflict)
{
    // Two ends of one edge of a crease.
    const ManifoldMesh mesh = cube(1);
    DomainConstraints c;
    const Index h = mesh.find_halfedge(0, 1) != invalid_index ? mesh.find_halfedge(0, 1) : 0;
    c.sites = {{mesh.from(h), {}, {}}, {mesh.to(h), {}, {}}};
    c.adjacencies = {{Demand::required, {0, 1}}};
    DomainConstraints both = c;
    both.adjacencies.push_back({Demand::forbidden, {0, 1}});
    EXPECT_NE(conflict_of(mesh, both).message.find("adjacency"), std::string::npos);
}

TEST(Constraints, pairings_are_quads_when_required_and_none_when_forbidden)
{
    const ManifoldMesh mesh = icosphere(4);
    QuadDomain before;
    const DomainConstraints sites = sites_of_layout(mesh, 20, before);
    const auto free = lay_out(mesh, sites, 20);
    ASSERT_TRUE(free.ok());
    // Every diagonal between two sites was the edge of a pair: its being joined can be forbidden,
    // and what was an edge can be required to be one, unless that is too far.
    int required = 0, forbidden = 0;
    for (const Edge& d : diagonals_of(free->domain)) {
        const Index a = number_of(sites, d.first), b = number_of(sites, d.second);
        if (a == invalid_index || b == invalid_index)
            continue;
        DomainConstraints c = sites;
        c.pairings = {{Demand::required, {a, b}}};
        auto layout = lay_out(mesh, c, 20);
        if (layout.ok()) {
            EXPECT_EQ(diagonals_of(layout->domain).count(d), 1u);
            ++required;
        } else {
            EXPECT_EQ(layout.error().code, ErrorCode::constraint_conflict);
        }
        c.pairings = {{Demand::forbidden, {a, b}}};
        layout = lay_out(mesh, c, 20);
        if (layout.ok()) {
            EXPECT_EQ(diagonals_of(layout->domain).count(d), 0u);
            ++forbidden;
        } else {
            EXPECT_EQ(layout.error().code, ErrorCode::constraint_conflict);
        }
        if (required >= 3 && forbidden >= 3)
            break;
    }
    EXPECT_GE(required, 3);
    EXPECT_GE(forbidden, 3);
}

TEST(Constraints, a_required_pairing_across_a_crease_is_a_conflict)
{
    const ManifoldMesh mesh = cube(6);
    const Box3 box = mesh.box();
    DomainConstraints c;
    c.features = {{FeatureKind::crease, ring(mesh, 0.5 * (box.min.z + box.max.z))}};
    c.sites = {{nearest_vertex(mesh, box.min), {}, {}}, {nearest_vertex(mesh, box.max), {}, {}}};
    c.pairings = {{Demand::required, {0, 1}}};
    EXPECT_NE(conflict_of(mesh, c).message.find("pairing 0"), std::string::npos);
}

TEST(Constraints, a_pairing_that_needs_a_forbidden_edge_is_a_conflict)
{
    const ManifoldMesh mesh = icosphere(3);
    DomainConstraints c;
    c.sites = {{1u, {}, {}}, {40u, {}, {}}};
    c.pairings = {{Demand::required, {0, 1}}};
    c.adjacencies = {{Demand::forbidden, {0, 1}}};
    const Error error = conflict_of(mesh, c);
    EXPECT_NE(error.message.find("pairing 0"), std::string::npos);
    EXPECT_NE(error.message.find("adjacency 0"), std::string::npos);
}

TEST(Constraints, hints_steer_the_count_and_the_valence)
{
    const ManifoldMesh mesh = icosphere(4);
    LayoutOptions options;
    options.constraints.patches = 60;
    Context context;
    auto layout = build_layout(mesh, options, context);
    ASSERT_TRUE(layout.ok());
    EXPECT_NEAR(layout->domain.complex.quad_count(), 60.0, 30.0);
    int met = 0;
    for (const Index v : {10u, 200u, 400u, 600u, 800u}) {
        DomainConstraints c;
        c.sites = {{v, {}, 5u}};
        auto wished = lay_out(mesh, c, 60);
        ASSERT_TRUE(wished.ok());
        const auto& vertices = wished->domain.vertices;
        const Index at =
            static_cast<Index>(std::find(vertices.begin(), vertices.end(), v) - vertices.begin());
        met += wished->domain.complex.valence(at) == 5;
    }
    // A hint: by chance one vertex in eight has five quads.
    EXPECT_GE(met, 3);
}

} // namespace
} // namespace bot2nurbs::fixtures
