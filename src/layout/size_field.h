// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "bot2nurbs/manifold_mesh.h"

#include <vector>

namespace bot2nurbs {

//! What the shape asks of a layout: where it bends, and how much in all.
struct SizeField {
    //! Per vertex: how much narrower than average patches should be there; 1 on average.
    std::vector<double> density;
    //! Integral of k1^2 + k2^2 over the surface, at the scale of `smoothing`: 8 pi for any sphere.
    double bending = 0.0;
};

//! Area of a mesh in the metric scaled by a density per vertex.
double scaled_area(const ManifoldMesh& mesh, const std::vector<double>& density);

//! Curvature from vertex normals, smoothed over the length `smoothing` so that it follows the shape
//! and not the noise of its sampling. Of no use when cancelled. Cost O(n).
SizeField measure_size_field(const ManifoldMesh& mesh, double smoothing, const Context& context);

} // namespace bot2nurbs
