// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/deviation.h"
#include "bot2nurbs/quad_domain.h"
#include "bot2nurbs/spline_network.h"

#include <optional>
#include <vector>

namespace bot2nurbs {

//! How far a curve of the source and the same curve of the surface are apart.
struct CurveDeviation {
    Index edges = 0;     //!< Of the domain.
    double length = 0.0; //!< On the source.
    DistanceStatistics source_to_surface, surface_to_source;
};

//! The curves of a surface with boundary or creases.
struct CurveDeviations {
    std::vector<CurveDeviation> boundary;  //!< Of each boundary loop, by its first domain edge.
    std::optional<CurveDeviation> creases; //!< Of all creases together.
};

//! Two-sided distances between the boundary loops and creases of a domain, which are polylines on
//! the source, and the curves of the surface they became. The curves are taken as polylines of 64
//! segments a Bezier piece, so that distances are good to about 1e-4 of the height of a piece over
//! its chord. Cost O(n log n) in segments.
CurveDeviations measure_curves(const QuadDomain& domain, const SplineSurface& surface);

} // namespace bot2nurbs
