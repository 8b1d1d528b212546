// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "bot2nurbs/spline_network.h"

#include <vector>

namespace bot2nurbs {

//! How far points lie from a surface. Distances in units of the points.
struct PointDeviation {
    Index points = 0;
    double max = 0.0, rms = 0.0;
    double median = 0.0, percentile_95 = 0.0;
    Index worst = invalid_index; //!< The point with the largest distance.
    //! Points farther than three standard deviations: as the median says those are, but at least
    //! what the caller expects.
    Index far_points = 0;
};

//! A place of the surface that is near a point.
struct PointFoot {
    DomainPoint where;
    double distance = 0.0; //!< From the point; the surface is no farther from it than this.
};

//! The closest places of the surface, each a local minimum of the distance that is sought from
//! where a tessellation is closest. Cost O(n log P). Errors: empty_input (no patch), cancelled.
Result<std::vector<PointFoot>> find_point_feet(const std::vector<Vec3>& points,
                                               const QuadComplex& complex,
                                               const SplineSurface& surface, Context& context);

//! \pre distances are finite
PointDeviation summarise_distances(const std::vector<double>& distances,
                                   double least_deviation = 0.0);

//! Share of the distances that are at most `limit`; 1 if there are none.
double share_within(const std::vector<double>& distances, double limit);

} // namespace bot2nurbs
