// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/estimate_normals.h"
#include "bot2nurbs/manifold_mesh.h"
#include "bot2nurbs/reconstruct_surface.h"

namespace bot2nurbs {

struct PoissonSurface {
    TriangleSoup mesh; //!< Closed, oriented, manifold; in the coordinates of the points.
    int depth = 0;     //!< Of the octree.
};

//! The screened Poisson surface of oriented points. Cells around a point are as large as the
//! spacing there (within a factor of two), not smaller than twice the noise, and larger where there
//! are more points than options.most_vertices; then halved `halvings` times. Outliers take no part.
//! Errors: bad_geometry (no point takes part, or the surface vanishes), cancelled.
Result<PoissonSurface> poisson_surface(const std::vector<Vec3>& points,
                                       const SurfaceEstimate& estimate,
                                       const ReconstructOptions& options, int halvings,
                                       Context& context);

} // namespace bot2nurbs
