// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/manifold_mesh.h"

#include <vector>

namespace bot2nurbs {

//! The boundary of a mesh as loops of vertices, the surface to the left; each starts at its
//! smallest vertex, and loops come in the order of these. Cost linear.
std::vector<std::vector<Index>> boundary_loops(const ManifoldMesh& mesh);

} // namespace bot2nurbs
