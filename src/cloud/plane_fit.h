// SPDX-License-Identifier: MIT
#pragma once

#include "cloud/point_tree.h"

#include <array>
#include <vector>

namespace bot2nurbs {

//! The plane through points by least squares, and how flat they lie.
struct PlaneFit {
    Vec3 centroid;
    std::array<Vec3, 3> axes;          //!< Orthonormal; axes[0] is the normal, of either sign.
    std::array<double, 3> variances{}; //!< Mean squares along the axes, ascending.
};

//! \pre at least one point
PlaneFit fit_plane(const std::vector<Vec3>& points, const PointTree::Neighbor* found,
                   std::size_t count);

//! Root mean square distance across the best quadratic height field over the plane, corrected for
//! its six coefficients: curvature of the surface does not count as noise. Infinite for fewer than
//! seven points.
double quadric_residual(const std::vector<Vec3>& points, const PointTree::Neighbor* found,
                        std::size_t count, const PlaneFit& plane);

} // namespace bot2nurbs
