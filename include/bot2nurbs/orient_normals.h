// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/estimate_normals.h"

#include <optional>

namespace bot2nurbs {

struct OrientOptions {
    //! Where the scanner stood: it saw every point, so that all normals turn towards it.
    std::optional<Vec3> viewpoint;
    //! Of more points than this an even subset is oriented together, and its neighbours follow.
    Index most_points = 50000;

    std::optional<Error> check() const;
};

struct OrientationSummary {
    Index solved_points = 0; //!< By winding numbers, together; 0 if they were not needed.
    //! Share of the points whose normal contradicts those of most neighbours beside it: see
    //! contradicted_normals().
    double disagreement = 0.0;
};

//! Turns all normals outward. Without a viewpoint, to where winding numbers fall: dipoles at the
//! points are sought whose winding number is one half at every point \cite lin_2024, for all points
//! together, so that thin sheets, cavities and separate bodies come out right. A normal that is
//! more than 30 degrees off that direction becomes it: there the points do not show a plane. Points
//! marked as outliers take no part, but get a sign. Points that all lie in one plane have no
//! inside: their normals turn to one side of it.
//!
//! Cost O(n log n). The same for any thread count. Errors: bad_option, cancelled. \pre `estimate`
//! was made for `points`
Result<OrientationSummary> orient_normals(const std::vector<Vec3>& points,
                                          SurfaceEstimate& estimate, const OrientOptions& options,
                                          Context& context);

//! Per point 1 if more than half of its neighbours beside it (of 12, those in the tangent planes of
//! both) have a normal more than 120 degrees away from its own: one of two such normals is wrong,
//! or sheets lie closer than the points. Zero normals take no part. Errors: cancelled.
Result<std::vector<char>> contradicted_normals(const std::vector<Vec3>& points,
                                               const std::vector<Vec3>& normals, Context& context);

} // namespace bot2nurbs
