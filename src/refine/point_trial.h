// SPDX-License-Identifier: MIT
#pragma once

#include "refine/trial.h"

namespace bot2nurbs {

//! What the first `points` samples of a fit, which are points, say of each patch.
void measure_points(const SurfaceSampleSet& samples, std::size_t points,
                    const SplineSurface& surface, std::vector<PatchError>& patches);

//! Largest distance of a point from the mesh.
double distance_of_mesh(const ManifoldMesh& source, const PointData& points);

//! Finds the distances of the points from the surface, each with the patch it is nearest to, and
//! decides which patches have one beyond the limit, or stray from the mesh: where points are
//! sparse, a surface may be anywhere between them. Errors: those of find_point_feet() and
//! bound_hausdorff().
Status prove_points(const FitTarget& target, Trial& trial, Context& context);

} // namespace bot2nurbs
