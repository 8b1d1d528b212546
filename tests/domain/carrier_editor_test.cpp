// SPDX-License-Identifier: MIT
#include "domain/carrier_editor.h"

#include "domain/domain_paths.h"
#include "domain/validate_domain_rules.h"
#include "hand_domains.h"

#include <gtest/gtest.h>

#include <random>

namespace bot2nurbs {
namespace {

using test::HandDomain;

std::vector<SurfacePath> paths_of(const QuadDomain& domain)
{
    std::vector<SurfacePath> paths;
    for (Index e = 0; e < domain.edges.size(); ++e)
        paths.push_back(*domain_path(domain, e));
    return paths;
}

//! The domain on the edited carrier.
QuadDomain edited(const QuadDomain& domain, const CarrierEditor& editor)
{
    QuadDomain result = domain;
    result.carrier = editor.carrier();
    const std::vector<SurfacePath> paths = editor.paths(result.carrier.mesh);
    for (Index e = 0; e < result.edges.size(); ++e)
        result.edges[e].path = path_points(result.carrier.mesh, paths[e]);
    return result;
}

std::string defects_of(const ManifoldMesh& source, const QuadDomain& domain)
{
    DefectList defects;
    check_carrier(source, domain.carrier, defects);
    if (defects.empty())
        check_paths(domain, defects);
    return defects.empty() ? "" : defects.defects().front().message;
}

std::vector<HandDomain> hands()
{
    return {test::sphere_cube(0, 4), test::torus_askew(), test::open_cylinder(),
            test::with_refined_carrier(test::torus_askew(3, 1))};
}

TEST(CarrierEditor, keeps_paths_uncrossed_whatever_edges_are_halved)
{
    std::mt19937 random(1);
    for (const HandDomain& hand : hands()) {
        CarrierEditor editor(hand.mesh, hand.domain.carrier, paths_of(hand.domain));
        EXPECT_EQ(defects_of(hand.mesh, edited(hand.domain, editor)), "");
        for (int step = 0; step < 10; ++step) {
            for (int i = 0; i < 40; ++i)
                editor.halve(random() % (3 * editor.face_count()));
            ASSERT_EQ(defects_of(hand.mesh, edited(hand.domain, editor)), "") << "step " << step;
        }
    }
}

TEST(CarrierEditor, makes_vertices_of_crossings_on_their_paths)
{
    std::mt19937 random(2);
    for (const HandDomain& hand : hands()) {
        CarrierEditor editor(hand.mesh, hand.domain.carrier, paths_of(hand.domain));
        for (int i = 0; i < 100; ++i) {
            const Index path = random() % hand.domain.edges.size();
            std::vector<Index> nodes;
            for (Index n = editor.first_node(path); n != invalid_index; n = editor.node(n).next)
                nodes.push_back(n);
            const Index n = nodes[random() % nodes.size()];
            const Vec3 before = editor.position(n);
            const Index vertex = editor.make_vertex(n);
            EXPECT_EQ(editor.node(n).vertex, vertex);
            EXPECT_LT(norm(editor.position(n) - before), 1e-14);
            editor.halve(random() % (3 * editor.face_count()));
        }
        EXPECT_EQ(defects_of(hand.mesh, edited(hand.domain, editor)), "");
    }
}

TEST(CarrierEditor, halves_around_a_step_until_it_has_a_node)
{
    for (const HandDomain& hand : hands())
        for (Index path = 0; path < hand.domain.edges.size(); ++path) {
            CarrierEditor editor(hand.mesh, hand.domain.carrier, paths_of(hand.domain));
            const Index first = editor.first_node(path), second = editor.node(first).next;
            int halvings = 0;
            for (; editor.node(first).next == second && halvings < 20; ++halvings)
                editor.halve(editor.halfedge_to_halve(first));
            EXPECT_NE(editor.node(first).next, second);
            EXPECT_LE(halvings, 4);
        }
}

TEST(CarrierEditor, halves_an_edge_between_its_crossings)
{
    // One face pair, crossed by one path near the middle of its diagonal.
    const auto mesh =
        ManifoldMesh::build({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}});
    ASSERT_TRUE(mesh.ok());
    const Index diagonal = mesh->find_halfedge(2, 0);
    SurfacePath path;
    path.a = 1, path.b = 3;
    path.nodes.push_back({diagonal, invalid_index,
                          mesh->edge(diagonal) == diagonal ? 0.45 : 0.55}); // Leaves face 0.
    CarrierEditor editor(*mesh, CarrierMesh::from_source(*mesh), {path});
    const Index crossing = editor.node(editor.first_node(0)).next;
    const Vec3 before = editor.position(crossing);
    EXPECT_NEAR(before.x, 0.55, 1e-15);
    const Index vertex = editor.halve(diagonal);
    const CarrierMesh carrier = editor.carrier();
    // The wider gap is from the vertex at the origin to the crossing; the edge is cut in it, a
    // quarter of the gap from the crossing.
    EXPECT_NEAR(carrier.mesh.position(vertex).x, 0.75 * 0.55, 1e-15);
    EXPECT_LT(norm(editor.position(crossing) - before), 1e-15);
    // Of the two new edges, to the corners 1 and 3, where the path ends, it meets none.
    EXPECT_EQ(editor.paths(carrier.mesh)[0].nodes.size(), 1u);
    // From the crossing to a corner: a vertex on the path, which then runs along edges.
    editor.make_vertex(crossing);
    const CarrierMesh cut = editor.carrier();
    const SurfacePath run = editor.paths(cut.mesh)[0];
    ASSERT_EQ(run.nodes.size(), 1u);
    EXPECT_TRUE(run.nodes[0].is_vertex());
    EXPECT_NE(cut.mesh.find_halfedge(1, run.nodes[0].vertex), invalid_index);
    EXPECT_NE(cut.mesh.find_halfedge(run.nodes[0].vertex, 3), invalid_index);
}

} // namespace
} // namespace bot2nurbs
