// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/estimate_normals.h"
#include "bot2nurbs/manifold_mesh.h"

#include <array>
#include <vector>

namespace bot2nurbs {

//! Triangles between points over which balls can roll \cite bernardini_1999: a ball that touches
//! three points and has none inside makes a triangle, and pivots around its edges to the next ones.
//! Radii from small to large, so that dense places keep their detail and sparse ones get closed.
//!
//! Guarantees: every edge has at most two triangles, which agree about its direction, so the
//! surface is oriented and manifold but for vertices where several fans meet; triangles face where
//! the normals of their points do. Outliers take no part.
//!
//! Serial, so the same for any thread count. Cost O(n) queries of O(log n). Errors: cancelled.
//! \pre normals point to one side; at least one point that is no outlier
Result<std::vector<std::array<Index, 3>>>
pivot_balls(const std::vector<Vec3>& points, const SurfaceEstimate& estimate, Context& context);

} // namespace bot2nurbs
