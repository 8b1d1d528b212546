// SPDX-License-Identifier: MIT
#pragma once

#include "layout/cut_mesh.h"
#include "layout/patch_complex.h"

namespace bot2nurbs {

//! A complex on a cut mesh as one on the mesh before: the paths on both sides of a cut become one,
//! with the mark of its edges. Faces keep their order.
PatchComplex uncut(const PatchComplex& complex, const CutMesh& cut, const ManifoldMesh& whole,
                   const std::vector<char>& marks);

} // namespace bot2nurbs
