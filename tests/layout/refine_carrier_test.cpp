// SPDX-License-Identifier: MIT
#include "layout/refine_carrier.h"

#include "maps/patches.h"
#include "mesh_fixtures.h"

#include <gtest/gtest.h>

namespace bot2nurbs::fixtures {
namespace {

CarrierMesh refined(const ManifoldMesh& mesh, double limit, std::size_t most)
{
    return refine_carrier(mesh, {std::vector<double>(mesh.vertex_count(), limit),
                                 most,
                                 std::vector<char>(mesh.halfedge_count(), 0),
                                 {}})
        .carrier;
}

TEST(RefineCarrier, leaves_no_edge_longer_than_the_limit_and_the_surface_as_it_was)
{
    for (const auto& [name, mesh, genus] : closed_meshes()) {
        const double limit = 0.11 * mesh.box().diagonal();
        const CarrierMesh carrier = refined(mesh, limit, 1000000);
        const ManifoldMesh& fine = carrier.mesh;
        for (Index h = 0; h < fine.halfedge_count(); ++h)
            ASSERT_LE(norm(fine.position(fine.from(h)) - fine.position(fine.to(h))), limit) << name;
        EXPECT_NEAR(surface_area(fine), surface_area(mesh), 1e-12 * surface_area(mesh)) << name;
        EXPECT_TRUE(fine.closed());
        EXPECT_EQ(fine.genus(), genus);
        // Every corner of every face lies on the face's source face, at its provenance.
        for (Index v = 0; v < fine.vertex_count(); ++v)
            ASSERT_LT(norm(mesh.at(carrier.vertex_source[v]) - fine.position(v)), 1e-14);
        for (Index f = 0; f < fine.face_count(); ++f) {
            const Vec3 n = normalized(mesh.area_vector(carrier.face_source[f]));
            const Vec3 p = mesh.position(mesh.triangle(carrier.face_source[f])[0]);
            for (const Index v : fine.triangle(f))
                ASSERT_NEAR(dot(n, fine.position(v) - p), 0.0, 1e-13) << name;
            ASSERT_GT(dot(n, fine.area_vector(f)), 0.0);
        }
    }
}

TEST(RefineCarrier, of_a_fine_mesh_is_the_mesh_itself)
{
    const ManifoldMesh mesh = icosphere(2);
    const CarrierMesh carrier = refined(mesh, 10.0, 1000000);
    EXPECT_FALSE(carrier.refined);
    EXPECT_EQ(carrier.mesh.face_count(), mesh.face_count());
}

TEST(RefineCarrier, stops_at_the_number_of_splits_allowed)
{
    const ManifoldMesh mesh = octahedron();
    const CarrierMesh carrier = refined(mesh, 1e-3, 100);
    EXPECT_EQ(carrier.mesh.vertex_count(), mesh.vertex_count() + 100);
    EXPECT_EQ(carrier.mesh.genus(), 0);
}

TEST(RefineCarrier, marks_both_halves_of_a_marked_edge_and_nothing_else)
{
    const ManifoldMesh mesh = cube(2);
    std::vector<char> marks(mesh.halfedge_count(), 0);
    double length = 0.0;
    for (Index h = 0; h < mesh.halfedge_count(); ++h)
        if (dot(normalized(mesh.area_vector(h / 3)),
                normalized(mesh.area_vector(mesh.twin(h) / 3))) < 0.5) {
            marks[h] = 1;
            length += norm(mesh.position(mesh.to(h)) - mesh.position(mesh.from(h)));
        }
    const PlannedCarrier planned =
        refine_carrier(mesh, {std::vector<double>(mesh.vertex_count(), 0.07), 1000000, marks, {}});
    const ManifoldMesh& fine = planned.carrier.mesh;
    marks = planned.marks;
    ASSERT_EQ(marks.size(), fine.halfedge_count());
    double marked = 0.0;
    for (Index h = 0; h < fine.halfedge_count(); ++h) {
        EXPECT_EQ(marks[h], marks[fine.twin(h)]);
        const bool sharp = dot(normalized(fine.area_vector(h / 3)),
                               normalized(fine.area_vector(fine.twin(h) / 3))) < 0.5;
        EXPECT_EQ(marks[h] != 0, sharp);
        if (marks[h])
            marked += norm(fine.position(fine.to(h)) - fine.position(fine.from(h)));
    }
    EXPECT_NEAR(marked, length, 1e-12 * length);
}

TEST(RefineCarrier, makes_points_vertices_wherever_they_are)
{
    const ManifoldMesh mesh = icosphere(1);
    // Inside a face, twice in the same one, in an edge (and seen from the face across), at a
    // corner.
    const Index across = ManifoldMesh::face(mesh.twin(3 * 7));
    std::array<double, 3> there{};
    for (int k = 0; k < 3; ++k)
        for (const int j : {0, 1})
            if (mesh.triangle(across)[k] == mesh.triangle(7)[j])
                there[k] = j == 0 ? 0.25 : 0.75;
    const std::vector<SourcePoint> points{{4, {0.2, 0.3, 0.5}}, {4, {0.6, 0.3, 0.1}},
                                          {7, {0.5, 0.5, 0.0}}, {across, there},
                                          {9, {0.0, 1.0, 0.0}}, {7, {0.1, 0.1, 0.8}}};
    for (const double limit : {10.0, 0.1}) {
        const PlannedCarrier planned =
            refine_carrier(mesh, {std::vector<double>(mesh.vertex_count(), limit), 1000000,
                                  std::vector<char>(mesh.halfedge_count(), 0), points});
        const CarrierMesh& carrier = planned.carrier;
        ASSERT_EQ(planned.point_vertices.size(), points.size());
        for (std::size_t i = 0; i < points.size(); ++i) {
            ASSERT_NE(planned.point_vertices[i], invalid_index) << i;
            EXPECT_LT(norm(carrier.mesh.position(planned.point_vertices[i]) - mesh.at(points[i])),
                      1e-15)
                << i;
        }
        EXPECT_EQ(planned.point_vertices[4], mesh.triangle(9)[1]);
        EXPECT_EQ(carrier.mesh.genus(), 0);
        EXPECT_NEAR(surface_area(carrier.mesh), surface_area(mesh), 1e-12 * surface_area(mesh));
        for (Index f = 0; f < carrier.mesh.face_count(); ++f)
            ASSERT_GT(dot(carrier.mesh.area_vector(f), mesh.area_vector(carrier.face_source[f])),
                      0.0);
    }
}

} // namespace
} // namespace bot2nurbs::fixtures
