// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "bot2nurbs/vec.h"

#include <vector>

namespace bot2nurbs {

//! What the neighbourhoods of points say of the surface they were taken from. One entry of every
//! array per point; lengths in units of the points.
struct SurfaceEstimate {
    std::vector<Vec3> normals; //!< Unit; the sign says nothing yet: see orient_normals().
    //! 0 to 1: how much the position and normal are to be trusted. The product of the separation of
    //! the two smallest variances of the neighbourhood (1 where it is flat, 0 where it is a line or
    //! a ball), of the density relative to the neighbours', and of a weight for the distance to the
    //! neighbourhood's plane (Tukey). 0 for outliers.
    std::vector<double> confidence;
    std::vector<double> spacing; //!< Square root of the area that the point stands for.
    std::vector<char> outlier;   //!< 1: far away from where its neighbours lie close together.
    double median_spacing = 0.0;
    //! Standard deviation of the points across the surface. Of a clean but coarse cloud: what
    //! quadratic pieces of the surface leave unexplained.
    double noise = 0.0;
    //! Smallest ratio of what quadratic pieces leave to the radius of their neighbourhood: near 0
    //! where points show a surface, a third where they fill space.
    double noise_ratio = 0.0;
};

//! Planes through the nearest neighbours of every point, by principal components. A neighbourhood
//! has 12 points, and more where its radius would be less than three standard deviations of the
//! noise, so that its size follows the local density and the noise.
//!
//! Cost O(n log n). The same for any thread count. Errors: bad_geometry (fewer than four points, a
//! coordinate that is not finite), cancelled.
Result<SurfaceEstimate> estimate_normals(const std::vector<Vec3>& points, Context& context);

} // namespace bot2nurbs
