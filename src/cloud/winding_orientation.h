// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "bot2nurbs/vec.h"

#include <vector>

namespace bot2nurbs {

//! Outward unit directions at all points: those of dipoles whose winding numbers are one half at
//! every point and fall along the dipoles, found together for the whole cloud \cite lin_2024. They
//! follow the surface down to the spacing of the points; a zero vector where nothing can be said.
//!
//! `spacing` is per point (its square the area that the point stands for; 0 for points that take no
//! part and only get a direction), `noise` the deviation of the points across the surface.
//! Cost O(n log n) for each of 30 rounds. Errors: cancelled. \pre at least one point
Result<std::vector<Vec3>> winding_directions(const std::vector<Vec3>& points,
                                             const std::vector<double>& spacing, double noise,
                                             Context& context);

} // namespace bot2nurbs
