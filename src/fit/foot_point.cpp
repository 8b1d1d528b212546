// SPDX-License-Identifier: MIT
#include "fit/foot_point.h"

#include <algorithm>
#include <cmath>

namespace bot2nurbs {

namespace {

//! A walk crosses a few patches at most and Newton's method converges in a few steps; a search that
//! needs more is creeping in a flat valley and is good enough where it stands.
constexpr int max_steps = 40;
//! Halvings of a step before the place counts as a minimum: 2^-12 of a Newton step that does not
//! descend is rounding.
constexpr int max_halvings = 12;
//! Steps end the search below this share of the surface's diagonal: Newton's method converges
//! quadratically, so the foot is then as exact as rounding lets it be.
constexpr double step_share = 1e-11;
//! A whole step of Newton's method shorter than this share of the diagonal is the last one: what is
//! left after it is of the order of its square.
constexpr double last_newton_share = 1e-6;
//! A move onto an edge that is shorter than this in parameters is made without asking for descent,
//! which rounding would hide.
constexpr double snap = 1e-9;
//! Below this ratio of determinant to squared trace a 2 x 2 system counts as singular.
constexpr double singular = 1e-12;

struct Direction {
    double u = 0.0, v = 0.0;
};

//! Solves [a b; b c] d = -g. \return false when it is not safely positive definite.
bool solve_step(double a, double b, double c, double gu, double gv, Direction& d)
{
    const double det = a * c - b * b, trace = a + c;
    if (!(trace > 0.0) || !(det > singular * trace * trace))
        return false;
    d = {(b * gv - c * gu) / det, (b * gu - a * gv) / det};
    return true;
}

//! Inside the parameter square for a positive step, however small.
bool points_inside(const DomainPoint& w, const Direction& d)
{
    return !(w.u <= 0.0 && d.u < 0.0) && !(w.u >= 1.0 && d.u > 0.0) && !(w.v <= 0.0 && d.v < 0.0) &&
           !(w.v >= 1.0 && d.v > 0.0);
}

Direction gauss_newton(const SurfacePoint& s, double gu, double gv)
{
    const double a = dot(s.du, s.du), b = dot(s.du, s.dv), c = dot(s.dv, s.dv);
    Direction d;
    if (solve_step(a, b, c, gu, gv, d))
        return d;
    // Degenerate tangents: steepest descent with the larger speed.
    const double speed = std::max(a, c);
    return speed > 0.0 ? Direction{-gu / speed, -gv / speed} : Direction{};
}

//! Newton's step where the Hessian is positive definite, else Gauss and Newton's.
//! `quadratic` says which.
Direction newton(const SurfacePoint& s, const Vec3& r, double gu, double gv, bool& quadratic)
{
    Direction d;
    const double a = dot(s.du, s.du) + dot(r, s.duu), b = dot(s.du, s.dv) + dot(r, s.duv),
                 c = dot(s.dv, s.dv) + dot(r, s.dvv);
    quadratic = solve_step(a, b, c, gu, gv, d);
    return quadratic ? d : gauss_newton(s, gu, gv);
}

//! Place at parameter t along side s, from corner s to corner s + 1.
DomainPoint on_side(Index h, double t)
{
    const Index q = QuadComplex::quad_of(h);
    switch (QuadComplex::side_of(h)) {
    case 0: return {q, t, 0.0};
    case 1: return {q, 1.0, t};
    case 2: return {q, 1.0 - t, 1.0};
    default: return {q, 0.0, 1.0 - t};
    }
}

} // namespace

//! A descent step from a place in one of its patches.
struct SurfaceWalk::Move {
    Direction step;
    bool any = false;
    bool quadratic = false; //!< A step of Newton's method.
};

SurfaceWalk::SurfaceWalk(const QuadComplex& complex, const SplineSurface& surface)
    : complex_(complex), surface_(surface)
{
    Box3 box;
    for (const Vec3& b : surface.bezier())
        box.add(b);
    diagonal_ = box.diagonal();
}

void SurfaceWalk::names(const DomainPoint& w, std::vector<DomainPoint>& out) const
{
    out.assign(1, w);
    const bool u_end = w.u <= 0.0 || w.u >= 1.0, v_end = w.v <= 0.0 || w.v >= 1.0;
    if (u_end && v_end) {
        const Index corner = w.v <= 0.0 ? (w.u <= 0.0 ? 0 : 1) : (w.u <= 0.0 ? 3 : 2);
        const Index start = 4 * w.quad + corner;
        Index h = start;
        // Counter-clockwise, then, if a boundary stopped the turn, clockwise from the start.
        for (h = complex_.rotate_ccw(start); h != invalid_index && h != start;
             h = complex_.rotate_ccw(h))
            out.push_back(on_side(h, 0.0));
        if (h == start)
            return;
        for (h = complex_.twin(start); h != invalid_index;) {
            const Index around = QuadComplex::next(h);
            out.push_back(on_side(around, 0.0));
            h = complex_.twin(around);
        }
        return;
    }
    if (!u_end && !v_end)
        return;
    const Index side = v_end ? (w.v <= 0.0 ? 0 : 2) : (w.u <= 0.0 ? 3 : 1);
    const Index twin = complex_.twin(4 * w.quad + side);
    if (twin == invalid_index)
        return;
    const double along[4] = {w.u, w.v, 1.0 - w.u, 1.0 - w.v};
    out.push_back(on_side(twin, 1.0 - along[side]));
}

bool on_sharp_edge(const QuadComplex& complex, const DomainPoint& w)
{
    const bool on[4] = {w.v <= 0.0, w.u >= 1.0, w.v >= 1.0, w.u <= 0.0};
    for (Index s = 0; s < 4; ++s)
        if (on[s] && complex.is_sharp(complex.edge(4 * w.quad + s)))
            return true;
    return false;
}

SurfaceWalk::Move SurfaceWalk::choose_move(const Vec3& p, FootPoint& at,
                                           std::vector<DomainPoint>& scratch) const
{
    const Vec3 r = at.surface.position - p;
    const double gu = dot(r, at.surface.du), gv = dot(r, at.surface.dv);
    bool quadratic = false;
    const Direction first = newton(at.surface, r, gu, gv, quadratic);
    if (points_inside(at.where, first))
        return {first, true, quadratic};
    names(at.where, scratch);
    // Gauss and Newton's step is the tangent plane's nearest point, whatever the parametrisation:
    // where the surface is G1 it leads into exactly one of the patches around the place.
    Move slide;
    double slide_decrease = 0.0;
    FootPoint slide_from = at;
    for (const DomainPoint& name : scratch) {
        const SurfacePoint s =
            name.quad == at.where.quad && name.u == at.where.u && name.v == at.where.v
                ? at.surface
                : surface_.evaluate(name);
        const Vec3 rn = s.position - p;
        const double nu = dot(rn, s.du), nv = dot(rn, s.dv);
        Direction d = gauss_newton(s, nu, nv);
        if (points_inside(name, d)) {
            const Direction better = newton(s, rn, nu, nv, quadratic);
            at.where = name;
            at.surface = s;
            return {points_inside(name, better) ? better : d, true};
        }
        // No way in: along the sides of this patch (creases, boundaries, rounding).
        const double uu = dot(s.du, s.du), vv = dot(s.dv, s.dv);
        const Direction sides[2] = {{uu > 0.0 ? -nu / uu : 0.0, 0.0},
                                    {0.0, vv > 0.0 ? -nv / vv : 0.0}};
        const double decrease[2] = {uu > 0.0 ? nu * nu / uu : 0.0, vv > 0.0 ? nv * nv / vv : 0.0};
        for (int k = 0; k < 2; ++k)
            if (decrease[k] > slide_decrease && points_inside(name, sides[k])) {
                slide_decrease = decrease[k];
                slide = {sides[k], true};
                slide_from.where = name;
                slide_from.surface = s;
            }
    }
    at.where = slide_from.where;
    at.surface = slide_from.surface;
    return slide;
}

FootPoint SurfaceWalk::descend(const Vec3& p, const DomainPoint& start) const
{
    FootPoint at;
    at.where = {start.quad, std::clamp(start.u, 0.0, 1.0), std::clamp(start.v, 0.0, 1.0)};
    at.surface = surface_.evaluate(at.where);
    double square = norm_squared(at.surface.position - p);
    FootPoint best = at;
    double best_square = square;
    std::vector<DomainPoint> scratch;
    for (int n = 0; n < max_steps; ++n) {
        const Move move = choose_move(p, at, scratch);
        if (!move.any)
            break;
        const Direction d = move.step;
        const double length = norm(d.u * at.surface.du + d.v * at.surface.dv);
        if (length <= step_share * diagonal_)
            break;
        // The share of the step at which the place leaves the patch, and through which ends.
        const double to_u = d.u > 0.0   ? (1.0 - at.where.u) / d.u
                            : d.u < 0.0 ? -at.where.u / d.u
                                        : INFINITY;
        const double to_v = d.v > 0.0   ? (1.0 - at.where.v) / d.v
                            : d.v < 0.0 ? -at.where.v / d.v
                                        : INFINITY;
        const double exit = std::min(to_u, to_v);
        bool moved = false;
        double share = std::min(1.0, exit);
        const bool last = move.quadratic && share == 1.0 && length <= last_newton_share * diagonal_;
        for (int k = 0; k < max_halvings && !moved; ++k, share *= 0.5) {
            FootPoint next = at;
            next.where.u = std::clamp(at.where.u + share * d.u, 0.0, 1.0);
            next.where.v = std::clamp(at.where.v + share * d.v, 0.0, 1.0);
            if (share == to_u)
                next.where.u = d.u > 0.0 ? 1.0 : 0.0;
            if (share == to_v)
                next.where.v = d.v > 0.0 ? 1.0 : 0.0;
            next.surface = surface_.evaluate(next.where);
            const double next_square = norm_squared(next.surface.position - p);
            const bool onto_edge =
                share == exit && share * std::abs(d.u) < snap && share * std::abs(d.v) < snap;
            if (next_square < square || onto_edge) {
                at = next;
                square = next_square;
                moved = true;
            }
        }
        if (!moved)
            break;
        if (square < best_square) {
            best = at;
            best_square = square;
        }
        if (last)
            break;
    }
    best.distance = std::sqrt(best_square);
    return best;
}

} // namespace bot2nurbs
