// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/result.h"
#include "bot2nurbs/vec.h"

#include <vector>

namespace bot2nurbs {

//! Groups of points that hang together by steps of at most `distance`. Returns, for every point,
//! the smallest index of its group (itself when alone). Only points with `chosen` take part; an
//! empty `chosen` means all. Points must be finite. Cost O(n log n) when groups are small.
std::vector<Index> weld_points(const std::vector<Vec3>& points, const std::vector<char>& chosen,
                               double distance);

} // namespace bot2nurbs
