// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/manifold_mesh.h"
#include "cloud/octree.h"
#include "cloud/poisson_system.h"

namespace bot2nurbs {

//! The level set function == function.surface as triangles, in the unit cube, turned to where the
//! function falls. Marching cubes on the leaves: where a leaf touches smaller ones, its border is
//! cut along the faces of these.
//!
//! 1. The mesh is closed, oriented and two-manifold: every edge of a leaf that changes sign carries
//!    one vertex, and the leaves' borders agree on how vertices are joined across every face.
//! 2. Vertices keep a tenth of their edge's length away from its ends, so that no triangle
//!    degenerates where the surface passes through a corner; they are wrong by no more than that.
//! 3. The same for any thread count.
//!
//! Errors: cancelled. \pre the function does not reach `surface` on the border of the cube
Result<TriangleSoup> octree_surface(const Octree& tree, const OctreeFunction& function,
                                    const Context& context);

} // namespace bot2nurbs
