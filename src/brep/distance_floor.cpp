// SPDX-License-Identifier: MIT
#include "brep/distance_floor.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace bot2nurbs {

namespace {

//! Halvings of a piece: each divides what the plane bound loses by four, and 4^-20 is rounding.
constexpr int most_halvings = 20;
//! Parts of pieces looked at before the bound so far is good enough. Near a foot there are a dozen
//! per halving; only points equally far from much of the surface need more.
constexpr int most_cells = 20000;

struct BezierCell {
    std::array<Vec3, 16> control;
    int halvings = 0;
    Vec2 corner; //!< The lowest, in the parameters of the piece.

    Vec2 in_piece(const Vec2& at) const { return corner + std::ldexp(1.0, -halvings) * at; }
    BezierView view() const { return {control.data(), 4}; }
};

//! Both halves of a cubic with control points c[0], c[s], c[2 s], c[3 s].
void halve(const Vec3* c, std::size_t s, Vec3* low, Vec3* high)
{
    const Vec3 ab = 0.5 * (c[0] + c[s]), bc = 0.5 * (c[s] + c[2 * s]),
               cd = 0.5 * (c[2 * s] + c[3 * s]);
    const Vec3 abc = 0.5 * (ab + bc), bcd = 0.5 * (bc + cd), middle = 0.5 * (abc + bcd);
    const std::array<Vec3, 4> l{c[0], ab, abc, middle}, h{middle, bcd, cd, c[3 * s]};
    for (std::size_t i = 0; i < 4; ++i) {
        low[i * s] = l[i];
        high[i * s] = h[i];
    }
}

std::array<BezierCell, 4> quarter(const BezierCell& cell)
{
    static constexpr std::array<Vec2, 4> corner{Vec2{0, 0}, {0, 0.5}, {0.5, 0}, {0.5, 0.5}};
    std::array<BezierCell, 4> out;
    for (std::size_t k = 0; k < 4; ++k) {
        out[k].halvings = cell.halvings + 1;
        out[k].corner = cell.in_piece(corner[k]);
    }
    BezierCell low, high;
    for (std::size_t j = 0; j < 4; ++j)
        halve(&cell.control[j], 4, &low.control[j], &high.control[j]);
    for (std::size_t i = 0; i < 16; i += 4) {
        halve(&low.control[i], 1, &out[0].control[i], &out[1].control[i]);
        halve(&high.control[i], 1, &out[2].control[i], &out[3].control[i]);
    }
    return out;
}

template <class Points> double plane_bound(const Vec3& p, const Vec3& towards, const Points& points)
{
    const Vec3 n = normalized(p - towards);
    double least = INFINITY;
    for (const Vec3& b : points)
        least = std::min(least, dot(n, p - b));
    return std::max(0.0, least);
}

double box_distance(const BoxTree::Node& box, const Vec3& p)
{
    const double x = std::max(0.0, std::max(box.min.x - p.x, p.x - box.max.x));
    const double y = std::max(0.0, std::max(box.min.y - p.y, p.y - box.max.y));
    const double z = std::max(0.0, std::max(box.min.z - p.z, p.z - box.max.z));
    return std::sqrt(x * x + y * y + z * z);
}

BoxTree hulls_of(const BezierPieces& pieces, const Context* context)
{
    std::vector<Box3> boxes(pieces.count());
    for (Index piece = 0; piece < pieces.count(); ++piece) {
        const BezierView c = pieces.view(piece);
        for (Index i = 0; i < 4; ++i)
            for (Index j = 0; j < 4; ++j)
                boxes[piece].add(c(i, j));
    }
    return BoxTree(boxes, context);
}

} // namespace

DistanceFloor::DistanceFloor(const PlacedMesh& mesh, const ClosestPoint& tree,
                             const BezierPieces& pieces, const Context* context)
    : mesh_(mesh), tree_(tree), pieces_(pieces), hulls_(hulls_of(pieces, context))
{
}

double DistanceFloor::to_mesh(const Vec3& p, double found) const
{
    double least = found;
    for (const Index f : tree_.faces_near(p, found)) {
        const TriangleCorners t = mesh_.corners(f);
        least = std::min(least, plane_bound(p, t.at(closest_on_triangle(p, t)),
                                            std::array<Vec3, 3>{t.a, t.b, t.c}));
    }
    return least;
}

SurfaceDistance DistanceFloor::to_surface(const Vec3& p, double found, double share) const
{
    SurfaceDistance out;
    out.distance = found;
    double goal = (1.0 - share) * found; // Parts that are shown to be no nearer are done.
    double least = INFINITY;             // Over parts that were left undecided.
    int cells = 0;
    std::vector<BezierCell> open;
    const auto look_into = [&](Index piece, const BezierCell& first) {
        open.assign(1, first);
        while (!open.empty()) {
            const BezierCell cell = open.back();
            open.pop_back();
            const PieceFoot foot = foot_on_piece(cell.view(), p);
            const double distance = norm(p - foot.position);
            if (distance < out.distance) {
                out.distance = distance;
                out.piece = piece;
                out.at = cell.in_piece(foot.at);
                goal = (1.0 - share) * distance;
            }
            const double bound = plane_bound(p, foot.position, cell.control);
            ++cells;
            if (bound >= goal)
                continue;
            if (cell.halvings == most_halvings || cells >= most_cells) {
                least = std::min(least, bound);
                continue;
            }
            const auto parts = quarter(cell);
            open.insert(open.end(), parts.begin(), parts.end());
        }
    };
    std::vector<Index> nodes{0};
    while (!nodes.empty()) {
        const BoxTree::Node& node = hulls_.nodes()[nodes.back()];
        nodes.pop_back();
        if (box_distance(node, p) >= goal)
            continue;
        if (node.count == 0) {
            nodes.push_back(node.first);
            nodes.push_back(node.first + 1);
        }
        for (Index i = node.first; i < node.first + node.count; ++i) {
            const Index piece = hulls_.items()[i];
            const BezierView c = pieces_.view(piece);
            BezierCell cell;
            for (Index k = 0; k < 16; ++k)
                cell.control[k] = c(k / 4, k % 4);
            look_into(piece, cell);
        }
    }
    out.floor = std::min(goal, least);
    return out;
}

} // namespace bot2nurbs
