// SPDX-License-Identifier: MIT
#include "bot2nurbs/manifold_mesh.h"

#include "mesh_fixtures.h"

#include <gtest/gtest.h>

#include <set>

using namespace bot2nurbs;
namespace fx = bot2nurbs::fixtures;

TEST(ManifoldMesh, closed_fixtures_are_closed_outward_and_have_their_genus)
{
    for (const auto& [name, mesh, genus] : fx::closed_meshes()) {
        SCOPED_TRACE(name);
        EXPECT_TRUE(mesh.closed());
        EXPECT_EQ(mesh.genus(), genus);
        EXPECT_GT(mesh.volume(), 0.0);
        EXPECT_EQ(2 * mesh.edge_count(), mesh.halfedge_count());
    }
}

TEST(ManifoldMesh, volume_of_the_cube_is_8_also_far_from_the_origin)
{
    EXPECT_NEAR(fx::cube(3).volume(), 8.0, 1e-13);
    const ManifoldMesh far = fx::moved(fx::cube(3), [](const Vec3& p) {
        return p + Vec3{1e6, -2e6, 3e6};
    });
    EXPECT_NEAR(far.volume(), 8.0, 1e-8);
}

TEST(ManifoldMesh, twins_are_mutual_and_run_opposite_ways)
{
    for (const auto& list : {fx::closed_meshes(), fx::open_meshes()})
        for (const auto& [name, mesh, genus] : list) {
            SCOPED_TRACE(name);
            for (Index h = 0; h < mesh.halfedge_count(); ++h) {
                const Index t = mesh.twin(h);
                if (t == invalid_index)
                    continue;
                ASSERT_EQ(mesh.twin(t), h);
                ASSERT_EQ(mesh.from(t), mesh.to(h));
                ASSERT_EQ(mesh.to(t), mesh.from(h));
                ASSERT_EQ(mesh.edge(h), mesh.edge(t));
            }
        }
}

TEST(ManifoldMesh, turning_at_a_vertex_visits_every_face_there)
{
    for (const auto& list : {fx::closed_meshes(), fx::open_meshes()})
        for (const auto& [name, mesh, genus] : list) {
            SCOPED_TRACE(name);
            std::vector<std::set<Index>> expected(mesh.vertex_count());
            for (Index h = 0; h < mesh.halfedge_count(); ++h)
                expected[mesh.from(h)].insert(ManifoldMesh::face(h));
            for (Index v = 0; v < mesh.vertex_count(); ++v) {
                std::set<Index> seen;
                const Index start = mesh.halfedge_at(v);
                for (Index h = start; h != invalid_index;) {
                    ASSERT_EQ(mesh.from(h), v);
                    ASSERT_TRUE(seen.insert(ManifoldMesh::face(h)).second);
                    h = mesh.twin(ManifoldMesh::prev(h));
                    if (h == start)
                        break;
                }
                ASSERT_EQ(seen, expected[v]);
            }
        }
}

TEST(ManifoldMesh, find_halfedge_finds_all_and_only_existing_ones)
{
    for (const ManifoldMesh& mesh : {fx::octahedron(), fx::open_cylinder(5, 2), fx::square(2)}) {
        std::set<std::pair<Index, Index>> edges;
        for (Index h = 0; h < mesh.halfedge_count(); ++h)
            edges.insert({mesh.from(h), mesh.to(h)});
        for (Index a = 0; a < mesh.vertex_count(); ++a)
            for (Index b = 0; b < mesh.vertex_count(); ++b) {
                const Index h = mesh.find_halfedge(a, b);
                ASSERT_EQ(h != invalid_index, edges.count({a, b}) == 1);
                if (h != invalid_index) {
                    ASSERT_EQ(mesh.from(h), a);
                    ASSERT_EQ(mesh.to(h), b);
                }
            }
    }
}

TEST(ManifoldMesh, open_cylinder_has_two_rows_of_boundary_vertices)
{
    const ManifoldMesh mesh = fx::open_cylinder(7, 3);
    EXPECT_FALSE(mesh.closed());
    int boundary = 0;
    for (Index v = 0; v < mesh.vertex_count(); ++v)
        boundary += mesh.is_boundary_vertex(v);
    EXPECT_EQ(boundary, 14);
}

