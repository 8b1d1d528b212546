// SPDX-License-Identifier: MIT
#include "maps/convex_map.h"

#include "core/predicates.h"
#include "maps/patches.h"
#include "mesh_fixtures.h"

#include <gtest/gtest.h>

#include <random>

namespace bot2nurbs::fixtures {
namespace {

// The disk of all faces that touch v, with the ring split into `sides` sides.
std::optional<Overlay> star_of(const ManifoldMesh& mesh, Index v, std::size_t sides)
{
    std::vector<Index> ring;
    Index h = mesh.halfedge_at(v);
    const Index first = h;
    do {
        ring.push_back(mesh.to(h));
        h = mesh.twin(ManifoldMesh::prev(h));
    } while (h != first);
    std::vector<SurfacePath> paths;
    for (std::size_t s = 0; s < sides; ++s) {
        std::vector<Index> side;
        for (std::size_t i = s * ring.size() / sides; i <= (s + 1) * ring.size() / sides; ++i)
            side.push_back(ring[i % ring.size()]);
        paths.push_back(edge_path(side));
    }
    std::vector<PathSide> border;
    for (const SurfacePath& p : paths)
        border.push_back({&p, false});
    return OverlayBuilder(mesh).disk(border);
}

// The n x n square patch of a mesh of a flat sheet folded into a box: border along mesh edges.
Overlay flat_square(int n)
{
    // An overlay made directly: a grid on the unit square, border first, counter-clockwise.
    Overlay overlay;
    std::vector<std::vector<Index>> id(n + 1, std::vector<Index>(n + 1, invalid_index));
    const auto add = [&](int i, int j) {
        Overlay::Vertex v;
        v.position = {static_cast<double>(i) / n, static_cast<double>(j) / n, 0.0};
        id[i][j] = static_cast<Index>(overlay.vertices.size());
        overlay.vertices.push_back(v);
    };
    for (int i = 0; i < n; ++i)
        add(i, 0);
    for (int j = 0; j < n; ++j)
        add(n, j);
    for (int i = n; i > 0; --i)
        add(i, n);
    for (int j = n; j > 0; --j)
        add(0, j);
    overlay.boundary_count = static_cast<Index>(overlay.vertices.size());
    for (Index s = 0; s < 4; ++s)
        overlay.corners.push_back(s * static_cast<Index>(n));
    for (int i = 1; i < n; ++i)
        for (int j = 1; j < n; ++j)
            add(i, j);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            overlay.triangles.push_back({id[i][j], id[i + 1][j], id[i + 1][j + 1]});
            overlay.triangles.push_back({id[i][j], id[i + 1][j + 1], id[i][j + 1]});
        }
    overlay.face.assign(overlay.triangles.size(), 0);
    overlay.find_opposites();
    return overlay;
}

TEST(ConvexMap, of_a_flat_square_has_the_least_energy_within_a_percent)
{
    Overlay overlay = flat_square(8);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> shift(-0.02, 0.02);
    for (std::size_t v = overlay.boundary_count; v < overlay.vertices.size(); ++v) {
        overlay.vertices[v].position.x += shift(random);
        overlay.vertices[v].position.y += shift(random);
    }
    const auto map = map_to_polygon(overlay, unit_square());
    ASSERT_TRUE(map);
    EXPECT_EQ(map->level, MapLevel::harmonic);
    // The identity is harmonic with energy one; only weights at their bounds disturb it.
    EXPECT_NEAR(measure_distortion(overlay, map->uv).dirichlet, 1.0, 1e-2);
}

TEST(ConvexMap, of_the_regular_grid_is_the_identity)
{
    const Overlay overlay = flat_square(7);
    const auto map = map_to_polygon(overlay, unit_square(), MapLevel::uniform);
    ASSERT_TRUE(map);
    for (std::size_t v = 0; v < overlay.vertices.size(); ++v) {
        EXPECT_NEAR(map->uv[v].x, overlay.vertices[v].position.x, 1e-14);
        EXPECT_NEAR(map->uv[v].y, overlay.vertices[v].position.y, 1e-14);
    }
}

TEST(ConvexMap, every_level_is_injective_on_every_star)
{
    for (const auto& [name, mesh, genus] : closed_meshes())
        for (Index v = 0; v < mesh.vertex_count(); v += 1 + mesh.vertex_count() / 50) {
            const auto overlay = star_of(mesh, v, 3);
            ASSERT_TRUE(overlay) << name << " vertex " << v;
            for (const MapLevel level : {MapLevel::harmonic, MapLevel::uniform, MapLevel::exact}) {
                const auto map = map_to_polygon(*overlay, regular_polygon(3), level);
                ASSERT_TRUE(map) << name << " vertex " << v;
                EXPECT_EQ(map->level, level);
                EXPECT_TRUE(is_injective(*overlay, map->uv));
            }
        }
}

TEST(ConvexMap, stays_injective_on_needles_a_million_times_longer_than_wide)
{
    Overlay overlay = flat_square(12);
    for (auto& v : overlay.vertices)
        v.position.y *= 1e-6;
    const auto map = map_to_polygon(overlay, unit_square());
    ASSERT_TRUE(map);
    EXPECT_TRUE(is_injective(overlay, map->uv));
}

// A tower of `rings` equal triangles on a triangular border: a map to the plane shrinks every ring
// by a factor, until doubles around the middle of the polygon cannot tell the last ones apart.
Overlay tower(Index rings)
{
    Overlay overlay;
    const auto corners = regular_polygon(3);
    for (Index r = 0; r <= rings; ++r)
        for (const Vec2& c : corners) {
            Overlay::Vertex v;
            v.position = {c.x, c.y, 1.7 * static_cast<double>(r)};
            overlay.vertices.push_back(v);
        }
    for (Index r = 0; r < rings; ++r)
        for (Index k = 0; k < 3; ++k) {
            const Index a = 3 * r + k, b = 3 * r + (k + 1) % 3;
            overlay.triangles.push_back({a, b, b + 3});
            overlay.triangles.push_back({a, b + 3, a + 3});
        }
    overlay.triangles.push_back({3 * rings, 3 * rings + 1, 3 * rings + 2});
    overlay.boundary_count = 3;
    overlay.corners = {0, 1, 2};
    overlay.face.assign(overlay.triangles.size(), 0);
    overlay.find_opposites();
    return overlay;
}

TEST(ConvexMap, of_flat_needles_is_as_flat_as_they_are)
{
    // Rows of a tenth of the height, again and again, down to lines. Bounded cotangents see rows
    // of one height and squeeze those that are higher; mean values reproduce the plane, but for the
    // least step of border points.
    constexpr int n = 48;
    Overlay overlay = flat_square(n);
    for (auto& v : overlay.vertices) {
        const double row = std::round(n * v.position.y);
        v.position.y = row > 0.0 ? std::pow(10.0, row - n) : 0.0;
    }
    const auto map = map_to_polygon(overlay, unit_square());
    ASSERT_TRUE(map);
    EXPECT_EQ(map->level, MapLevel::harmonic);
    for (Index v = 0; v < overlay.vertices.size(); ++v)
        EXPECT_LT(std::hypot(map->uv[v].x - overlay.vertices[v].position.x,
                             map->uv[v].y - overlay.vertices[v].position.y),
                  1e-4);
}

TEST(ConvexMap, of_a_tower_is_injective_down_to_triangles_of_1e_minus_30_or_refused)
{
    for (const Index rings : {5u, 20u, 35u}) {
        const Overlay overlay = tower(rings);
        for (const MapLevel level : {MapLevel::harmonic, MapLevel::uniform, MapLevel::exact}) {
            const auto map = map_to_polygon(overlay, regular_polygon(3), level);
            ASSERT_TRUE(map) << rings;
            EXPECT_TRUE(is_injective(overlay, map->uv));
        }
    }
    // Here the last rings are one point in doubles, whatever the arithmetic of the solve.
    EXPECT_FALSE(map_to_polygon(tower(80), regular_polygon(3)));
}

TEST(ConvexMap, of_a_tower_leaves_room_for_its_top)
{
    // Without, the stretch grows by a factor of more than a hundred every three rings.
    const std::pair<Index, double> most[] = {{5, 20.0}, {10, 200.0}, {20, 1e5}, {35, 1e9}};
    for (const auto& [rings, stretch] : most) {
        const Overlay overlay = tower(rings);
        const auto map = map_to_polygon(overlay, regular_polygon(3));
        const auto plain = map_to_polygon(overlay, regular_polygon(3), MapLevel::exact);
        ASSERT_TRUE(map && plain);
        EXPECT_LT(measure_distortion(overlay, map->uv).stretch, stretch) << rings;
        EXPECT_GT(measure_distortion(overlay, plain->uv).stretch, std::pow(10.0, 0.7 * rings));
    }
}

TEST(ConvexMap, a_folded_triangle_is_noticed)
{
    const Overlay overlay = flat_square(4);
    auto map = map_to_polygon(overlay, unit_square());
    ASSERT_TRUE(map);
    map->uv.back() = {0.0, 0.0};
    EXPECT_FALSE(is_injective(overlay, map->uv));
}

TEST(ConvexMap, sides_are_placed_by_arc_length_whichever_way_they_are_walked)
{
    const ManifoldMesh mesh = icosphere(2);
    const auto overlay = star_of(mesh, 0, 3);
    ASSERT_TRUE(overlay);
    const auto map = map_to_polygon(*overlay, regular_polygon(3));
    ASSERT_TRUE(map);
    const auto corners = regular_polygon(3);
    for (Index s = 0; s < 3; ++s)
        EXPECT_TRUE(map->uv[overlay->corners[s]] == corners[s]);
}

TEST(ConvexMap, border_points_on_one_place_are_mapped_apart)
{
    // As where a face has its three corners on a line, and its middle is that of an edge.
    Overlay overlay = flat_square(4);
    overlay.vertices[1].position = overlay.vertices[2].position;
    overlay.vertices[6].position = overlay.vertices[7].position;
    const auto map = map_to_polygon(overlay, unit_square());
    ASSERT_TRUE(map);
    EXPECT_TRUE(is_injective(overlay, map->uv));
    // A side without any length is divided evenly.
    for (Index v = 0; v <= 4; ++v)
        overlay.vertices[v].position = overlay.vertices[0].position;
    const auto without = map_to_polygon(overlay, unit_square());
    ASSERT_TRUE(without);
    EXPECT_TRUE(is_injective(overlay, without->uv));
}

TEST(ConvexMap, distortion_of_a_rectangle_is_the_mean_of_its_aspect_and_inverse)
{
    Overlay overlay = flat_square(6);
    for (auto& v : overlay.vertices)
        v.position.x *= 4.0;
    const auto map = map_to_polygon(overlay, unit_square(), MapLevel::uniform);
    ASSERT_TRUE(map);
    const MapDistortion d = measure_distortion(overlay, map->uv);
    EXPECT_NEAR(d.dirichlet, 0.5 * (4.0 + 0.25), 1e-12);
    EXPECT_NEAR(d.stretch, 0.5 * (4.0 + 0.25), 1e-12);
}

TEST(ConvexMap, a_triangle_on_three_points_of_a_line_does_not_decide_about_a_map)
{
    // The harmonic energy of a triangle with so little height is what it likes to be.
    const Overlay even = flat_square(6);
    const auto map = map_to_polygon(even, unit_square());
    ASSERT_TRUE(map);
    const double plain = measure_distortion(even, map->uv).combined();
    for (const double height : {1e-1, 1e-4, 1e-8, 1e-14, 0.0}) {
        Overlay overlay = even;
        const auto& t = overlay.triangles[overlay.triangles.size() / 2];
        const Vec3 a = even.vertices[t[1]].position, b = even.vertices[t[2]].position;
        const Vec3 foot = 0.5 * (a + b);
        overlay.vertices[t[0]].position = foot + height * (even.vertices[t[0]].position - foot);
        EXPECT_LT(measure_distortion(overlay, map->uv).combined(), 1.5 * plain) << height;
    }
}

TEST(ConvexMap, a_limb_squeezed_into_a_patch_shows_in_the_stretch)
{
    // A tower pulled out of the middle of a flat sheet.
    Overlay overlay = flat_square(9);
    const auto flat = map_to_polygon(overlay, unit_square());
    for (auto& v : overlay.vertices)
        if (std::fabs(v.position.x - 0.5) < 0.2 && std::fabs(v.position.y - 0.5) < 0.2)
            v.position.z = 3.0;
    const auto tower = map_to_polygon(overlay, unit_square());
    ASSERT_TRUE(flat && tower);
    EXPECT_GT(measure_distortion(overlay, tower->uv).stretch, 3.0);
    EXPECT_NEAR(measure_distortion(overlay, tower->uv).combined(),
                0.5 * (measure_distortion(overlay, tower->uv).dirichlet +
                       measure_distortion(overlay, tower->uv).stretch),
                1e-15);
}

} // namespace
} // namespace bot2nurbs::fixtures
