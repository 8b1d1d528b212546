// SPDX-License-Identifier: MIT
#include "mesh/triangulate_polygon.h"

#include "mesh_fixtures.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

using namespace bot2nurbs;

namespace {

using Triangles = std::vector<std::array<Index, 3>>;

PolygonList polygons(const std::vector<std::vector<Index>>& lists)
{
    PolygonList list;
    for (const auto& corners : lists) {
        list.corners.insert(list.corners.end(), corners.begin(), corners.end());
        list.close();
    }
    return list;
}

Triangles triangulated(const std::vector<Vec3>& positions, const PolygonList& list)
{
    Triangles triangles;
    PolygonTriangulator triangulator(positions, list);
    for (std::size_t p = 0; p < list.size(); ++p)
        triangulator.triangulate(p, triangles);
    return triangles;
}

PolygonList one_polygon(std::size_t n)
{
    PolygonList list;
    for (std::size_t i = 0; i < n; ++i)
        list.corners.push_back(static_cast<Index>(i));
    list.close();
    return list;
}

//! Checks that the triangles cover the plane polygon once: same turning, same total area.
void expect_cover(const std::vector<Vec3>& positions, const Triangles& triangles,
                  const Vec3& normal, double area)
{
    double sum = 0.0;
    for (const auto& t : triangles) {
        const double a = 0.5 * dot(normal, cross(positions[t[1]] - positions[t[0]],
                                                 positions[t[2]] - positions[t[0]]));
        EXPECT_GT(a, 0.0);
        sum += a;
    }
    EXPECT_NEAR(sum, area, 1e-12 * area);
}

Index edges_with_more_than_two_faces(const Triangles& triangles)
{
    std::map<std::pair<Index, Index>, int> faces;
    for (const auto& t : triangles)
        for (int k = 0; k < 3; ++k)
            ++faces[std::minmax(t[k], t[(k + 1) % 3])];
    Index count = 0;
    for (const auto& edge : faces)
        count += edge.second > 2;
    return count;
}

} // namespace

TEST(TriangulatePolygon, a_quad_with_a_reflex_corner_is_cut_there)
{
    // An arrowhead: only the diagonal 1-3 stays inside.
    const std::vector<Vec3> positions{{0, 0, 0}, {0.2, 0.2, 0}, {1, 0, 0}, {0, 1, 0}};
    for (Index shift = 0; shift < 4; ++shift) {
        const PolygonList list =
            polygons({{shift % 4, (shift + 1) % 4, (shift + 2) % 4, (shift + 3) % 4}});
        const Triangles triangles = triangulated(positions, list);
        ASSERT_EQ(triangles.size(), 2u);
        expect_cover(positions, triangles, {0, 0, 1}, 0.4);
    }
}

TEST(TriangulatePolygon, stars_of_any_size_and_plane_are_covered_once)
{
    std::mt19937 random(1);
    std::uniform_real_distribution<double> radius(0.2, 1.0);
    for (const std::size_t n : {5u, 8u, 20u, 64u, 65u, 300u}) {
        const Vec3 u = normalized({1, 2, -1}), v = normalized(cross({0.3, 1, 2}, u));
        std::vector<Vec3> positions;
        double area = 0.0, last = 0.0, first = 0.0;
        for (std::size_t i = 0; i < n; ++i) {
            const double a = 2.0 * fixtures::pi * static_cast<double>(i) / static_cast<double>(n);
            const double r = radius(random);
            positions.push_back(r * std::cos(a) * u + r * std::sin(a) * v);
            area += i > 0 ? r * last : 0.0;
            first = i == 0 ? r : first;
            last = r;
        }
        area = 0.5 * std::sin(2.0 * fixtures::pi / static_cast<double>(n)) * (area + last * first);
        const Triangles triangles = triangulated(positions, one_polygon(n));
        ASSERT_EQ(triangles.size(), n - 2);
        expect_cover(positions, triangles, cross(u, v), area);
    }
}

TEST(TriangulatePolygon, a_large_convex_polygon_is_covered_in_linear_time)
{
    const std::size_t n = 100000;
    std::vector<Vec3> positions;
    for (std::size_t i = 0; i < n; ++i) {
        const double a = 2.0 * fixtures::pi * static_cast<double>(i) / static_cast<double>(n);
        positions.push_back({0.0, std::cos(a), std::sin(a)});
    }
    const Triangles triangles = triangulated(positions, one_polygon(n));
    ASSERT_EQ(triangles.size(), n - 2);
    double area = 0.0;
    for (const auto& t : triangles)
        area += 0.5 * cross(positions[t[1]] - positions[t[0]], positions[t[2]] - positions[t[0]]).x;
    EXPECT_NEAR(area, fixtures::pi, 1e-6);
}

TEST(TriangulatePolygon, quads_that_share_two_sides_do_not_share_a_diagonal)
{
    // Vertex 4 has two quads only; both would be cut from 0 to 2.
    const std::vector<Vec3> positions{{0, 0, 0}, {1, -3, 0}, {2, 0, 0}, {1, 3, 0}, {1, 0.01, 0}};
    const Triangles triangles = triangulated(positions, polygons({{0, 1, 2, 4}, {0, 4, 2, 3}}));
    ASSERT_EQ(triangles.size(), 4u);
    EXPECT_EQ(edges_with_more_than_two_faces(triangles), 0u);
}

TEST(TriangulatePolygon, repeated_corners_count_once)
{
    const std::vector<Vec3> positions{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    EXPECT_EQ(triangulated(positions, polygons({{0, 1, 1, 2, 2, 3, 0}})).size(), 2u);
    EXPECT_EQ(triangulated(positions, polygons({{0, 1, 1, 0}})).size(), 0u);
    EXPECT_EQ(triangulated(positions, polygons({{0, 1}})).size(), 0u);
}

TEST(TriangulatePolygon, a_crossed_polygon_still_gets_all_its_triangles)
{
    std::vector<Vec3> positions;
    for (int i = 0; i < 5; ++i) {
        const double a = 2.0 * fixtures::pi * (2 * i % 5) / 5;
        positions.push_back({std::cos(a), std::sin(a), 0});
    }
    EXPECT_EQ(triangulated(positions, one_polygon(5)).size(), 3u);
    for (Vec3& p : positions)
        p.y = 0.0; // and one without any plane
    EXPECT_EQ(triangulated(positions, one_polygon(5)).size(), 3u);
}
