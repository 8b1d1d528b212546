// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "bot2nurbs/point_cloud.h"

#include <vector>

namespace bot2nurbs {

//! Points that differ and are finite, in the order of the cloud.
struct CleanPoints {
    std::vector<Vec3> positions;
    //! Unit length, or zero where the cloud has none that can be used. Empty if it has none at all.
    std::vector<Vec3> normals;
    //! 0 to 1: the cloud's, with its median and above as 1. Empty if it has none.
    std::vector<double> confidence;
    std::vector<Index> source; //!< Per point: its number in the cloud.

    Index not_finite = 0;     //!< Points of the cloud that are not finite.
    Index duplicates = 0;     //!< Points at places where the cloud has another one before.
    Index without_normal = 0; //!< Points whose normal is zero or not finite, if there are others.
};

//! Drops points that are not finite and merges those at one place: their normals are averaged, the
//! largest confidence counts.
//!
//! Cost O(n log n). Errors: bad_geometry (what is left are fewer than 30 points, or all lie on a
//! line: no surface is shown), cancelled.
Result<CleanPoints> clean_points(const PointCloud& cloud, Context& context);

} // namespace bot2nurbs
