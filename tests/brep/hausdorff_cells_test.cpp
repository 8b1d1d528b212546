// SPDX-License-Identifier: MIT
#include "brep/hausdorff_cells.h"

#include "hausdorff_fixtures.h"

#include <gtest/gtest.h>

namespace bot2nurbs {
namespace {

using fixtures::Domain;

//! Whether a triangle or square with these corners, counter-clockwise, has the place.
bool contains(const std::array<Vec2, 4>& corners, int n, const Vec2& p)
{
    for (int k = 0; k < n; ++k)
        if (cross(corners[(k + 1) % n] - corners[k], p - corners[k]) < -1e-12)
            return false;
    return true;
}

TEST(HausdorffCell, parts_tile_their_parent)
{
    for (const HausdorffSide side : {HausdorffSide::surface, HausdorffSide::source}) {
        std::vector<HausdorffCell> cells{HausdorffCell::whole(side, 0)};
        for (int level = 0; level < 3; ++level) {
            std::vector<HausdorffCell> parts;
            for (const HausdorffCell& cell : cells)
                for (const HausdorffCell& part : cell.quarters())
                    parts.push_back(part);
            cells = parts;
        }
        ASSERT_EQ(cells.size(), 64u);
        double area = 0.0;
        for (const HausdorffCell& cell : cells) {
            std::array<Vec2, 4> corner;
            const int n = cell.corners(corner);
            ASSERT_EQ(n, side == HausdorffSide::surface ? 4 : 3);
            EXPECT_TRUE(contains(corner, n, middle_of(cell)));
            for (int k = 2; k < n; ++k)
                area += 0.5 * cross(corner[k - 1] - corner[0], corner[k] - corner[0]);
        }
        EXPECT_NEAR(area, side == HausdorffSide::surface ? 1.0 : 0.5, 1e-14);
        std::mt19937 random(4);
        std::uniform_real_distribution<double> unit(0.0, 1.0);
        for (int k = 0; k < 300; ++k) {
            Vec2 p{unit(random), unit(random)};
            if (side == HausdorffSide::source && p.x + p.y > 1.0)
                p = {1.0 - p.x, 1.0 - p.y};
            EXPECT_TRUE(std::any_of(cells.begin(), cells.end(), [&](const HausdorffCell& cell) {
                std::array<Vec2, 4> corner;
                const int n = cell.corners(corner);
                return contains(corner, n, p);
            }));
        }
    }
}

TEST(HausdorffCell, halves_tile_their_parent_whichever_side_is_cut)
{
    const HausdorffCell whole = HausdorffCell::whole(HausdorffSide::source, 0);
    for (std::size_t k = 0; k < 3; ++k) {
        const auto halves = whole.halves(k);
        for (const HausdorffCell& half : halves) {
            const auto& [a, b, c] = half.corner;
            EXPECT_EQ(cross(b - a, c - a), 0.5) << k; // Half of the parent's, and not turned over.
        }
        EXPECT_EQ(halves[0].corner[(k + 1) % 3].x, halves[1].corner[k].x);
        EXPECT_EQ(halves[0].corner[(k + 1) % 3].y, halves[1].corner[k].y);
    }
}

TEST(HausdorffSubject, cuts_needles_and_caps_across_until_they_are_as_short_as_pieces)
{
    const Domain disk = fixtures::disk_grid(1, 1);
    const SplineSurface surface = fixtures::flat_patches(disk);
    for (const double tip : {0.0, 32.0, 64.0}) {
        const ManifoldMesh mesh =
            fixtures::must_build({{0, 0, 0}, {64, 0, 0}, {tip, 1, 0}}, {{0, 1, 2}});
        const HausdorffSubject subject(mesh, disk.complex, surface, {});
        std::vector<HausdorffCell> open{HausdorffCell::whole(HausdorffSide::source, 0)}, parts;
        int whole = 0;
        double width = 0.0;
        while (!open.empty()) {
            const HausdorffCell cell = open.back();
            open.pop_back();
            parts.clear();
            subject.split(cell, parts);
            if (parts.size() == 2) {
                open.insert(open.end(), parts.begin(), parts.end());
                continue;
            }
            ++whole;
            std::array<Vec2, 4> corner;
            cell.corners(corner);
            for (int k = 0; k < 3; ++k)
                width = std::max(
                    width, norm(subject.point(HausdorffSide::source, 0, corner[k]) -
                                subject.point(HausdorffSide::source, 0, corner[(k + 1) % 3])));
        }
        // Pieces are 1.4 wide. By quarters it would take 4,096 parts until they are as short.
        EXPECT_GE(whole, 16) << tip;
        EXPECT_LE(whole, 1024) << tip;
        EXPECT_LE(subject.from_unit(width), 4.0) << tip;
    }
}

TEST(HausdorffSubject, bounds_every_distance_of_a_cell_whatever_the_target)
{
    const Domain d = fixtures::sphere_cube(0);
    const SplineSurface surface = fixtures::wavy_sphere(d, 3, 0.1);
    const ManifoldMesh mesh = fixtures::icosphere(1);
    const Context context;
    const HausdorffSubject subject(mesh, d.complex, surface, context);
    const ClosestPoint tree(mesh);
    const BezierPieces pieces(d.complex, surface, context);
    // A target that nothing meets asks for all there is; one that everything meets takes the first.
    for (const double target : {0.0, 0.05, 10.0}) {
        for (Index piece = 0; piece < pieces.count(); piece += 5) {
            HausdorffCell cell = HausdorffCell::whole(HausdorffSide::surface, piece);
            if (piece % 2 == 1)
                cell = cell.quarters()[piece % 4];
            const CellFindings found = subject.look_at(cell, nullptr, target, 0.0);
            std::array<Vec2, 4> corners;
            cell.corners(corners);
            double farthest = 0.0;
            for (int i = 0; i <= 10; ++i)
                for (int j = 0; j <= 10; ++j) {
                    const Vec2 at{corners[0].x + 0.1 * i * (corners[2].x - corners[0].x),
                                  corners[0].y + 0.1 * j * (corners[2].y - corners[0].y)};
                    farthest = std::max(farthest, tree.query(pieces.position(piece, at)).distance);
                }
            EXPECT_GE(subject.from_unit(found.cell.bounds.max()), farthest) << piece;
        }
        for (Index face = 0; face < mesh.face_count(); face += 7) {
            const HausdorffCell cell = HausdorffCell::whole(HausdorffSide::source, face);
            const FoundPlace corner =
                subject.find(HausdorffSide::source, face, {0.0, 0.0}, invalid_index, 0.0);
            const CellFindings found = subject.look_at(cell, &corner, target, 0.0);
            double farthest = 0.0;
            for (int i = 0; i <= 6; ++i)
                for (int j = 0; i + j <= 6; ++j)
                    farthest = std::max(
                        farthest,
                        fixtures::distance_to_surface(
                            surface, mesh.at({face, {1 - (i + j) / 6.0, i / 6.0, j / 6.0}}), 12));
            EXPECT_GE(subject.from_unit(found.cell.bounds.max()), farthest * (1 - 1e-9)) << face;
        }
    }
}

TEST(HausdorffSubject, makes_sure_of_a_nearest_place_that_is_doubtful)
{
    // A plate at z = 0, and one at z = 0.2 that dips down to z = 0.0815 between the places a
    // tessellation sees. The point is right below the tip.
    const Domain plates = fixtures::make_domain("plates",
                                                {{0, 0, 0},
                                                 {1, 0, 0},
                                                 {1, 1, 0},
                                                 {0, 1, 0},
                                                 {0, 0, .2},
                                                 {1, 0, .2},
                                                 {1, 1, .2},
                                                 {0, 1, .2}},
                                                {{0, 1, 2, 3}, {4, 5, 6, 7}});
    SplineSurface surface = fixtures::flat_patches(plates);
    surface.bezier()[SplineNetwork::row(1, 4, 4)].z -= 0.6;
    const Vec3 tip{1.0 / 3.0, 1.0 / 3.0, 0.2 - 0.6 * 16.0 / 81.0};
    ASSERT_LT(norm(surface.position({1, 1.0 / 3.0, 1.0 / 3.0}) - tip), 1e-15);
    const ManifoldMesh mesh =
        fixtures::must_build({{tip.x, tip.y, tip.z - 0.02}, {1, 0, 0.1}, {0, 1, 0.1}}, {{0, 1, 2}});
    const HausdorffSubject subject(mesh, plates.complex, surface, {});
    const auto distance = [&](double doubtful) {
        const FoundPlace place = subject.find(HausdorffSide::source, 0, {0.0, 0.0}, invalid_index,
                                              subject.to_unit(doubtful));
        return std::pair{subject.from_unit(place.distance), place.patch};
    };
    // The search ends on the wrong plate; nobody minds while that is near enough.
    EXPECT_NEAR(distance(0.1).first, tip.z - 0.02, 1e-12);
    EXPECT_EQ(distance(0.1).second, 0u);
    EXPECT_NEAR(distance(0.03).first, 0.02, 2e-4);
    EXPECT_EQ(distance(0.03).second, 1u);
    const FoundPlace wrong =
        subject.find(HausdorffSide::source, 0, {0.0, 0.0}, invalid_index, INFINITY);
    EXPECT_NEAR(subject.from_unit(subject.floor(wrong, 1e-3)), 0.02, 1e-4);
}

} // namespace
} // namespace bot2nurbs
