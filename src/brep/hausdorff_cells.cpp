// SPDX-License-Identifier: MIT
#include "brep/hausdorff_cells.h"

#include "mesh/closest_on_triangle.h"

#include <algorithm>
#include <cmath>

namespace bot2nurbs {

namespace {

//! What rounding can hide, in coordinates of at most one: docs/algorithms/deviation.md counts less
//! than 2^14 units of 2^-53.
constexpr double rounding_slack = 0x1p-38;
//! Cells per Bezier piece that seed the search for a foot on the surface.
constexpr Index seed_cells = 2;
//! How much nearer another place on the surface must be to count as missed.
constexpr double doubtful_share = 0.01;

//! A triangle is thin when its longest side is so many times its height over it.
constexpr double thin_ratio = 4.0;
//! The closest element is not farther than one near by, but for rounding.
constexpr double limit_slack = 1.0 + 1e-9;

//! Width of squares that cover a mesh, so many.
double mean_width(const PlacedMesh& mesh, Index pieces)
{
    double area = 0.0;
    for (Index f = 0; f < mesh.topology.face_count(); ++f)
        area += 0.5 * norm(cross(mesh.corner(f, 1) - mesh.corner(f, 0),
                                 mesh.corner(f, 2) - mesh.corner(f, 0)));
    return std::sqrt(area / pieces);
}

Box3 box_of(const ManifoldMesh& source, const SplineSurface& surface)
{
    Box3 box = source.box();
    for (const Vec3& b : surface.bezier())
        box.add(b);
    return box;
}

//! The power of two that makes the largest distance of a coordinate from the centre at most one.
double unit_scale(const Box3& box, const Vec3& centre)
{
    double largest = 0.0;
    for (int k = 0; k < 3; ++k)
        largest = std::max({largest, box.max[k] - centre[k], centre[k] - box.min[k]});
    int exponent = 0;
    std::frexp(largest, &exponent);
    return std::ldexp(1.0, -exponent);
}

std::vector<Vec3> placed(std::vector<Vec3> points, const Vec3& centre, double scale)
{
    for (Vec3& p : points)
        p = scale * (p - centre);
    return points;
}

SplineSurface placed(SplineSurface surface, const Vec3& centre, double scale)
{
    surface.bezier() = placed(std::move(surface.bezier()), centre, scale);
    return surface;
}

} // namespace

HausdorffCell HausdorffCell::whole(HausdorffSide side, Index element)
{
    HausdorffCell cell;
    cell.side = side;
    cell.element = element;
    if (side == HausdorffSide::surface)
        cell.corner = {Vec2{0, 0}, Vec2{1, 1}, Vec2{}};
    else
        cell.corner = {Vec2{0, 0}, Vec2{1, 0}, Vec2{0, 1}};
    return cell;
}

std::array<HausdorffCell, 4> HausdorffCell::quarters() const
{
    std::array<HausdorffCell, 4> parts{*this, *this, *this, *this};
    const auto& [a, b, c] = corner;
    const Vec2 ab = 0.5 * (a + b);
    if (side == HausdorffSide::surface) {
        parts[0].corner = {a, ab, {}};
        parts[1].corner = {Vec2{ab.x, a.y}, Vec2{b.x, ab.y}, Vec2{}};
        parts[2].corner = {Vec2{a.x, ab.y}, Vec2{ab.x, b.y}, Vec2{}};
        parts[3].corner = {ab, b, {}};
    } else {
        const Vec2 bc = 0.5 * (b + c), ca = 0.5 * (c + a);
        parts[0].corner = {a, ab, ca};
        parts[1].corner = {ab, b, bc};
        parts[2].corner = {ca, bc, c};
        parts[3].corner = {ab, bc, ca};
    }
    for (HausdorffCell& part : parts)
        part.level = static_cast<std::uint8_t>(level + 2);
    return parts;
}

std::array<HausdorffCell, 2> HausdorffCell::halves(std::size_t k) const
{
    std::array<HausdorffCell, 2> parts{*this, *this};
    const Vec2 middle = 0.5 * (corner[k] + corner[(k + 1) % 3]);
    parts[0].corner[(k + 1) % 3] = middle;
    parts[1].corner[k] = middle;
    for (HausdorffCell& part : parts)
        part.level = static_cast<std::uint8_t>(level + 1);
    return parts;
}

int HausdorffCell::corners(std::array<Vec2, 4>& at) const
{
    const auto& [a, b, c] = corner;
    if (side == HausdorffSide::surface) {
        at = {a, Vec2{b.x, a.y}, b, Vec2{a.x, b.y}};
        return 4;
    }
    at = {a, b, c, {}};
    return 3;
}

Vec2 middle_of(const HausdorffCell& cell)
{
    std::array<Vec2, 4> corners;
    const int n = cell.corners(corners);
    Vec2 sum;
    for (int k = 0; k < n; ++k)
        sum = sum + corners[k];
    return (1.0 / n) * sum;
}

HausdorffSubject::HausdorffSubject(const ManifoldMesh& source, const QuadComplex& complex,
                                   const SplineSurface& surface, const Context& context)
    : centre_(box_of(source, surface).center()),
      scale_(unit_scale(box_of(source, surface), centre_)),
      mesh_(source, placed(source.positions(), centre_, scale_)),
      surface_(placed(surface, centre_, scale_)), pieces_(complex, surface_, context),
      tree_(mesh_.positions, source.triangles(), &context),
      locator_(complex, surface_, seed_cells, &context), floor_(mesh_, tree_, pieces_, &context),
      piece_width_(mean_width(mesh_, pieces_.count()))
{
}

Vec3 HausdorffSubject::point(HausdorffSide side, Index element, const Vec2& at) const
{
    return side == HausdorffSide::surface ? pieces_.position(element, at) : mesh_.at(element, at);
}

FoundPlace HausdorffSubject::find(HausdorffSide side, Index element, const Vec2& at, Index near,
                                  double doubtful) const
{
    const Vec3 p = point(side, element, at);
    FoundPlace place;
    place.side = side;
    place.element = element;
    place.at = at;
    if (side == HausdorffSide::source) {
        const FootPoint foot = locator_.closest(p);
        place.distance = foot.distance;
        place.near = BezierPieces::piece_at(foot.where);
        place.near_at = BezierPieces::place_in_piece(foot.where);
        if (foot.distance > doubtful) {
            const SurfaceDistance sure = floor_.to_surface(p, foot.distance, doubtful_share);
            if (sure.piece != invalid_index) {
                place.distance = sure.distance;
                place.near = sure.piece;
                place.near_at = sure.at;
            }
        }
        place.patch = BezierPieces::patch(place.near);
        return place;
    }
    place.patch = BezierPieces::patch(element);
    place.near = near;
    double limit = INFINITY;
    if (near != invalid_index) {
        const TriangleCorners t = mesh_.corners(near);
        place.distance = norm(p - t.at(closest_on_triangle(p, t)));
        limit = limit_slack * place.distance;
    }
    const ClosestPoint::Hit hit = tree_.query(p, limit);
    if (hit.where.face != invalid_index) {
        place.near = hit.where.face;
        place.distance = hit.distance;
    }
    return place;
}

void HausdorffSubject::split(const HausdorffCell& cell, std::vector<HausdorffCell>& parts) const
{
    if (cell.side == HausdorffSide::source) {
        std::array<Vec3, 3> edge;
        std::array<double, 3> length;
        for (std::size_t k = 0; k < 3; ++k) {
            edge[k] = mesh_.at(cell.element, cell.corner[(k + 1) % 3]) -
                      mesh_.at(cell.element, cell.corner[k]);
            length[k] = norm(edge[k]);
        }
        const auto longest = std::max_element(length.begin(), length.end());
        if (*longest > piece_width_ &&
            *longest * *longest > thin_ratio * norm(cross(edge[0], edge[1]))) {
            const auto halves = cell.halves(static_cast<std::size_t>(longest - length.begin()));
            parts.insert(parts.end(), halves.begin(), halves.end());
            return;
        }
    }
    const auto quarters = cell.quarters();
    parts.insert(parts.end(), quarters.begin(), quarters.end());
}

Cover HausdorffSubject::cover_cell(const HausdorffCell& cell, double target) const
{
    std::array<Vec2, 4> corners;
    const int n = cell.corners(corners);
    CoverPolygon polygon;
    if (cell.side == HausdorffSide::surface) {
        const MeshTarget mesh(mesh_, pieces_, cell.element);
        for (int k = 0; k < n; ++k)
            polygon.add(mesh.vertex(corners[k]));
        return cover(mesh, polygon, {cell.near, invalid_index}, target);
    }
    const SplineTarget spline(mesh_, pieces_, cell.element);
    for (int k = 0; k < n; ++k)
        polygon.add(spline.vertex(corners[k], cell.near_at));
    return cover(spline, polygon, {cell.near, SplineTarget::no_side}, target);
}

//! How far the cell's points are from its place `at`, at most.
double HausdorffSubject::radius(const HausdorffCell& cell, const Vec2& at) const
{
    std::array<Vec2, 4> corners;
    const int n = cell.corners(corners);
    double largest = 0.0;
    for (int k = 0; k < n; ++k) {
        if (cell.side == HausdorffSide::surface) {
            const DerivativeBounds& b = pieces_.bounds(cell.element);
            largest = std::max(largest, std::abs(corners[k].x - at.x) * b.u +
                                            std::abs(corners[k].y - at.y) * b.v);
        } else {
            largest = std::max(
                largest, norm(mesh_.at(cell.element, corners[k]) - mesh_.at(cell.element, at)));
        }
    }
    return largest;
}

CellFindings HausdorffSubject::look_at(HausdorffCell cell, const FoundPlace* known, double target,
                                       double lower) const
{
    CellFindings out;
    if (known)
        out.places[0] = *known;
    else if (cell.side == HausdorffSide::surface) {
        out.places[0] = find(cell.side, cell.element, middle_of(cell), cell.near, lower);
        ++out.queries;
    }
    const FoundPlace& found = out.places[0];
    double near_bound = INFINITY;
    cell.bounds = {};
    if (found.patch != invalid_index) {
        cell.near = found.near;
        cell.near_at = found.near_at;
        near_bound = found.distance + radius(cell, found.at) + rounding_slack;
        cell.bounds.add(found.patch, near_bound);
    }
    if (!(near_bound <= target)) {
        const Cover cover = cover_cell(cell, target - rounding_slack);
        if (cover.bounds.max() + rounding_slack < near_bound) {
            cell.bounds = cover.bounds;
            cell.bounds.raise(rounding_slack);
        }
        // On the surface the parts of a cell start from where it did; a search puts them right.
        const bool worth_it = cell.side == HausdorffSide::source || cover.worst.length > lower;
        if (cell.bounds.max() > target && worth_it) {
            out.places[1] = find(cell.side, cell.element, cover.worst.worst, cell.near, lower);
            ++out.queries;
            if (cell.side == HausdorffSide::source) {
                cell.near = out.places[1].near;
                cell.near_at = out.places[1].near_at;
            }
        }
    }
    out.cell = cell;
    return out;
}

double HausdorffSubject::floor(const FoundPlace& place, double share) const
{
    const Vec3 p = point(place.side, place.element, place.at);
    const double distance = place.side == HausdorffSide::surface
                                ? floor_.to_mesh(p, place.distance)
                                : floor_.to_surface(p, place.distance, share).floor;
    return std::max(0.0, distance - rounding_slack);
}

FarPlace HausdorffSubject::far_place(const FoundPlace& place, double distance) const
{
    const Vec3 p = point(place.side, place.element, place.at);
    FarPlace out;
    out.point = p / scale_ + centre_;
    out.distance = from_unit(distance);
    if (place.side == HausdorffSide::surface) {
        out.surface = BezierPieces::domain_point(place.element, place.at);
        out.source = tree_.query(p).where;
    } else {
        out.surface = locator_.closest(p).where;
        out.source = {place.element, {1.0 - place.at.x - place.at.y, place.at.x, place.at.y}};
    }
    return out;
}

} // namespace bot2nurbs
