// SPDX-License-Identifier: MIT
#include "layout/curves.h"
#include "layout/cut_mesh.h"

#include "layout/crease_fixtures.h"

#include <gtest/gtest.h>

#include <cmath>

namespace bot2nurbs::fixtures {
namespace {

TEST(Curves, of_a_cube_are_its_twelve_edges_between_eight_corners)
{
    const ManifoldMesh mesh = cube(4);
    const auto marks = mark_edges(mesh, crease_paths(mesh));
    const auto curves = trace_curves(mesh, marks, std::vector<char>(mesh.vertex_count(), 0));
    ASSERT_EQ(curves.size(), 12u);
    for (const Curve& c : curves) {
        EXPECT_EQ(c.vertices.size(), 5u);
        EXPECT_FALSE(c.closed());
        EXPECT_EQ(c.kind, FeatureKind::crease);
    }
}

TEST(Curves, of_an_open_cylinder_are_two_closed_ones)
{
    const ManifoldMesh mesh = open_cylinder(12, 4);
    const auto marks = mark_edges(mesh, {});
    std::vector<char> corners(mesh.vertex_count(), 0);
    const auto curves = trace_curves(mesh, marks, corners);
    ASSERT_EQ(curves.size(), 2u);
    for (const Curve& c : curves) {
        EXPECT_TRUE(c.closed());
        EXPECT_EQ(c.vertices.size(), 13u);
        EXPECT_EQ(c.kind, FeatureKind::boundary);
    }
    corners[curves[0].vertices[5]] = 1;
    const auto turned = trace_curves(mesh, marks, corners);
    EXPECT_EQ(turned[0].vertices.front(), curves[0].vertices[5]);
}

TEST(Curves, pieces_are_even_and_turn_by_a_right_angle_at_most)
{
    std::vector<Vec3> circle, line;
    for (int i = 0; i <= 40; ++i) {
        circle.push_back({std::cos(i * pi / 20.0), std::sin(i * pi / 20.0), 0.0});
        line.push_back({0.1 * i, 0.0, 0.0});
    }
    const std::vector<double> even(41, 1.0);
    EXPECT_EQ(divide_polyline(circle, even, 100.0, 1),
              (std::vector<std::size_t>{0, 10, 20, 30, 40}));
    EXPECT_EQ(divide_polyline(line, even, 100.0, 1), (std::vector<std::size_t>{0, 40}));
    EXPECT_EQ(divide_polyline(line, even, 1.0, 1), (std::vector<std::size_t>{0, 10, 20, 30, 40}));
    EXPECT_EQ(divide_polyline(line, even, 100.0, 3).size(), 4u);
    // Twice as dense in the second half: two thirds of the pieces are there.
    std::vector<double> denser(41, 1.0);
    std::fill(denser.begin() + 20, denser.end(), 2.0);
    EXPECT_EQ(divide_polyline(line, denser, 2.0, 1).size(), 4u);
    EXPECT_NEAR(static_cast<double>(divide_polyline(line, denser, 2.0, 1)[1]), 20.0, 1.0);
    // Never more pieces than edges.
    EXPECT_EQ(divide_polyline({line[0], line[1], line[2]}, {1, 1, 1}, 0.001, 9).size(), 3u);
}

TEST(CutMesh, of_a_cube_is_six_open_sides_with_the_same_faces)
{
    const ManifoldMesh mesh = cube(3);
    const CutMesh cut(mesh, mark_edges(mesh, crease_paths(mesh)));
    EXPECT_EQ(cut.mesh().face_count(), mesh.face_count());
    EXPECT_EQ(cut.mesh().vertex_count(), 6u * 16u);
    Index boundary = 0;
    for (Index h = 0; h < mesh.halfedge_count(); ++h) {
        EXPECT_EQ(cut.original(cut.mesh().from(h)), mesh.from(h));
        boundary += cut.mesh().twin(h) == invalid_index;
    }
    EXPECT_EQ(boundary, 6u * 12u);
}

TEST(CutMesh, opens_a_slit_between_its_ends)
{
    // Three edges along a line of a square: two inner vertices double, the ends do not.
    const ManifoldMesh mesh = square(5);
    const FeaturePath slit{FeatureKind::crease, straight_run(mesh, 3)};
    ASSERT_EQ(slit.vertices.size(), 4u);
    const CutMesh cut(mesh, mark_edges(mesh, {slit}));
    EXPECT_EQ(cut.mesh().vertex_count(), mesh.vertex_count() + 2);
    EXPECT_TRUE(cut.mesh().is_boundary_vertex(slit.vertices.front()));
}

TEST(CutMesh, without_marks_is_the_mesh)
{
    const ManifoldMesh mesh = icosphere(1);
    const CutMesh cut(mesh, mark_edges(mesh, {}));
    EXPECT_EQ(&cut.mesh(), &mesh);
}

} // namespace
} // namespace bot2nurbs::fixtures
