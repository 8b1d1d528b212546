// SPDX-License-Identifier: MIT
#include "bot2nurbs/cage_surface.h"

#include "bot2nurbs/validate_domain.h"
#include "layout/catmull_clark.h"
#include "layout/quad_fixtures.h"

#include <gtest/gtest.h>

#include <random>

namespace bot2nurbs::fixtures {
namespace {

SubdividedQuads subdivided(const QuadMesh& mesh)
{
    Result<QuadComplex> complex =
        QuadComplex::build(static_cast<Index>(mesh.positions.size()), mesh.quads);
    if (!complex)
        std::abort();
    return {std::move(*complex), mesh.positions};
}

QuadMesh shaken(QuadMesh quads, double amount)
{
    std::mt19937 random(7);
    std::uniform_real_distribution<double> push(-amount, amount);
    for (Vec3& p : quads.positions) {
        const double x = push(random), y = push(random), z = push(random);
        p += Vec3{x, y, z};
    }
    return quads;
}

// Valences 3, 4 and 5, closed and open.
std::vector<QuadMesh> cages()
{
    return {shaken(quads_of_pairs(cube(1)), 0.2), shaken(quads_of_pairs(torus(5, 4)), 0.1),
            shaken(quads_of_pairs(square(4)), 0.05), shaken(quads_of_pairs(genus_two(0)), 0.1),
            shaken(quads_of_pairs(open_cylinder(5, 2)), 0.1)};
}

TEST(CatmullClark, refining_moves_no_limit_point)
{
    for (const QuadMesh& cage : cages()) {
        const SubdividedQuads coarse = subdivided(cage);
        const auto fine = coarse.refined();
        ASSERT_TRUE(fine);
        const std::vector<Vec3> before = coarse.limit(), after = fine->limit();
        for (std::size_t v = 0; v < before.size(); ++v)
            EXPECT_LT(norm(before[v] - after[v]), 1e-13);
    }
}

TEST(CatmullClark, refined_vertices_go_to_their_limits)
{
    for (const QuadMesh& cage : cages()) {
        SubdividedQuads quads = subdivided(cage);
        const std::vector<Vec3> limit = quads.limit();
        for (int i = 0; i < 5; ++i) {
            auto fine = quads.refined();
            ASSERT_TRUE(fine);
            quads = std::move(*fine);
        }
        for (std::size_t v = 0; v < limit.size(); ++v)
            EXPECT_LT(norm(quads.positions[v] - limit[v]), 5e-3);
    }
}

TEST(CatmullClark, is_the_bicubic_b_spline_on_a_regular_grid)
{
    const QuadMesh grid = shaken(quads_of_pairs(square(6)), 0.05);
    const SubdividedQuads quads = subdivided(grid);
    const std::vector<Vec3> limit = quads.limit();
    const double b[3] = {1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0};
    for (Index v = 0; v < limit.size(); ++v) {
        // Vertices are renumbered: by their place in the grid.
        const Index i = grid.source_vertex[v] / 7, j = grid.source_vertex[v] % 7;
        if (i == 0 || i == 6 || j == 0 || j == 6)
            continue;
        Vec3 expected;
        for (Index w = 0; w < limit.size(); ++w) {
            const int di = static_cast<int>(grid.source_vertex[w] / 7) - static_cast<int>(i);
            const int dj = static_cast<int>(grid.source_vertex[w] % 7) - static_cast<int>(j);
            if (std::abs(di) <= 1 && std::abs(dj) <= 1)
                expected += b[di + 1] * b[dj + 1] * grid.positions[w];
        }
        EXPECT_LT(norm(limit[v] - expected), 1e-14);
    }
}

TEST(CatmullClark, children_of_a_halfedge_lie_end_to_end)
{
    const SubdividedQuads coarse = subdivided(quads_of_pairs(cube(2)));
    const auto fine = coarse.refined();
    ASSERT_TRUE(fine);
    for (Index h = 0; h < coarse.complex.halfedge_count(); ++h) {
        const auto [first, second] = refined_halfedge(h);
        EXPECT_EQ(fine->complex.from(first), coarse.complex.from(h));
        EXPECT_EQ(fine->complex.to(first), fine->complex.from(second));
        EXPECT_EQ(fine->complex.to(second), coarse.complex.to(h));
    }
}

TEST(CageSurface, is_a_valid_domain_with_the_numbers_of_the_cage)
{
    for (const QuadMesh& cage : cages()) {
        Context context;
        const auto surface = cage_surface(cage, context);
        ASSERT_TRUE(surface) << surface.error().message;
        const auto found = validate_domain(surface->mesh, surface->domain, context);
        ASSERT_TRUE(found);
        EXPECT_TRUE(found->valid()) << (found->defects.empty() ? "" : found->defects[0].message);
        EXPECT_EQ(surface->domain.complex.quads(), cage.quads);
        const std::vector<Vec3> limit = subdivided(cage).limit();
        for (std::size_t v = 0; v < limit.size(); ++v)
            EXPECT_LT(norm(surface->mesh.position(surface->domain.vertices[v]) - limit[v]), 1e-13);
        for (Index f = 0; f < surface->mesh.face_count(); ++f)
            ASSERT_LT(surface->quad_of_face[f], cage.quads.size());
    }
}

TEST(CageSurface, of_a_cube_has_its_corners_halfway_and_faces_at_known_heights)
{
    Context context;
    const auto surface = cage_surface(quads_of_pairs(cube(1)), context);
    ASSERT_TRUE(surface);
    // (9 v + 4 sum of neighbours + sum of opposite corners) / 24.
    for (Index v = 0; v < 8; ++v)
        for (const double x : {surface->mesh.position(v).x, surface->mesh.position(v).y,
                               surface->mesh.position(v).z})
            EXPECT_NEAR(std::fabs(x), 0.5, 1e-14);
    EXPECT_EQ(surface->mesh.face_count(), 2u * 6u << 10);
}

TEST(CageSurface, keeps_a_plane_and_its_corners)
{
    Context context;
    const auto surface = cage_surface(quads_of_pairs(square(2)), context);
    ASSERT_TRUE(surface);
    EXPECT_EQ(surface->mesh.box().min.x, 0.0);
    EXPECT_EQ(surface->mesh.box().max.y, 1.0);
    EXPECT_EQ(surface->mesh.box().max.z, 0.0);
}

TEST(CageSurface, refuses_a_vertex_with_two_quads_and_a_cage_without_extent)
{
    Context context;
    const auto pillow = split_quads(
        polygons({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0, 0, 1}, {0, 0, -1}},
                 {{0, 1, 4, 3}, {1, 2, 3, 4}, {0, 3, 5, 1}, {1, 5, 3, 2}}));
    ASSERT_TRUE(pillow) << pillow.error().message;
    const auto refused = cage_surface(pillow->front(), context);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::invalid_domain);

    const QuadMesh point = moved(quads_of_pairs(cube(1)), [](const Vec3&) { return Vec3(); });
    const auto empty = cage_surface(point, context);
    ASSERT_FALSE(empty);
    EXPECT_EQ(empty.error().code, ErrorCode::bad_geometry);
}

} // namespace
} // namespace bot2nurbs::fixtures
