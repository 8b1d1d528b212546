// SPDX-License-Identifier: MIT
#include "brep/bezier_pieces.h"

#include "hausdorff_fixtures.h"

#include <gtest/gtest.h>

namespace bot2nurbs {
namespace {

using fixtures::Domain;

TEST(BezierPieces, are_the_surface_in_parameters_of_their_own)
{
    const Domain d = fixtures::torus_grid(4, 3);
    const SplineSurface surface = fixtures::wavy_sphere(d, 1, 0.1);
    const BezierPieces pieces(d.complex, surface, {});
    ASSERT_EQ(pieces.count(), 16 * 12u);
    for (Index piece = 0; piece < pieces.count(); ++piece)
        for (const Vec2 at : {Vec2{0.3, 0.8}, {0.0, 0.5}, {1.0, 1.0}}) {
            const DomainPoint there = BezierPieces::domain_point(piece, at);
            EXPECT_LT(norm(pieces.position(piece, at) - surface.position(there)), 1e-15);
            EXPECT_EQ(there.quad, BezierPieces::patch(piece));
        }
    const DomainPoint inside = BezierPieces::domain_point(37, {0.25, 0.75});
    EXPECT_EQ(BezierPieces::piece_at(inside), 37u);
    EXPECT_EQ(BezierPieces::place_in_piece(inside), (Vec2{0.25, 0.75}));
}

TEST(BezierPieces, share_the_points_of_their_sides_with_the_piece_across)
{
    Index boundary = 0, joined = 0;
    for (const Domain& d : {fixtures::genus2(), fixtures::split_bipyramid(7), fixtures::star(5, 2),
                            fixtures::disk_grid(3, 2)}) {
        const SplineSurface surface = fixtures::wavy_sphere(d, 2, 0.1);
        const BezierPieces pieces(d.complex, surface, {});
        for (Index piece = 0; piece < pieces.count(); ++piece)
            for (Index side = 0; side < 4; ++side) {
                const BezierPieces::Side across = pieces.across({piece, side});
                if (across.piece == invalid_index) {
                    ++boundary;
                    continue;
                }
                ++joined;
                const BezierPieces::Side back = pieces.across(across);
                EXPECT_EQ(back.piece, piece);
                EXPECT_EQ(back.side, side);
                for (const double t : {0.0, 0.3, 1.0}) {
                    const Vec2 here = BezierPieces::on_side(side, t),
                               there = BezierPieces::on_side(across.side, 1.0 - t);
                    EXPECT_LT(
                        norm(pieces.position(piece, here) - pieces.position(across.piece, there)),
                        1e-14);
                    EXPECT_NEAR(BezierPieces::along_side(side, here), t, 1e-15);
                }
            }
    }
    // The 3 x 2 quads have 10 boundary sides of 4 pieces, the star of five sectors of 2 x 2 has 20.
    EXPECT_EQ(boundary, 4 * (10u + 20u));
    EXPECT_GT(joined, 1000u);
}

TEST(BezierPieces, no_derivative_is_longer_than_its_bound)
{
    const Domain d = fixtures::disk_grid(1, 1);
    const SplineSurface surface = fixtures::wavy_sphere(d, 3, 0.3);
    const BezierPieces pieces(d.complex, surface, {});
    constexpr double h = 1e-3;
    for (Index piece = 0; piece < pieces.count(); ++piece) {
        const DerivativeBounds& b = pieces.bounds(piece);
        const BezierView s = pieces.view(piece);
        double u = 0.0, uuu = 0.0, uuv = 0.0, uvv = 0.0, vvv = 0.0;
        for (int i = 0; i <= 10; ++i)
            for (int j = 0; j <= 10; ++j) {
                const Vec2 at{0.01 + 0.098 * i, 0.01 + 0.098 * j};
                const auto second = [&](double du, double dv) {
                    return second_derivative(s, {at.x + du, at.y + dv});
                };
                // Central differences: exact for what is quadratic, and second derivatives are.
                u = std::max(u, norm(s.position({at.x + h, at.y}) - s.position({at.x - h, at.y})) /
                                    (2 * h));
                uuu = std::max(uuu, norm(second(h, 0).uu - second(-h, 0).uu) / (2 * h));
                uuv = std::max(uuv, norm(second(0, h).uu - second(0, -h).uu) / (2 * h));
                uvv = std::max(uvv, norm(second(h, 0).vv - second(-h, 0).vv) / (2 * h));
                vvv = std::max(vvv, norm(second(0, h).vv - second(0, -h).vv) / (2 * h));
            }
        // Differences of second derivatives lose about 1e-16 / h.
        EXPECT_LE(u, b.u * (1 + 1e-9));
        EXPECT_LE(uuu, b.uuu + 1e-9);
        EXPECT_LE(uuv, b.uuv + 1e-9);
        EXPECT_LE(uvv, b.uvv + 1e-9);
        EXPECT_LE(vvv, b.vvv + 1e-9);
        // And the bounds are not far off: they are attained at a corner of the coefficients.
        EXPECT_GE(u, 0.5 * b.u);
    }
}

TEST(BezierPieces, second_derivatives_agree_with_differences)
{
    std::mt19937 random(4);
    const std::vector<Vec3> control = fixtures::random_control(random, 0.3);
    const BezierView s{control.data(), 4};
    constexpr double h = 1e-4;
    const Vec2 at{0.3, 0.6};
    const SecondDerivative d = second_derivative(s, at);
    const auto along = [&](const Vec2& e) {
        return (s.position({at.x + h * e.x, at.y + h * e.y}) - 2.0 * s.position(at) +
                s.position({at.x - h * e.x, at.y - h * e.y})) /
               (h * h);
    };
    for (const Vec2 e : {Vec2{1, 0}, {0, 1}, {1, 1}, {2, -1}})
        EXPECT_LT(norm(d.of(e) - along(e)), 1e-5);
}

TEST(FootOnPiece, finds_the_point_a_place_was_lifted_from)
{
    std::mt19937 random(5);
    for (int n = 0; n < 200; ++n) {
        const std::vector<Vec3> control = fixtures::random_control(random, 0.05);
        const BezierView s{control.data(), 4};
        std::uniform_real_distribution<double> unit(0.0, 1.0);
        const Vec2 at{unit(random), unit(random)};
        constexpr double h = 1e-5;
        const Vec3 normal =
            normalized(cross(s.position({at.x + h, at.y}) - s.position({at.x - h, at.y}),
                             s.position({at.x, at.y + h}) - s.position({at.x, at.y - h})));
        const PieceFoot foot = foot_on_piece(s, s.position(at) + 0.02 * normal);
        // The normal is off by 1e-9 or so, and the last step leaves a hundredth of a fiftieth.
        EXPECT_LT(norm(foot.position - s.position(at)), 1e-3);
        EXPECT_EQ(foot.position, s.position(foot.at));
        EXPECT_LT(norm(s.position(at) + 0.02 * normal - foot.position), 0.02 * (1 + 1e-3));
    }
}

TEST(FootOnPiece, stays_in_the_square_and_says_how_far_beyond_it_the_point_is)
{
    std::vector<Vec3> control;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
            control.push_back({2.0 * i / 3.0, j / 3.0, 0.0});
    const BezierView flat{control.data(), 4};
    const PieceFoot foot = foot_on_piece(flat, {2.5, 0.25, 0.3});
    EXPECT_EQ(foot.at.x, 1.0);
    EXPECT_NEAR(foot.at.y, 0.25, 1e-12);
    EXPECT_NEAR(foot.beyond.x, 1.25, 1e-12);
    EXPECT_NEAR(foot.beyond.y, 0.25, 1e-12);
    const PieceFoot corner = foot_on_piece(flat, {-1.0, 3.0, 0.0}, {1.0, 0.0});
    EXPECT_EQ(corner.at, (Vec2{0.0, 1.0}));
}

TEST(FootOnPiece, is_beyond_no_side_it_is_not_on)
{
    // The tangents are nearly parallel: along u alone or v alone the way to a point is long.
    std::vector<Vec3> control;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
            control.push_back({(i + j) / 3.0, 0.01 * i / 3.0, 0.0});
    const BezierView skew{control.data(), 4};
    std::mt19937 random(1);
    std::uniform_real_distribution<double> number(-1.0, 3.0);
    int inside = 0;
    for (int n = 0; n < 200; ++n) {
        const PieceFoot foot = foot_on_piece(skew, {number(random), 0.01 * number(random), 0.2});
        EXPECT_TRUE(foot.at.x == 0.0 || foot.beyond.x >= 0.0);
        EXPECT_TRUE(foot.at.x == 1.0 || foot.beyond.x <= 1.0);
        EXPECT_TRUE(foot.at.y == 0.0 || foot.beyond.y >= 0.0);
        EXPECT_TRUE(foot.at.y == 1.0 || foot.beyond.y <= 1.0);
        inside += foot.at.y > 0.0 && foot.at.y < 1.0;
    }
    EXPECT_GE(inside, 20);
}

} // namespace
} // namespace bot2nurbs
