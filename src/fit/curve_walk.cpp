// SPDX-License-Identifier: MIT
#include "fit/foot_point.h"

#include <algorithm>
#include <cmath>

namespace bot2nurbs {

namespace {

//! As for the walk over patches: see foot_point.cpp.
constexpr int max_steps = 40;
constexpr int max_halvings = 12;
constexpr double step_share = 1e-11;

} // namespace

struct SurfaceWalk::CurvePlace {
    Index halfedge = invalid_index;
    double t = 0.0; //!< From its start, 0, to its end, 1.

    DomainPoint where() const
    {
        const Index q = QuadComplex::quad_of(halfedge);
        switch (QuadComplex::side_of(halfedge)) {
        case 0: return {q, t, 0.0};
        case 1: return {q, 1.0, t};
        case 2: return {q, 1.0 - t, 1.0};
        default: return {q, 0.0, 1.0 - t};
        }
    }
    //! First and second derivative by t.
    Vec3 velocity(const SurfacePoint& s) const
    {
        const Vec3& d = QuadComplex::side_of(halfedge) % 2 == 0 ? s.du : s.dv;
        return QuadComplex::side_of(halfedge) < 2 ? d : -1.0 * d;
    }
    const Vec3& acceleration(const SurfacePoint& s) const
    {
        return QuadComplex::side_of(halfedge) % 2 == 0 ? s.duu : s.dvv;
    }
};

std::optional<SurfaceWalk::CurvePlace> SurfaceWalk::place_on_curve(const DomainPoint& w) const
{
    const bool on[4] = {w.v <= 0.0, w.u >= 1.0, w.v >= 1.0, w.u <= 0.0};
    const double along[4] = {w.u, w.v, 1.0 - w.u, 1.0 - w.v};
    for (Index s = 0; s < 4; ++s)
        if (on[s] && complex_.is_sharp(complex_.edge(4 * w.quad + s)))
            return CurvePlace{4 * w.quad + s, along[s]};
    return std::nullopt;
}

std::optional<SurfaceWalk::CurvePlace> SurfaceWalk::beyond(Index vertex, Index edge) const
{
    if (complex_.is_corner(vertex))
        return std::nullopt;
    // A vertex is smooth when it has two sharp edges and no run of quads between them is a single
    // one (see find_fans).
    std::optional<CurvePlace> other;
    std::vector<Index> at; // Numbers of the sharp edges, counted around the vertex.
    Index quads = 0;
    const auto look = [&](Index h, double t) {
        const Index e = complex_.edge(h);
        if (!complex_.is_sharp(e))
            return;
        at.push_back(quads);
        if (e != edge)
            other = CurvePlace{h, t};
    };
    const Index first = complex_.halfedge_at(vertex);
    Index h = first;
    do {
        look(h, 0.0);
        ++quads;
        const Index last = QuadComplex::prev(h);
        h = complex_.twin(last);
        if (h == invalid_index)
            look(last, 1.0);
    } while (h != invalid_index && h != first);
    if (at.size() != 2 || at[1] - at[0] < 2 || (h == first && quads - (at[1] - at[0]) < 2))
        return std::nullopt;
    return other;
}

Vec3 SurfaceWalk::curve_tangent(const FootPoint& foot) const
{
    const std::optional<CurvePlace> place = place_on_curve(foot.where);
    if (!place)
        return {};
    const Index h = place->halfedge;
    for (const double end : {0.0, 1.0})
        if (place->t == end &&
            !beyond(end == 0.0 ? complex_.from(h) : complex_.to(h), complex_.edge(h)))
            return {};
    return normalized(place->velocity(foot.surface));
}

FootPoint SurfaceWalk::descend_along_curve(const Vec3& p, const DomainPoint& start) const
{
    CurvePlace at = *place_on_curve(start);
    FootPoint best;
    const auto evaluate = [&](const CurvePlace& place) {
        FootPoint foot;
        foot.where = place.where();
        foot.surface = surface_.evaluate(foot.where);
        foot.distance = norm(foot.surface.position - p);
        return foot;
    };
    best = evaluate(at);
    const auto end_vertex = [&](const CurvePlace& place) {
        return place.t == 0.0 ? complex_.from(place.halfedge) : complex_.to(place.halfedge);
    };
    if ((at.t == 0.0 || at.t == 1.0) && !beyond(end_vertex(at), complex_.edge(at.halfedge)))
        return best;
    for (int n = 0; n < max_steps; ++n) {
        const Vec3 r = best.surface.position - p, x1 = at.velocity(best.surface);
        const double slope = dot(r, x1), speed = dot(x1, x1);
        const double bend = speed + dot(r, at.acceleration(best.surface));
        // Newton's step where the distance is convex, else Gauss and Newton's.
        const double step = bend > 0.0 ? -slope / bend : speed > 0.0 ? -slope / speed : 0.0;
        if (!(std::fabs(step) * std::sqrt(speed) > step_share * diagonal_))
            break;
        // At an end the curve may go on along another edge.
        if ((at.t == 0.0 && step < 0.0) || (at.t == 1.0 && step > 0.0)) {
            const auto next = beyond(end_vertex(at), complex_.edge(at.halfedge));
            if (!next)
                break;
            at = *next;
            best = evaluate(at);
            // There too the way may lead back: then the vertex is the foot.
            const double onward = dot(best.surface.position - p, at.velocity(best.surface));
            if (at.t == 0.0 ? onward >= 0.0 : onward <= 0.0)
                break;
            continue;
        }
        bool moved = false;
        double share = 1.0;
        for (int k = 0; k < max_halvings && !moved; ++k, share *= 0.5) {
            CurvePlace next = at;
            next.t = std::clamp(at.t + share * step, 0.0, 1.0);
            const FootPoint foot = evaluate(next);
            if (foot.distance < best.distance) {
                at = next;
                best = foot;
                moved = true;
            }
        }
        if (!moved)
            break;
    }
    return best;
}

} // namespace bot2nurbs
