// SPDX-License-Identifier: MIT
#include "brep/cover_targets.h"

#include "hausdorff_fixtures.h"

#include <gtest/gtest.h>

namespace bot2nurbs {
namespace {

using fixtures::Domain;

CoverVertex at(double x, double y)
{
    CoverVertex v;
    v.at = {x, y};
    return v;
}

CoverVertex between(const CoverVertex& a, const CoverVertex& b, double t)
{
    return at(a.at.x + t * (b.at.x - a.at.x), a.at.y + t * (b.at.y - a.at.y));
}

//! Of a convex counter-clockwise polygon, with its border.
bool contains(const CoverPolygon& polygon, const Vec2& p)
{
    for (int i = 0; i < polygon.size; ++i) {
        const Vec2 &a = polygon.vertex[i].at, &b = polygon.vertex[(i + 1) % polygon.size].at;
        if (cross(b - a, p - a) < -1e-12)
            return false;
    }
    return polygon.size > 2;
}

TEST(CoverSplit, parts_cover_the_polygon_whatever_the_signs)
{
    std::mt19937 random(1);
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    for (int n = 0; n < 500; ++n) {
        CoverPolygon polygon;
        const int corners = 3 + n % 6;
        for (int i = 0; i < corners; ++i)
            polygon.add(at(std::cos(2 * M_PI * i / corners), std::sin(2 * M_PI * i / corners)));
        std::array<double, CoverPolygon::capacity> excess{};
        for (int i = 0; i < corners; ++i)
            excess[i] = number(random);
        CoverPolygon inside, outside;
        ASSERT_TRUE(split(polygon, excess, between, inside, outside));
        for (int k = 0; k < 200; ++k) {
            const Vec2 p{number(random), number(random)};
            EXPECT_TRUE(!contains(polygon, p) || contains(inside, p) || contains(outside, p)) << n;
        }
    }
}

TEST(CoverSplit, refuses_what_would_have_too_many_corners)
{
    CoverPolygon full;
    std::array<double, CoverPolygon::capacity> excess;
    for (int i = 0; i < CoverPolygon::capacity; ++i) {
        full.add(at(std::cos(i * M_PI / 6), std::sin(i * M_PI / 6)));
        excess[i] = i == 3 ? 1.0 : -1.0;
    }
    CoverPolygon inside, outside;
    EXPECT_FALSE(split(full, excess, between, inside, outside));
}

//! A surface whose pieces are all alike, and one triangle.
struct PieceAndTriangle {
    Domain domain = fixtures::disk_grid(1, 1);
    SplineSurface surface;
    ManifoldMesh mesh;
    PlacedMesh placed;
    BezierPieces pieces;

    PieceAndTriangle(const std::vector<Vec3>& control, const std::vector<Vec3>& corners)
        : surface(fixtures::surface_of_points(
              1, [&](Index, Index i, Index j) { return control[4 * (i % 4) + j % 4]; })),
          mesh(fixtures::must_build(corners, {{0, 1, 2}})), placed(mesh, mesh.positions()),
          pieces(domain.complex, surface, {})
    {
    }

    PieceAndTriangle(const PieceAndTriangle&) = delete;
    PieceAndTriangle& operator=(const PieceAndTriangle&) = delete;

