// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/closest_point.h"
#include "layout/match_curves.h"

#include <vector>

namespace bot2nurbs {

//! Distinct places on the source for the vertices of a quad mesh: those of `match` on their lines,
//! in their order; the others at their closest points on faces that turn towards `normals`, off all
//! stretches of lines that edges follow. Places that would leave slivers move onto the nearby edge
//! or vertex; a vertex that finds its place taken moves towards its neighbours. Weights are exact:
//! they sum to 1 without rounding, so that what is on an edge of the source is on it exactly.
//! Errors: invalid_domain naming the vertex of the quads, where no place near is free.
Result<std::vector<SourcePoint>> quad_places(const ManifoldMesh& source,
                                             const ClosestPoint& closest, const PlacedQuads& quads,
                                             const std::vector<Vec3>& normals,
                                             const CurveMatch& match);

} // namespace bot2nurbs
