// SPDX-License-Identifier: MIT
#include "brep/bezier_pieces.h"

#include "core/parallel.h"
#include "spline/patch_grid.h"

#include <algorithm>
#include <cmath>

namespace bot2nurbs {

namespace {

//! Gauss and Newton's method converges in two or three steps where the point is closer than the
//! piece bends; elsewhere the result need not be exact, as any place will do.
constexpr int foot_steps = 8;
//! After a step below this share of the piece the next one would be a hundredth of it, which
//! changes the distance by less than a millionth of the piece's size.
constexpr double last_step = 0.02;
//! A piece's bounds take about a microsecond.
constexpr std::size_t chunk_pieces = 512;

struct Tangents {
    Vec3 position, du, dv;
};

Tangents tangents(const BezierView& c, const Vec2& at)
{
    const Cubic u0 = bernstein(at.x), u1 = bernstein_d(at.x);
    const Cubic v0 = bernstein(at.y), v1 = bernstein_d(at.y);
    Tangents out;
    for (Index a = 0; a < 4; ++a) {
        const Vec3 w0 = v0[0] * c(a, 0) + v0[1] * c(a, 1) + v0[2] * c(a, 2) + v0[3] * c(a, 3);
        const Vec3 w1 = v1[0] * c(a, 0) + v1[1] * c(a, 1) + v1[2] * c(a, 2) + v1[3] * c(a, 3);
        out.position += u0[a] * w0;
        out.du += u1[a] * w0;
        out.dv += u0[a] * w1;
    }
    return out;
}

//! Gauss and Newton's step from `at`; a coordinate that would leave through the end it is at stays,
//! and the other one moves alone.
Vec2 clamped_step(const Tangents& s, const Vec2& at, const Vec2& free, const Vec3& r)
{
    const bool u_stays = (at.x <= 0.0 && free.x < 0.0) || (at.x >= 1.0 && free.x > 0.0);
    const bool v_stays = (at.y <= 0.0 && free.y < 0.0) || (at.y >= 1.0 && free.y > 0.0);
    const double uu = dot(s.du, s.du), vv = dot(s.dv, s.dv);
    if (u_stays && v_stays)
        return {0.0, 0.0};
    if (u_stays)
        return {0.0, vv > 0.0 ? dot(r, s.dv) / vv : 0.0};
    if (v_stays)
        return {uu > 0.0 ? dot(r, s.du) / uu : 0.0, 0.0};
    return free;
}

//! A free coordinate is beyond an end only if the foot is at that end. Where tangents are nearly
//! parallel (a fold) the search may stop inside, and the tangent plane says nothing about what is
//! next door.
double beyond(double foot, double free)
{
    if (foot > 0.0)
        free = std::max(free, 0.0);
    if (foot < 1.0)
        free = std::min(free, 1.0);
    return free;
}

//! The derivatives are Bezier patches themselves: none is longer than their longest coefficient.
DerivativeBounds derivative_bounds(const BezierView& c)
{
    // Differences of the control points, i times in u and j times in v, in place.
    const auto longest = [&c](Index i, Index j, double factor) {
        Vec3 d[4][4];
        for (Index a = 0; a < 4; ++a)
            for (Index b = 0; b < 4; ++b)
                d[a][b] = c(a, b);
        for (Index n = 0; n < i; ++n)
            for (Index a = 0; a + n < 3; ++a)
                for (Index b = 0; b < 4; ++b)
                    d[a][b] = d[a + 1][b] - d[a][b];
        for (Index n = 0; n < j; ++n)
            for (Index a = 0; a < 4; ++a)
                for (Index b = 0; b + n < 3; ++b)
                    d[a][b] = d[a][b + 1] - d[a][b];
        double square = 0.0;
        for (Index a = 0; a + i < 4; ++a)
            for (Index b = 0; b + j < 4; ++b)
                square = std::max(square, norm_squared(d[a][b]));
        return factor * std::sqrt(square);
    };
    return {longest(1, 0, 3.0),  longest(0, 1, 3.0),  longest(3, 0, 6.0),
            longest(2, 1, 18.0), longest(1, 2, 18.0), longest(0, 3, 6.0)};
}

} // namespace

Vec3 BezierView::position(const Vec2& at) const
{
    const Cubic u = bernstein(at.x), v = bernstein(at.y);
    const BezierView& c = *this;
    Vec3 sum;
    for (Index a = 0; a < 4; ++a)
        sum += u[a] * (v[0] * c(a, 0) + v[1] * c(a, 1) + v[2] * c(a, 2) + v[3] * c(a, 3));
    return sum;
}

PieceFoot foot_on_piece(const BezierView& piece, const Vec3& p, const Vec2& start)
{
    Vec2 at{std::clamp(start.x, 0.0, 1.0), std::clamp(start.y, 0.0, 1.0)};
    PieceFoot best;
    double least = INFINITY;
    for (int n = 0; n < foot_steps; ++n) {
        const Tangents s = tangents(piece, at);
        const Vec3 r = p - s.position;
        const double square = norm_squared(r);
        if (!(square < least)) {
            // Too far: half way back.
            at = {0.5 * (at.x + best.at.x), 0.5 * (at.y + best.at.y)};
            continue;
        }
        least = square;
        const double a = dot(s.du, s.du), b = dot(s.du, s.dv), c = dot(s.dv, s.dv);
        const double gu = dot(r, s.du), gv = dot(r, s.dv), det = a * c - b * b;
        // Parallel or zero tangents: along the gradient, with the larger speed.
        const double speed = std::max(a, c);
        const Vec2 free = det > 0.0     ? Vec2{(c * gu - b * gv) / det, (a * gv - b * gu) / det}
                          : speed > 0.0 ? Vec2{gu / speed, gv / speed}
                                        : Vec2{};
        const Vec2 step = clamped_step(s, at, free, r);
        const Vec2 next{std::clamp(at.x + step.x, 0.0, 1.0), std::clamp(at.y + step.y, 0.0, 1.0)};
        best = {at, at + free, s.position};
        if (!(std::abs(next.x - at.x) + std::abs(next.y - at.y) > last_step)) {
            const Vec3 position = piece.position(next);
            if (norm_squared(p - position) < least)
                best = {next, at + free, position};
            break;
        }
        at = next;
    }
    best.beyond = {beyond(best.at.x, best.beyond.x), beyond(best.at.y, best.beyond.y)};
    return best;
}

SecondDerivative second_derivative(const BezierView& c, const Vec2& at)
{
    const Cubic u0 = bernstein(at.x), u1 = bernstein_d(at.x), u2 = bernstein_dd(at.x);
    const Cubic v0 = bernstein(at.y), v1 = bernstein_d(at.y), v2 = bernstein_dd(at.y);
    SecondDerivative out;
    for (Index a = 0; a < 4; ++a) {
        const Vec3 w0 = v0[0] * c(a, 0) + v0[1] * c(a, 1) + v0[2] * c(a, 2) + v0[3] * c(a, 3);
        const Vec3 w1 = v1[0] * c(a, 0) + v1[1] * c(a, 1) + v1[2] * c(a, 2) + v1[3] * c(a, 3);
        const Vec3 w2 = v2[0] * c(a, 0) + v2[1] * c(a, 1) + v2[2] * c(a, 2) + v2[3] * c(a, 3);
        out.uu += u2[a] * w0;
        out.uv += u1[a] * w1;
        out.vv += u0[a] * w2;
    }
    return out;
}

BezierPieces::BezierPieces(const QuadComplex& complex, const SplineSurface& surface,
                           const Context& context)
    : complex_(complex), surface_(surface), bounds_(count())
{
    for_each_chunk(context, bounds_.size(), chunk_pieces, [&](std::size_t begin, std::size_t end) {
        for (std::size_t piece = begin; piece < end; ++piece)
            bounds_[piece] = derivative_bounds(view(static_cast<Index>(piece)));
    });
}

BezierView BezierPieces::view(Index piece) const
{
    const Index a = piece % pieces_per_patch / pieces_per_side, b = piece % pieces_per_side;
    return {&surface_.bezier(patch(piece), 3 * a, 3 * b), SplineNetwork::grid};
}

BezierPieces::Side BezierPieces::across(const Side& side) const
{
    const Index a = side.piece % pieces_per_patch / pieces_per_side,
                b = side.piece % pieces_per_side;
    constexpr Index last = pieces_per_side - 1;
    const Index opposite = (side.side + 2) % 4;
    switch (side.side) {
    case 0:
        if (b > 0)
            return {side.piece - 1, opposite};
        break;
    case 1:
        if (a < last)
            return {side.piece + pieces_per_side, opposite};
        break;
    case 2:
        if (b < last)
            return {side.piece + 1, opposite};
        break;
    default:
        if (a > 0)
            return {side.piece - pieces_per_side, opposite};
    }
    const Index twin = complex_.twin(4 * patch(side.piece) + side.side);
    if (twin == invalid_index)
        return {};
    // Along the common edge, seen from the other patch.
    const Index along = side.side == 0   ? last - a
                        : side.side == 1 ? last - b
                        : side.side == 2 ? a
                                         : b;
    const auto [i, j] = from_side(QuadComplex::side_of(twin), along, 0, last);
    return {pieces_per_patch * QuadComplex::quad_of(twin) + pieces_per_side * i + j,
            QuadComplex::side_of(twin)};
}

Vec2 BezierPieces::on_side(Index side, double t)
{
    switch (side) {
    case 0: return {t, 0.0};
    case 1: return {1.0, t};
    case 2: return {1.0 - t, 1.0};
    default: return {0.0, 1.0 - t};
    }
}

double BezierPieces::along_side(Index side, const Vec2& at)
{
    switch (side) {
    case 0: return at.x;
    case 1: return at.y;
    case 2: return 1.0 - at.x;
    default: return 1.0 - at.y;
    }
}

DomainPoint BezierPieces::domain_point(Index piece, const Vec2& at)
{
    const Index a = piece % pieces_per_patch / pieces_per_side, b = piece % pieces_per_side;
    return {patch(piece), (a + at.x) / pieces_per_side, (b + at.y) / pieces_per_side};
}

Index BezierPieces::piece_at(const DomainPoint& p)
{
    return pieces_per_patch * p.quad + pieces_per_side * piece_parameter(p.u).piece +
           piece_parameter(p.v).piece;
}

Vec2 BezierPieces::place_in_piece(const DomainPoint& p)
{
    return {piece_parameter(p.u).t, piece_parameter(p.v).t};
}

} // namespace bot2nurbs