    double from_triangle(const Vec3& p) const
    {
        const TriangleCorners t = placed.corners(0);
        return norm(p - t.at(closest_on_triangle(p, t)));
    }
    //! By a search that knows no derivatives, from the nearest points of a grid.
    double from_piece(const Vec3& p) const
    {
        std::vector<std::pair<double, Vec2>> starts;
        for (int i = 0; i <= 12; ++i)
            for (int j = 0; j <= 12; ++j) {
                const Vec2 w{i / 12.0, j / 12.0};
                starts.emplace_back(norm(p - pieces.position(0, w)), w);
            }
        std::partial_sort(starts.begin(), starts.begin() + 4, starts.end(),
                          [](const auto& a, const auto& b) { return a.first < b.first; });
        double best = INFINITY;
        for (int k = 0; k < 4; ++k) {
            auto [distance, w] = starts[k];
            for (double step = 0.1; step > 1e-7;) {
                bool moved = false;
                for (const Vec2 d : {Vec2{step, 0}, {-step, 0}, {0, step}, {0, -step}}) {
                    const Vec2 v{std::clamp(w.x + d.x, 0.0, 1.0), std::clamp(w.y + d.y, 0.0, 1.0)};
                    const double there = norm(p - pieces.position(0, v));
                    if (there < distance) {
                        distance = there;
                        w = v;
                        moved = true;
                    }
                }
                step *= moved ? 1.0 : 0.5;
            }
            best = std::min(best, distance);
        }
        return best;
    }
};

std::vector<Vec3> random_triangle(std::mt19937& random)
{
    std::uniform_real_distribution<double> x(-0.2, 1.2), z(-0.3, 0.3);
    for (;;) {
        std::vector<Vec3> p;
        for (int k = 0; k < 3; ++k)
            p.push_back({x(random), x(random), z(random)});
        if (cross(p[1] - p[0], p[2] - p[0]).z > 0.1)
            return p;
    }
}

//! A random convex polygon in the unit square or, for a face, in half of it.
std::vector<Vec2> random_polygon(std::mt19937& random, bool in_triangle)
{
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    const int n = 3 + static_cast<int>(random() % 4);
    const double radius = 0.05 + 0.25 * unit(random), start = 6.3 * unit(random);
    const Vec2 middle =
        in_triangle ? Vec2{0.3, 0.3} : Vec2{0.35 + 0.3 * unit(random), 0.35 + 0.3 * unit(random)};
    std::vector<Vec2> out;
    for (int i = 0; i < n; ++i)
        out.push_back({middle.x + radius * std::cos(start + 6.2831853 * i / n),
                       middle.y + radius * std::sin(start + 6.2831853 * i / n)});
    return out;
}

//! Points of a convex polygon.
std::vector<Vec2> spread(const std::vector<Vec2>& polygon, int n)
{
    std::vector<Vec2> out;
    for (std::size_t k = 2; k < polygon.size(); ++k)
        for (int i = 0; i <= n; ++i)
            for (int j = 0; i + j <= n; ++j)
                out.push_back((double(n - i - j) / n) * polygon[0] +
                              (double(i) / n) * polygon[k - 1] + (double(j) / n) * polygon[k]);
    return out;
}

double mesh_bound(const PieceAndTriangle& both, const std::vector<Vec2>& places)
{
    const MeshTarget target(both.placed, both.pieces, 0);
    CoverPolygon polygon;
    for (const Vec2& w : places) {
        polygon.add(target.vertex(w));
        target.attach({0, invalid_index}, polygon.vertex[polygon.size - 1]);
    }
    return target.bound({0, invalid_index}, polygon).bound;
}

double spline_bound(const PieceAndTriangle& both, const std::vector<Vec2>& points)
{
    const SplineTarget target(both.placed, both.pieces, 0);
    const SplineTarget::Place place{0, SplineTarget::no_side};
    CoverPolygon polygon;
    for (const Vec2& st : points) {
        polygon.add(target.vertex(st, {0.5, 0.5}));
        target.attach(place, polygon.vertex[polygon.size - 1]);
    }
    return target.bound(place, polygon).bound;
}

double farthest_place(const PieceAndTriangle& both, const std::vector<Vec2>& places)
{
    double farthest = 0.0;
    for (const Vec2& w : spread(places, 12))
        farthest = std::max(farthest, both.from_triangle(both.pieces.position(0, w)));
    return farthest;
}

double farthest_point(const PieceAndTriangle& both, const std::vector<Vec2>& points)
{
    double farthest = 0.0;
    for (const Vec2& st : spread(points, 6))
        farthest = std::max(farthest, both.from_piece(both.placed.at(0, st)));
    return farthest;
}

TEST(MeshTarget, bounds_every_distance_of_a_polygon_from_a_triangle)
{
    std::mt19937 random(2);
    double tightest = INFINITY;
    for (int n = 0; n < 1500; ++n) {
        const PieceAndTriangle both(fixtures::random_control(random, n % 2 == 0 ? 0.02 : 0.3),
                                    random_triangle(random));
        const std::vector<Vec2> places = random_polygon(random, false);
        const double bound = mesh_bound(both, places), farthest = farthest_place(both, places);
        EXPECT_GE(bound, farthest * (1 - 1e-12)) << n;
        tightest = std::min(tightest, bound / farthest);
    }
    EXPECT_LT(tightest, 1.01);
}

TEST(SplineTarget, bounds_every_distance_of_a_polygon_from_a_piece)
{
    std::mt19937 random(3);
    double tightest = INFINITY;
    for (int n = 0; n < 200; ++n) {
        const PieceAndTriangle both(fixtures::random_control(random, n % 2 == 0 ? 0.02 : 0.3),
                                    random_triangle(random));
        const std::vector<Vec2> points = random_polygon(random, true);
        const double bound = spline_bound(both, points), farthest = farthest_point(both, points);
        EXPECT_GE(bound, farthest * (1 - 1e-9)) << n;
        tightest = std::min(tightest, bound / farthest);
    }
    EXPECT_LT(tightest, 1.01);
}

//! A piece, and places on it that are the corners of a triangle: nothing but the bend of the piece
//! keeps the two apart.
struct Inscribed {
    std::vector<Vec3> control, corners;
    std::vector<Vec2> places;

