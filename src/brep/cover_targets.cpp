// SPDX-License-Identifier: MIT
#include "brep/cover_targets.h"

#include "brep/residual_bound.h"

namespace bot2nurbs {

namespace {

struct Rectangle {
    Vec2 low{INFINITY, INFINITY}, high{-INFINITY, -INFINITY};

    void add(const Vec2& w)
    {
        low = {std::min(low.x, w.x), std::min(low.y, w.y)};
        high = {std::max(high.x, w.x), std::max(high.y, w.y)};
    }
    Vec2 middle() const { return {0.5 * (low.x + high.x), 0.5 * (low.y + high.y)}; }
    Vec2 size() const { return {high.x - low.x, high.y - low.y}; }
};

//! Bound of e in the lemma for places in a rectangle of size d, H the second derivative in its
//! middle. With h_k = w_k - w, Taylor's formula gives e = -1/2 sum c_k (D2S - H)(h_k, h_k), D2S at
//! some place between. Third derivatives bound the difference; the h_k have mean zero, so
//! sum c_k u(h_k)^2 <= du^2 / 4, sum c_k |u(h_k) v(h_k)| <= du dv / 4.
double third_order(const DerivativeBounds& b, const Vec2& d)
{
    const double uu = b.uuu * d.x + b.uuv * d.y, uv = b.uuv * d.x + b.uvv * d.y,
                 vv = b.uvv * d.x + b.vvv * d.y;
    return (uu * d.x * d.x + 2.0 * uv * d.x * d.y + vv * d.y * d.y) / 16.0;
}

//! By the lemma, over a fan of triangles. `residual(v)`: the piece less the mesh at a vertex;
//! `bend(a, b)`: q of two vertices.
template <class Residual, class Bend> PartBound
fan_bound(const CoverPolygon& polygon, const Vec3& n, const Residual& residual, const Bend& bend)
{
    PartBound out;
    QuadraticResidual f;
    const CoverVertex& first = polygon.vertex[0];
    f.r[0] = residual(first);
    f.r[2] = residual(polygon.vertex[1]);
    f.q[2] = bend(first, polygon.vertex[1]);
    for (int i = 2; i < polygon.size; ++i) {
        const CoverVertex &a = polygon.vertex[i - 1], &b = polygon.vertex[i];
        f.r[1] = f.r[2];
        f.r[2] = residual(b);
        f.q[0] = f.q[2];
        f.q[1] = bend(a, b);
        f.q[2] = bend(b, first);
        const ResidualBound part = residual_bound(f, n);
        if (part.bound <= out.bound)
            continue;
        out.bound = part.bound;
        out.length = part.length;
        const auto& c = part.weight;
        out.worst = c[0] * first.at + c[1] * a.at + c[2] * b.at;
    }
    return out;
}

//! Of parameters in [0, 1], which rounding must not leave.
Vec2 lerp(const Vec2& a, const Vec2& b, double t)
{
    return {std::clamp(a.x + t * (b.x - a.x), 0.0, 1.0),
            std::clamp(a.y + t * (b.y - a.y), 0.0, 1.0)};
}

} // namespace

PlacedMesh::PlacedMesh(const ManifoldMesh& mesh, std::vector<Vec3> moved)
    : topology(mesh), positions(std::move(moved)), normals(mesh.face_count())
{
    for (Index f = 0; f < mesh.face_count(); ++f)
        normals[f] = normalized(cross(corner(f, 1) - corner(f, 0), corner(f, 2) - corner(f, 0)));
}

MeshTarget::MeshTarget(const PlacedMesh& mesh, const BezierPieces& pieces, Index piece)
    : mesh_(mesh), pieces_(pieces), piece_(piece)
{
}

void MeshTarget::attach(const Place& place, CoverVertex& v) const
{
    const TriangleCorners t = mesh_.corners(place.face);
    v.partner = t.at(closest_on_triangle(v.point, t));
}

PartBound MeshTarget::bound(const Place& place, const CoverPolygon& polygon) const
{
    Rectangle around;
    for (int i = 0; i < polygon.size; ++i)
        around.add(polygon.vertex[i].at);
    const SecondDerivative second = second_derivative(pieces_.view(piece_), around.middle());
    const TriangleCorners t = mesh_.corners(place.face);
    const Vec3& n = mesh_.normals[place.face];
    // The partner need not be the combination of the m_k: it may go along with what S does across
    // n, as long as that keeps it in the triangle, which holds if the middle control point of the
    // quadratic it then is lies there.
    const auto bend = [&](const CoverVertex& a, const CoverVertex& b) {
        const Vec3 q = 0.5 * second.of(b.at - a.at);
        const Vec3 middle = 0.5 * (a.partner + b.partner - (q - dot(n, q) * n));
        const Vec3 kept = t.at(closest_on_triangle(middle, t));
        return q + (2.0 * kept - a.partner - b.partner);
    };
    PartBound out = fan_bound(
        polygon, n, [](const CoverVertex& v) { return v.point - v.partner; }, bend);
    out.bound += third_order(pieces_.bounds(piece_), around.size());
    return out;
}

std::optional<MeshTarget::Cut> MeshTarget::cut(const Place& place, int k) const
{
    const Index h = 3 * place.face + static_cast<Index>(k), twin = mesh_.topology.twin(h);
    if (h == place.entry || twin == invalid_index)
        return std::nullopt;
    const Index next = ManifoldMesh::face(twin);
    const Vec3 &from = mesh_.positions[mesh_.topology.from(h)],
               &to = mesh_.positions[mesh_.topology.to(h)];
    // In the planes of the two faces, away from the first and into the second: a face without area
    // leaves the choice to its neighbour. A full fold has no plane between.
    const Vec3 edge = to - from;
    const Vec3 away = cross(edge, mesh_.normals[place.face]) + cross(edge, mesh_.normals[next]);
    const Vec3 normal = normalized(away);
    if (normal == Vec3{})
        return std::nullopt;
    return Cut{{next, twin}, from, normal};
}

CoverVertex MeshTarget::between(const CoverVertex& a, const CoverVertex& b, double t) const
{
    return vertex(lerp(a.at, b.at, t));
}

CoverVertex MeshTarget::vertex(const Vec2& at) const
{
    CoverVertex v;
    v.at = at;
    v.point = pieces_.position(piece_, at);
    return v;
}

SplineTarget::SplineTarget(const PlacedMesh& mesh, const BezierPieces& pieces, Index face)
    : mesh_(mesh), pieces_(pieces), face_(face)
{
}

void SplineTarget::attach(const Place& place, CoverVertex& v) const
{
    const PieceFoot foot = foot_on_piece(pieces_.view(place.piece), v.point, v.foot);
    v.foot = foot.at;
    v.beyond = foot.beyond;
    v.partner = foot.position;
}

void SplineTarget::enter(const Place& place, CoverVertex& v) const
{
    const BezierPieces::Side from = pieces_.across(place);
    v.foot = BezierPieces::on_side(place.side, 1.0 - BezierPieces::along_side(from.side, v.foot));
}

PartBound SplineTarget::bound(const Place& place, const CoverPolygon& polygon) const
{
    Rectangle around;
    for (int i = 0; i < polygon.size; ++i)
        around.add(polygon.vertex[i].foot);
    const SecondDerivative second = second_derivative(pieces_.view(place.piece), around.middle());
    PartBound out = fan_bound(
        polygon, mesh_.normals[face_], [](const CoverVertex& v) { return v.partner - v.point; },
        [&](const CoverVertex& a, const CoverVertex& b) {
            return 0.5 * second.of(b.foot - a.foot);
        });
    out.bound += third_order(pieces_.bounds(place.piece), around.size());
    return out;
}

double SplineTarget::Cut::excess(const CoverVertex& v) const
{
    switch (side) {
    case 0: return -v.beyond.y * speed;
    case 1: return (v.beyond.x - 1.0) * speed;
    case 2: return (v.beyond.y - 1.0) * speed;
    default: return -v.beyond.x * speed;
    }
}

std::optional<SplineTarget::Cut> SplineTarget::cut(const Place& place, int k) const
{
    const Index side = static_cast<Index>(k);
    if (side == place.side)
        return std::nullopt;
    const Place next = pieces_.across({place.piece, side});
    if (next.piece == invalid_index)
        return std::nullopt;
    const DerivativeBounds& b = pieces_.bounds(place.piece);
    return Cut{next, side, side % 2 == 0 ? b.v : b.u};
}

CoverVertex SplineTarget::between(const CoverVertex& a, const CoverVertex& b, double t) const
{
    return vertex(lerp(a.at, b.at, t), lerp(a.foot, b.foot, t));
}

CoverVertex SplineTarget::vertex(const Vec2& at, const Vec2& foot) const
{
    CoverVertex v;
    v.at = at;
    v.foot = foot;
    v.point = mesh_.at(face_, at);
    return v;
}

} // namespace bot2nurbs
