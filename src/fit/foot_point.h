// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/spline_network.h"

#include <optional>

namespace bot2nurbs {

//! The foot of a point on a spline surface.
struct FootPoint {
    DomainPoint where;
    SurfacePoint surface; //!< Position and derivatives there.
    double distance = 0.0;
};

//! True when the place lies on a boundary or crease edge.
bool on_sharp_edge(const QuadComplex& complex, const DomainPoint& where);

//! Local closest-point search on a spline surface that walks over patch edges.
//!
//! Guarantees: 1. the result is not farther from the point than the start; 2. at most
//! `max_steps` evaluations of a Newton step, so it ends; 3. a start on an edge or vertex is
//! continued in whichever patch the descent leads into, around vertices of any valence.
//! Thread-safe: nothing is stored.
class SurfaceWalk {
public:
    //! Both must outlive the walk.
    SurfaceWalk(const QuadComplex& complex, const SplineSurface& surface);

    //! Descends from `start` to a local minimum of the distance to p. Cost: about three to six
    //! evaluations from a start near the foot.
    FootPoint descend(const Vec3& p, const DomainPoint& start) const;

    //! The same along the curve of sharp edges (boundary or crease) on which `start` lies: through
    //! vertices where the curve is smooth, ending at those where it is not. A start in such a
    //! vertex stays there. \pre on_sharp_edge(start)
    FootPoint descend_along_curve(const Vec3& p, const DomainPoint& start) const;

    //! Unit tangent of the curve at a place on it; zero at vertices where curves end or turn.
    Vec3 curve_tangent(const FootPoint& foot) const;

private:
    struct Move;

    //! All names of a place: one inside a patch, two on an edge, one a quad at a vertex.
    void names(const DomainPoint& where, std::vector<DomainPoint>& out) const;
    Move choose_move(const Vec3& p, FootPoint& at, std::vector<DomainPoint>& scratch) const;
    //! A place on a curve: parameter t along a halfedge of a sharp edge.
    struct CurvePlace;
    std::optional<CurvePlace> place_on_curve(const DomainPoint& where) const;
    //! The sharp edge on which a curve goes on beyond the start of a halfedge, as the halfedge that
    //! leaves that vertex or arrives there; none where it ends or turns.
    std::optional<CurvePlace> beyond(Index vertex, Index edge) const;

    const QuadComplex& complex_;
    const SplineSurface& surface_;
    double diagonal_; //!< Of the surface's coefficients.
};

} // namespace bot2nurbs