    Inscribed(std::mt19937& random, double bend)
        : control(fixtures::random_control(random, 0.02 * bend))
    {
        // Parameters that crowd to one side, so that the piece leaves the triangle sideways too.
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j)
                control[4 * i + j] += bend * Vec3{double(i * (3 - i)), 0.0, double(j * (3 - j))};
        std::uniform_real_distribution<double> unit(0.0, 1.0);
        do {
            places.clear();
            for (int k = 0; k < 3; ++k)
                places.push_back({unit(random), unit(random)});
        } while (cross(places[1] - places[0], places[2] - places[0]) < 0.1);
        for (const Vec2& w : places)
            corners.push_back(BezierView{control.data(), 4}.position(w));
    }
};

TEST(MeshTarget, bounds_how_far_a_piece_bends_away_between_the_corners_of_a_triangle)
{
    std::mt19937 random(5);
    double tightest = INFINITY;
    for (int n = 0; n < 1000; ++n) {
        const Inscribed in(random, n % 2 == 0 ? 0.02 : 0.1);
        const PieceAndTriangle both(in.control, in.corners);
        const double bound = mesh_bound(both, in.places),
                     farthest = farthest_place(both, in.places);
        EXPECT_GE(bound, farthest * (1 - 1e-12)) << n;
        tightest = std::min(tightest, bound / farthest);
    }
    EXPECT_LT(tightest, 1.1);
}

TEST(SplineTarget, bounds_how_far_a_triangle_is_from_a_piece_it_is_inscribed_in)
{
    std::mt19937 random(6);
    double tightest = INFINITY;
    for (int n = 0; n < 200; ++n) {
        const Inscribed in(random, n % 2 == 0 ? 0.02 : 0.1);
        const PieceAndTriangle both(in.control, in.corners);
        const std::vector<Vec2> whole{{0, 0}, {1, 0}, {0, 1}};
        const double bound = spline_bound(both, whole), farthest = farthest_point(both, whole);
        EXPECT_GE(bound, farthest * (1 - 1e-9)) << n;
        tightest = std::min(tightest, bound / farthest);
    }
    EXPECT_LT(tightest, 1.2);
}

//! z = height - |(x, y) - middle|^2 over the unit square, as a bicubic piece; and a triangle in
//! the plane z = 0 that is much larger.
PieceAndTriangle paraboloid(double height, const Vec2& middle)
{
    // Blossom of -(t - m)^2 in a cubic: coefficients for the sums of three arguments 0 or 1.
    const auto square = [](int i, double m) {
        return -(i > 1 ? i * (i - 1) / 6.0 : 0.0) + 2.0 * m * i / 3.0 - m * m;
    };
    std::vector<Vec3> control;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
            control.push_back(
                {i / 3.0, j / 3.0, height + square(i, middle.x) + square(j, middle.y)});
    return {control, {{-9, -9, 0}, {9, -9, 0}, {0, 9, 0}}};
}

TEST(MeshTarget, of_a_paraboloid_over_a_plane_is_its_height)
{
    const PieceAndTriangle both = paraboloid(1.5, {0.4, 0.45});
    ASSERT_NEAR(both.pieces.position(0, {0.4, 0.45}).z, 1.5, 1e-15);
    ASSERT_NEAR(both.pieces.position(0, {0.9, 0.45}).z, 1.25, 1e-15);
    EXPECT_NEAR(mesh_bound(both, {{0, 0}, {1, 0}, {1, 1}, {0, 1}}), 1.5, 1e-14);
    EXPECT_NEAR(mesh_bound(both, {{0.4, 0}, {1, 1}, {0, 1}}), 1.5, 1e-14);
    EXPECT_NEAR(mesh_bound(both, {{0.5, 0.45}, {1, 0}, {1, 1}}), 1.49, 1e-14);
}

TEST(MeshTarget, lets_the_partner_go_along_inside_the_triangle)
{
    // A flat piece that speeds up along u, above a triangle it lies well inside of: nothing but the
    // height counts, however uneven the parameters are.
    const double x[4] = {0.0, 0.0, 0.3, 1.0};
    std::vector<Vec3> control;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
            control.push_back({x[i], j / 3.0, 0.25});
    const PieceAndTriangle both(control, {{-9, -9, 0}, {9, -9, 0}, {0, 9, 0}});
    // The second derivative is up to 2.4; all that is left of it is the third one, which is 0.6.
    const double third_order = 0.6 * 0.1 * 0.1 * 0.1 / 16.0;
    EXPECT_NEAR(mesh_bound(both, {{0.2, 0.2}, {0.3, 0.2}, {0.3, 0.3}, {0.2, 0.3}}),
                0.25 + third_order, 1e-9);
}

TEST(Cover, of_a_cell_over_many_triangles_needs_no_split)
{
    // A flat square above the edges of an octahedral tent: exact in one go, for cuts along the
    // bisecting planes are straight there.
    const Domain d = fixtures::disk_grid(1, 1);
    SplineSurface surface = fixtures::flat_patches(d);
    for (Vec3& c : surface.bezier())
        c = {c.x - 0.5, c.y - 0.5, 0.4};
    const ManifoldMesh tent =
        fixtures::must_build({{0, 0, 0.3}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}},
                             {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}});
    const PlacedMesh placed(tent, tent.positions());
    const BezierPieces pieces(d.complex, surface, {});
    const ClosestPoint tree(tent);
    for (Index piece = 0; piece < pieces.count(); ++piece) {
        const MeshTarget target(placed, pieces, piece);
        CoverPolygon cell;
        double farthest = 0.0;
        for (const Vec2 w : {Vec2{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
            cell.add(target.vertex(w));
            farthest = std::max(farthest, tree.query(cell.vertex[cell.size - 1].point).distance);
        }
        const Index start = tree.query(pieces.position(piece, {0.5, 0.5})).where.face;
        const Cover result = cover(target, cell, {start, invalid_index}, 0.0);
        // The distance is concave across an edge that sticks out: corners have the largest.
        EXPECT_NEAR(result.bounds.max(), farthest, 1e-12) << piece;
        EXPECT_NEAR(result.worst.length, farthest, 1e-12);
    }
}

TEST(Cover, leaves_no_part_of_a_cell_out)
{
    // Where the surface leaves the mesh to one side, the farthest place of a cell is in the last of
    // many parts; both ways round.
    const Domain d = fixtures::disk_grid(1, 1);
    const SplineSurface surface = fixtures::surface_of_points(1, [](Index, Index i, Index j) {
        return Vec3{i / 12.0, j / 12.0, 0.02 * i * i / 144.0 + 0.03 * j / 12.0};
    });
    const ManifoldMesh mesh = fixtures::moved(fixtures::square(7), [](const Vec3& p) -> Vec3 {
        return {p.x, p.y, -0.02 * p.x - 0.05 * p.y * p.y};
    });
    const PlacedMesh placed(mesh, mesh.positions());
    const BezierPieces pieces(d.complex, surface, {});
    const ClosestPoint tree(mesh);
    for (Index piece = 0; piece < pieces.count(); ++piece) {
        const MeshTarget target(placed, pieces, piece);
        double farthest = 0.0;
        for (int i = 0; i <= 10; ++i)
            for (int j = 0; j <= 10; ++j)
                farthest = std::max(
                    farthest, tree.query(pieces.position(piece, {i / 10.0, j / 10.0})).distance);
        for (const Vec2 start : {Vec2{0, 0}, {0.5, 0.5}, {1, 0.2}}) {
            CoverPolygon cell;
            for (const Vec2 w : {Vec2{0, 0}, {1, 0}, {1, 1}, {0, 1}})
                cell.add(target.vertex(w));
            const Index face = tree.query(pieces.position(piece, start)).where.face;
            const double bound =
                cover(target, cell, {face, invalid_index}, 0.5 * farthest).bounds.max();
            EXPECT_GE(bound, farthest * (1 - 1e-12)) << piece;
            EXPECT_LE(bound, 1.02 * farthest) << piece;
        }
    }
    // One triangle over all pieces.
    const ManifoldMesh half =
        fixtures::must_build({{0, 0, -0.1}, {1, 0, -0.15}, {0, 1, -0.2}}, {{0, 1, 2}});
    const PlacedMesh placed_half(half, half.positions());
    const SplineTarget target(placed_half, pieces, 0);
    double farthest = 0.0;
    for (const Vec3& p : fixtures::mesh_grid(half, 12))
        farthest = std::max(farthest, fixtures::distance_to_surface(surface, p));
    for (const Index start : {0u, 3u, 5u}) {
        CoverPolygon cell;
        for (const Vec2 st : {Vec2{0, 0}, {1, 0}, {0, 1}})
            cell.add(target.vertex(st, {0.5, 0.5}));
        const double bound =
            cover(target, cell, {start, SplineTarget::no_side}, 0.5 * farthest).bounds.max();
        EXPECT_GE(bound, farthest * (1 - 1e-9)) << start;
        EXPECT_LE(bound, 1.02 * farthest) << start;
    }
}

} // namespace
} // namespace bot2nurbs
