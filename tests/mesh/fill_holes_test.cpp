// SPDX-License-Identifier: MIT
#include "bot2nurbs/fill_holes.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace bot2nurbs::test {
namespace {

// A prism over a regular polygon, open at the top, with a mean radius of one and a height of two.
TriangleSoup cup(Index sides, bool bottom)
{
    TriangleSoup soup;
    for (const double z : {0.0, 2.0})
        for (Index i = 0; i < sides; ++i) {
            const double t = 2.0 * M_PI * i / sides;
            soup.positions.push_back({std::cos(t), std::sin(t), z});
        }
    for (Index i = 0; i < sides; ++i) {
        const Index j = (i + 1) % sides;
        soup.triangles.push_back({i, j, sides + j});
        soup.triangles.push_back({i, sides + j, sides + i});
        if (bottom && i > 0 && i + 1 < sides)
            soup.triangles.push_back({0, i + 1, i});
    }
    for (Index f = 0; f < soup.triangles.size(); ++f)
        soup.source_face.push_back(f);
    return soup;
}

double prism_volume(Index sides)
{
    return sides * std::sin(2.0 * M_PI / sides);
}

RepairedMesh repaired(TriangleSoup soup)
{
    Context context;
    Result<RepairedMesh> mesh = repair_mesh(std::move(soup), {}, context);
    EXPECT_TRUE(mesh.ok());
    return std::move(*mesh);
}

TEST(FillHoles, of_a_plane_loop_closes_the_solid_and_adds_no_vertex)
{
    for (const Index sides : {3u, 4u, 7u, 40u}) {
        RepairedMesh mesh = repaired(cup(sides, true));
        ASSERT_EQ(mesh.components[0].boundary_loops, 1u);
        ASSERT_FALSE(fill_holes(mesh, 10.0, Context()));
        const MeshComponent& c = mesh.components[0];
        EXPECT_EQ(c.boundary_loops, 0u);
        EXPECT_EQ(c.mesh.vertex_count(), 2 * sides);
        EXPECT_EQ(c.mesh.face_count(), 4 * sides - 4);
        EXPECT_NEAR(c.volume, prism_volume(sides), 1e-12);
        ASSERT_FALSE(mesh.notes.empty());
        EXPECT_EQ(mesh.notes.back().code, "hole_filled");
        EXPECT_NE(mesh.notes.back().message.find("vertex " + std::to_string(sides)),
                  std::string::npos);
    }
}

TEST(FillHoles, leaves_holes_that_are_larger_than_asked_and_says_so)
{
    RepairedMesh mesh = repaired(cup(8, false));
    ASSERT_EQ(mesh.components[0].boundary_loops, 2u);
    ASSERT_FALSE(fill_holes(mesh, 1.9, Context()));
    EXPECT_EQ(mesh.components[0].boundary_loops, 2u);
    EXPECT_EQ(mesh.notes.back().code, "hole_left");
    EXPECT_EQ(mesh.notes.back().count, 2u);
    EXPECT_TRUE(mesh.notes.back().warning);
}

TEST(FillHoles, of_an_inside_out_surface_leaves_a_solid_turned_outward)
{
    TriangleSoup soup = cup(6, true);
    for (auto& t : soup.triangles)
        std::swap(t[0], t[1]);
    RepairedMesh mesh = repaired(std::move(soup));
    ASSERT_FALSE(fill_holes(mesh, 10.0, Context()));
    EXPECT_NEAR(mesh.components[0].volume, prism_volume(6), 1e-12);
}

TEST(FillHoles, takes_no_diagonal_that_is_an_edge_of_the_mesh)
{
    // Two faces of a tetrahedron.
    TriangleSoup soup;
    soup.positions = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
    soup.triangles = {{0, 1, 2}, {0, 2, 3}};
    soup.source_face = {0, 1};
    RepairedMesh mesh = repaired(std::move(soup));
    ASSERT_FALSE(fill_holes(mesh, 10.0, Context()));
    const ManifoldMesh& filled = mesh.components[0].mesh;
    // The diagonal 0 2 is taken, the diagonal 1 3 is not.
    EXPECT_EQ(mesh.components[0].boundary_loops, 0u);
    EXPECT_EQ(filled.vertex_count(), 4u);
    EXPECT_NE(filled.find_halfedge(1, 3), invalid_index);
}

TEST(FillHoles, of_many_edges_is_a_fan_around_a_new_vertex)
{
    const Index sides = 600;
    RepairedMesh mesh = repaired(cup(sides, true));
    ASSERT_FALSE(fill_holes(mesh, 10.0, Context()));
    const MeshComponent& c = mesh.components[0];
    EXPECT_EQ(c.mesh.vertex_count(), 2 * sides + 1);
    EXPECT_EQ(c.source_vertex.back(), invalid_index);
    EXPECT_EQ(c.source_face.back(), invalid_index);
    EXPECT_NEAR(c.volume, prism_volume(sides), 1e-10);
}

TEST(FillHoles, of_a_size_that_is_no_length_is_refused)
{
    RepairedMesh mesh = repaired(cup(4, true));
    for (const double size : {-1.0, std::nan(""), HUGE_VAL}) {
        const Status failed = fill_holes(mesh, size, Context());
        ASSERT_TRUE(failed);
        EXPECT_EQ(failed->code, ErrorCode::bad_option);
    }
}

TEST(FillHoles, of_a_flat_surface_says_that_nothing_is_enclosed)
{
    TriangleSoup soup;
    soup.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    soup.triangles = {{0, 1, 2}, {0, 2, 3}};
    soup.source_face = {0, 1};
    RepairedMesh mesh = repaired(soup);
    ASSERT_FALSE(fill_holes(mesh, 2.0, Context()));
    EXPECT_EQ(mesh.components[0].boundary_loops, 0u);
    EXPECT_TRUE(std::any_of(mesh.notes.begin(), mesh.notes.end(), [](const RepairNote& n) {
        return n.code == "no_volume" && n.count == 1 && n.warning;
    }));
}

TEST(FillHoles, makes_a_cavity_of_an_open_shell_inside_another_that_turns_inward)
{
    for (const bool inward : {true, false}) {
        TriangleSoup soup = cup(8, false);
        const Index first = static_cast<Index>(soup.positions.size());
        const TriangleSoup inner = cup(8, false);
        for (const Vec3& p : inner.positions)
            soup.positions.push_back(0.5 * p + Vec3{0, 0, 0.5});
        for (std::array<Index, 3> t : inner.triangles) {
            if (inward)
                std::swap(t[1], t[2]);
            soup.triangles.push_back({first + t[0], first + t[1], first + t[2]});
            soup.source_face.push_back(static_cast<Index>(soup.source_face.size()));
        }
        RepairedMesh mesh = repaired(soup);
        ASSERT_FALSE(fill_holes(mesh, 10.0, Context()));
        ASSERT_EQ(mesh.components.size(), 2u);
        EXPECT_EQ(mesh.components[1].surrounded_by, 0u);
        EXPECT_EQ(mesh.components[1].cavity, inward);
        EXPECT_NEAR(mesh.components[1].volume, (inward ? -1 : 1) * prism_volume(8) / 8, 1e-12);
    }
}

} // namespace
} // namespace bot2nurbs::test
