// SPDX-License-Identifier: MIT
#pragma once

#include "cloud/point_tree.h"

#include <vector>

namespace bot2nurbs {

//! How dense and how noisy a cloud is. Lengths in units of the points.
struct LocalScale {
    //! Per point: square root of the area that a point stands for there, as its neighbours say.
    std::vector<double> spacing;
    std::vector<double> density; //!< Per point, 0 to 1: of its own neighbourhood over theirs.
    double median_spacing = 0.0;
    //! Standard deviation of the points across the surface; of a clean but coarse cloud what
    //! quadratic pieces of the surface leave unexplained.
    double noise = 0.0;
    //! Smallest ratio of what quadratic pieces leave to the radius of their neighbourhood: near 0
    //! where points show a surface, a third where they fill space.
    double noise_ratio = 0.0;
    //! Per point 1 where it lies far away from where its neighbours lie close together.
    std::vector<char> outlier;
};

//! Errors: cancelled. \pre `graph` has at least one neighbour a point
Result<LocalScale> measure_scale(const std::vector<Vec3>& points, const PointTree& tree,
                                 const NeighborGraph& graph, Context& context);

//! The median; the upper one of an even number. \pre not empty
double median_of(std::vector<double> values);

} // namespace bot2nurbs
