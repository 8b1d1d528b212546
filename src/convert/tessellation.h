// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "bot2nurbs/manifold_mesh.h"
#include "bot2nurbs/spline_network.h"

#include <string>
#include <vector>

namespace bot2nurbs {

//! One component of what is tessellated; all in the coordinates of the input.
struct TessellationPart {
    const ManifoldMesh* source = nullptr;
    const QuadComplex* complex = nullptr;
    const SplineSurface* surface = nullptr;
};

//! A binary PLY file of a regular grid per patch, for pictures. Patches do not share vertices.
//! Vertex properties: double x y z; float nx ny nz, u v (in the patch), distance (to the source,
//! positive outside); int patch (counted over all parts), valence (of the domain vertex at a
//! patch's corner, else 0). Errors: cancelled.
Result<std::string> tessellation_to_ply(const std::vector<TessellationPart>& parts,
                                        Context& context);

} // namespace bot2nurbs
