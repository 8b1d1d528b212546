// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/closest_point.h"
#include "bot2nurbs/spline_network.h"
#include "fit/foot_point.h"

#include <optional>

namespace bot2nurbs {

//! Closest points on a spline surface from scratch: a box tree over a tessellation finds where to
//! start, a walk finds the foot. Thread-safe queries of cost O(log P).
class SurfaceLocator {
public:
    //! `cells` tessellation cells per Bezier piece and direction. \pre the surface has a patch.
    //! Both arguments must outlive the locator. It must not be used when `context` was cancelled
    //! meanwhile.
    SurfaceLocator(const QuadComplex& complex, const SplineSurface& surface, Index cells,
                   const Context* context = nullptr);

    //! The foot of p.
    FootPoint closest(const Vec3& p) const;
    //! The foot of p if the tessellation comes within `limit` of it.
    std::optional<FootPoint> closest_within(const Vec3& p, double limit) const;

    const SurfaceWalk& walk() const { return walk_; }

private:
    DomainPoint place(const SourcePoint& where) const;

    Index side_; //!< Cells per patch and direction.
    SurfaceWalk walk_;
    ClosestPoint tree_;
};

} // namespace bot2nurbs
