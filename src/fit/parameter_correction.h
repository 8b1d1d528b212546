// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "fit/foot_point.h"

#include <vector>

namespace bot2nurbs {

//! The feet of all points: each a walk from where the point was before; points that end far from
//! the surface, measured by the median of all, are also sought from scratch over the whole surface
//! and take the nearer foot. `where` holds the starts. Empty when cancelled.
//! Same result for any thread count.
std::vector<FootPoint> correct_parameters(const QuadComplex& complex, const SplineSurface& surface,
                                          const std::vector<Vec3>& points,
                                          const std::vector<DomainPoint>& where,
                                          const std::vector<char>& on_curve,
                                          const Context& context);

//! Median of the values; 0 when there are none.
double median(std::vector<double> values);

} // namespace bot2nurbs
