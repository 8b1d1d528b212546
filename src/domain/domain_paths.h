// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/quad_domain.h"
#include "maps/surface_path.h"

namespace bot2nurbs {

//! The edge of a domain as a path over its carrier: finds the face each stretch lies on.
//! Errors: invalid_domain naming the edge, when two consecutive points share no face.
Result<SurfacePath> domain_path(const QuadDomain& domain, Index edge);

//! The reverse: a path as the inner points of a domain edge.
std::vector<PathPoint> path_points(const ManifoldMesh& mesh, const SurfacePath& path);

} // namespace bot2nurbs
