// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/cloud_report.h"
#include "bot2nurbs/context.h"
#include "bot2nurbs/spline_network.h"

#include <vector>

namespace bot2nurbs {

//! Measures surfaces on a grid of 12 x 12 places a patch. Cost O(n log n). Errors: cancelled. The
//! same for any thread count. \pre there are points
Result<SurfaceToPoints> measure_surface_to_points(const std::vector<const SplineSurface*>& surfaces,
                                                  const std::vector<Vec3>& points, double reach,
                                                  Context& context);

} // namespace bot2nurbs