namespace {

ErrorCode build_error(const TriangleSoup& soup, Index* element = nullptr)
{
    const Result<ManifoldMesh> mesh = ManifoldMesh::build(soup.positions, soup.triangles);
    if (mesh)
        return ErrorCode::internal;
    if (element)
        *element = mesh.error().element;
    return mesh.error().code;
}

} // namespace

TEST(ManifoldMesh, build_refuses_each_broken_guarantee_and_names_the_element)
{
    const TriangleSoup good = fx::soup_of(fx::octahedron());
    Index element = 0;

    EXPECT_EQ(build_error({}), ErrorCode::empty_input);

    TriangleSoup soup = good;
    soup.triangles[3][1] = 6;
    EXPECT_EQ(build_error(soup, &element), ErrorCode::bad_geometry);
    EXPECT_EQ(element, 3u);

    soup = good;
    soup.positions[2].y = std::nan("");
    EXPECT_EQ(build_error(soup, &element), ErrorCode::bad_geometry);
    EXPECT_EQ(element, 2u);

    soup = good;
    soup.positions.push_back({5, 5, 5});
    EXPECT_EQ(build_error(soup, &element), ErrorCode::bad_geometry);
    EXPECT_EQ(element, 6u);

    soup = good;
    soup.triangles[5][1] = soup.triangles[5][0];
    EXPECT_EQ(build_error(soup, &element), ErrorCode::not_manifold);
    EXPECT_EQ(element, 5u);

    soup = good;
    std::swap(soup.triangles[4][0], soup.triangles[4][1]);
    EXPECT_EQ(build_error(soup), ErrorCode::not_manifold);

    soup = good;
    soup.triangles.push_back(soup.triangles[0]);
    EXPECT_EQ(build_error(soup), ErrorCode::not_manifold);

    // Two faces back to back are a closed surface in topology, but a repeated face.
    TriangleSoup pillow;
    pillow.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    pillow.triangles = {{0, 1, 2}, {0, 2, 1}};
    EXPECT_EQ(build_error(pillow), ErrorCode::not_manifold);

    // A fin: three faces on an edge.
    soup = good;
    soup.positions.push_back({2, 2, 2});
    soup.triangles.push_back({0, 2, 6});
    EXPECT_EQ(build_error(soup), ErrorCode::not_manifold);
}

TEST(ManifoldMesh, build_refuses_two_fans_at_a_vertex)
{
    // Two tetrahedra that share one vertex.
    TriangleSoup soup = fx::soup_of(fx::tetrahedron());
    soup = fx::joined(soup, fx::moved(soup, [](const Vec3& p) { return p + Vec3{4, 4, 4}; }));
    for (auto& t : soup.triangles)
        for (Index& v : t)
            v = v == 4 ? 0 : (v > 4 ? v - 1 : v);
    soup.positions.erase(soup.positions.begin() + 4);
    EXPECT_EQ(build_error(soup), ErrorCode::not_manifold);

    // Two open fans at one vertex.
    TriangleSoup bow;
    bow.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}};
    bow.triangles = {{0, 1, 2}, {0, 3, 4}};
    EXPECT_EQ(build_error(bow), ErrorCode::not_manifold);
}

TEST(MeshSignature, depends_on_every_coordinate_and_on_the_face_order)
{
    const ManifoldMesh mesh = fx::torus(8, 5);
    const std::string reference = signature(mesh);
    EXPECT_EQ(reference.size(), 16u);
    EXPECT_EQ(reference, signature(fx::torus(8, 5)));
    for (Index v : {Index{0}, Index{17}, mesh.vertex_count() - 1})
        for (int k = 0; k < 3; ++k) {
            std::vector<Vec3> positions = mesh.positions();
            positions[v][k] = std::nextafter(positions[v][k], 10.0);
            EXPECT_NE(signature(fx::must_build(positions, mesh.triangles())), reference);
        }
    std::vector<std::array<Index, 3>> triangles = mesh.triangles();
    std::swap(triangles.front(), triangles.back());
    EXPECT_NE(signature(fx::must_build(mesh.positions(), triangles)), reference);
}
