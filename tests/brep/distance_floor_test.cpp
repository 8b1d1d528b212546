// SPDX-License-Identifier: MIT
#include "brep/distance_floor.h"

#include "hausdorff_fixtures.h"

#include <gtest/gtest.h>

namespace bot2nurbs {
namespace {

using fixtures::Domain;

struct Scene {
    Domain domain;
    SplineSurface surface;
    ManifoldMesh mesh;
    PlacedMesh placed;
    BezierPieces pieces;
    ClosestPoint tree;
    DistanceFloor floor;

    Scene(const Domain& d, const SplineSurface& s, const ManifoldMesh& m)
        : domain(d), surface(s), mesh(m), placed(mesh, mesh.positions()),
          pieces(domain.complex, surface, {}), tree(mesh), floor(placed, tree, pieces)
    {
    }
};

std::vector<Vec3> some_points(int count, double size)
{
    std::mt19937 random(7);
    std::uniform_real_distribution<double> number(-size, size);
    std::vector<Vec3> out;
    for (int i = 0; i < count; ++i)
        out.push_back({number(random), number(random), number(random)});
    return out;
}

TEST(DistanceFloor, to_a_surface_is_the_distance_up_to_the_share_and_never_above_it)
{
    const Domain d = fixtures::sphere_cube(0);
    const Scene scene(d, fixtures::wavy_sphere(d, 1, 0.15), fixtures::icosphere(1));
    for (const Vec3& p : some_points(60, 1.5)) {
        const double true_distance = fixtures::distance_to_surface(scene.surface, p);
        for (const double share : {0.1, 1e-3, 1e-6}) {
            const SurfaceDistance found = scene.floor.to_surface(p, true_distance, share);
            EXPECT_LE(found.floor, true_distance * (1 + 1e-12));
            EXPECT_GE(found.floor, true_distance * (1 - 2 * share - 1e-9)) << share;
        }
    }
}

TEST(DistanceFloor, notices_a_nearer_place_than_the_one_that_was_found)
{
    const Domain d = fixtures::sphere_cube(1);
    const Scene scene(d, fixtures::wavy_sphere(d, 2, 0.05), fixtures::icosphere(1));
    for (const Vec3& p : some_points(40, 1.2)) {
        const double true_distance = fixtures::distance_to_surface(scene.surface, p);
        // As if a search had ended on the far side.
        const SurfaceDistance found = scene.floor.to_surface(p, 1.0 + norm(p), 1e-3);
        ASSERT_NE(found.piece, invalid_index);
        EXPECT_NEAR(found.distance, true_distance, 2e-3 * true_distance);
        EXPECT_LE(found.floor, true_distance);
        // Nothing is nearer than the nearest.
        EXPECT_EQ(scene.floor.to_surface(p, true_distance * (1 - 1e-6), 1e-2).piece, invalid_index);
    }
}

TEST(DistanceFloor, says_where_on_the_piece_the_nearer_place_is)
{
    // Folded pieces: a search from the middle of the piece may end on another sheet.
    std::mt19937 random(3);
    const Domain d = fixtures::disk_grid(1, 1);
    SplineSurface surface = fixtures::flat_patches(d);
    std::uniform_real_distribution<double> shift(-0.5, 0.5);
    for (Vec3& c : surface.bezier())
        c += Vec3{shift(random), shift(random), shift(random)};
    const Scene scene(d, surface, fixtures::icosphere(1));
    int other_sheet = 0;
    for (const Vec3& p : some_points(100, 1.0)) {
        const SurfaceDistance found = scene.floor.to_surface(p, 10.0, 1e-3);
        ASSERT_NE(found.piece, invalid_index);
        const BezierView piece = scene.pieces.view(found.piece);
        EXPECT_NEAR(norm(p - piece.position(found.at)), found.distance, 1e-12);
        other_sheet += norm(p - foot_on_piece(piece, p).position) > 1.02 * found.distance;
    }
    EXPECT_GE(other_sheet, 5);
}

TEST(DistanceFloor, of_the_centre_of_a_sphere_is_its_radius_although_all_of_it_is_as_near)
{
    const Domain d = fixtures::sphere_cube(1);
    const SplineSurface sphere = fixtures::network_surface(d, fixtures::to_unit_sphere);
    const Scene scene(d, sphere, fixtures::icosphere(3));
    double nearest = INFINITY;
    for (Index q = 0; q < sphere.patch_count(); ++q)
        for (const Vec3& p : fixtures::patch_grid(sphere, q, 40))
            nearest = std::min(nearest, norm(p));
    const SurfaceDistance found = scene.floor.to_surface({}, nearest, 1e-3);
    EXPECT_LE(found.floor, nearest);
    EXPECT_GE(found.floor, nearest * (1 - 2e-3));
}

TEST(DistanceFloor, to_a_mesh_is_the_distance_and_never_above_it)
{
    const Domain d = fixtures::sphere_cube(0);
    const Scene scene(d, fixtures::flat_patches(d), fixtures::genus_two());
    for (const Vec3& p : some_points(300, 3.0)) {
        const double found = scene.tree.query(p).distance;
        const double floor = scene.floor.to_mesh(p, found);
        EXPECT_LE(floor, found);
        EXPECT_NEAR(floor, found, 1e-13);
        // Another point than the closest one does not mislead it.
        EXPECT_NEAR(scene.floor.to_mesh(p, 2.0 * found), found, 1e-13);
    }
}

TEST(DistanceFloor, of_a_point_on_the_other_side_is_zero)
{
    const Domain d = fixtures::disk_grid(1, 1);
    const Scene scene(d, fixtures::flat_patches(d), fixtures::square(3));
    EXPECT_EQ(scene.floor.to_mesh({0.4, 0.3, 0.0}, 0.0), 0.0);
    EXPECT_EQ(scene.floor.to_surface({0.4, 0.3, 0.0}, 0.0, 1e-3).floor, 0.0);
}

} // namespace
} // namespace bot2nurbs
