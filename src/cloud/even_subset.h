// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/result.h"
#include "bot2nurbs/vec.h"

#include <vector>

namespace bot2nurbs {

//! About `count` of the points, at most so many, spread as densely as all of them are: one from the
//! middle of each cell of a kd-tree with equally many points a cell. Ascending. Cost O(n log n).
std::vector<Index> even_subset(const std::vector<Vec3>& points, std::size_t count);

} // namespace bot2nurbs
