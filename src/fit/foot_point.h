// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/spline_network.h"

namespace bot2nurbs {

//! The foot of a point on a spline surface.
struct FootPoint {
    DomainPoint where;
    SurfacePoint surface; //!< Position and derivatives there.
    double distance = 0.0;
};

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

    //! True when the place lies on a boundary or crease edge.
    bool on_sharp_edge(const DomainPoint& where) const;

private:
    struct Move;

    //! All names of a place: one inside a patch, two on an edge, one a quad at a vertex.
    void names(const DomainPoint& where, std::vector<DomainPoint>& out) const;
    Move choose_move(const Vec3& p, FootPoint& at, std::vector<DomainPoint>& scratch) const;

    const QuadComplex& complex_;
    const SplineSurface& surface_;
    double diagonal_; //!< Of the surface's coefficients.
};

} // namespace bot2nurbs
