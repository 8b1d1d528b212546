// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/manifold_mesh.h"

#include <vector>

namespace bot2nurbs {

//! Which closed meshes lie inside which others.
struct Nesting {
    std::vector<Index> depth;  //!< Number of other closed meshes around each; 0 for open ones.
    std::vector<Index> parent; //!< The innermost of these, or invalid_index.
};

//! A mesh lies inside another when its box does and a vertex of it does; vertices that lie on the
//! other's surface say nothing and are passed over. The orientation of the meshes does not matter.
//! Cost O(F log F) in practice.
Nesting find_nesting(const std::vector<const ManifoldMesh*>& meshes);

} // namespace bot2nurbs
