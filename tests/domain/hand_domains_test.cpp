// SPDX-License-Identifier: MIT
#include "hand_domains.h"

#include <cmath>
#include <gtest/gtest.h>
#include <map>

namespace bot2nurbs::test {
namespace {

std::map<Index, int> valences(const QuadComplex& complex)
{
    std::map<Index, int> count;
    for (Index v = 0; v < complex.vertex_count(); ++v)
        ++count[complex.valence(v)];
    return count;
}

TEST(HandDomains, sphere_cube_has_six_quads_times_four_per_level_and_eight_vertices_of_valence_3)
{
    for (int level = 0; level <= 2; ++level) {
        const HandDomain hand = sphere_cube(level, 8);
        EXPECT_EQ(hand.mesh.genus(), 0);
        EXPECT_EQ(hand.domain.complex.quad_count(), 6u << (2 * level));
        EXPECT_EQ(valences(hand.domain.complex)[3], 8);
        EXPECT_EQ(hand.domain.complex.extraordinary_count(), 8u);
        for (const Vec3& p : hand.mesh.positions())
            EXPECT_NEAR(norm(p), 1.0, 1e-15);
        // The inscribed polyhedron: less than the ball, and within a few percent of it.
        EXPECT_LT(hand.mesh.volume(), 4.0 / 3.0 * M_PI);
        EXPECT_GT(hand.mesh.volume(), 0.97 * 4.0 / 3.0 * M_PI);
    }
}

TEST(HandDomains, torus_grids_are_regular_and_turn_outward)
{
    for (const HandDomain& hand : {torus_grid(), torus_askew(2, 2), torus_askew(3, 1)}) {
        EXPECT_EQ(hand.mesh.genus(), 1);
        EXPECT_EQ(hand.domain.complex.euler_characteristic(), 0);
        EXPECT_EQ(hand.domain.complex.extraordinary_count(), 0u);
        const double volume = 2 * M_PI * M_PI * 0.4 * 0.4;
        EXPECT_NEAR(hand.mesh.volume(), volume, 0.1 * volume);
    }
    EXPECT_EQ(torus_askew(3, 1).domain.complex.quad_count(), 45u);
}

TEST(HandDomains, genus2_voxels_have_euler_characteristic_minus_2)
{
    for (int level = 0; level <= 1; ++level) {
        const HandDomain hand = genus2_voxels(level);
        EXPECT_EQ(hand.mesh.genus(), 2);
        EXPECT_EQ(hand.domain.complex.quad_count(), 50u << (2 * level));
        EXPECT_EQ(hand.domain.complex.euler_characteristic(), -2);
        auto count = valences(hand.domain.complex);
        EXPECT_EQ(count[3], 8);
        EXPECT_EQ(count[5], 16);
        EXPECT_GT(hand.mesh.volume(), 8.0);
        EXPECT_LT(hand.mesh.volume(), 13.0);
    }
}

TEST(HandDomains, open_cylinder_has_two_boundary_loops)
{
    const HandDomain hand = open_cylinder(5, 2);
    EXPECT_FALSE(hand.mesh.closed());
    EXPECT_EQ(hand.domain.complex.boundary_edge_count(), 10u);
    EXPECT_EQ(hand.domain.complex.euler_characteristic(), 0);
}

TEST(HandDomains, askew_edges_cross_mesh_edges_and_pass_through_mesh_vertices)
{
    const HandDomain hand = torus_askew(2, 2);
    int vertices = 0, crossings = 0;
    for (const DomainEdge& edge : hand.domain.edges)
        for (const PathPoint& p : edge.path) {
            ++(p.is_vertex() ? vertices : crossings);
            if (!p.is_vertex()) {
                EXPECT_GT(p.t, 0.0);
                EXPECT_LT(p.t, 1.0);
                EXPECT_NE(hand.mesh.find_halfedge(p.from, p.to), invalid_index);
            }
        }
    EXPECT_EQ(vertices, 40);
    EXPECT_GT(crossings, 100);
}

TEST(HandDomains, charts_cover_the_mesh_once)
{
    for (const HandDomain& hand :
         {sphere_cube(1, 8), torus_grid(), genus2_voxels(), open_cylinder()}) {
        std::vector<int> seen(hand.mesh.face_count(), 0);
        ASSERT_EQ(hand.charts.size(), hand.domain.complex.quad_count());
        for (const QuadChart& chart : hand.charts)
            for (std::size_t t = 0; t < chart.triangles.size(); ++t) {
                ++seen[chart.source_face[t]];
                for (int k = 0; k < 3; ++k)
                    EXPECT_EQ(hand.mesh.at({chart.source_face[t], chart.bary[t][k]}),
                              chart.vertices[chart.triangles[t][k]].position);
            }
        for (const int count : seen)
            ASSERT_EQ(count, 1);
    }
}

TEST(HandDomains, a_refined_carrier_keeps_volume_and_provenance)
{
    for (const HandDomain& hand : {sphere_cube(0, 4), torus_askew(2, 1)}) {
        const HandDomain refined = with_refined_carrier(hand);
        const CarrierMesh& carrier = refined.domain.carrier;
        EXPECT_GT(carrier.mesh.face_count(), hand.mesh.face_count());
        EXPECT_NEAR(carrier.mesh.volume(), hand.mesh.volume(), 1e-12);
        for (Index v = 0; v < carrier.mesh.vertex_count(); ++v)
            EXPECT_EQ(hand.mesh.at(carrier.vertex_source[v]), carrier.mesh.position(v));
    }
}

} // namespace
} // namespace bot2nurbs::test
