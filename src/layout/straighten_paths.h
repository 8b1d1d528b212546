// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "layout/patch_complex.h"

namespace bot2nurbs {

//! Draws every path between two faces anew, as the straight line in the map of the two to a regular
//! polygon, `passes` times; paths that are fixed, or whose two faces make no disk with distinct
//! corners, stay as they are. Result does not depend on the number of threads. Cost: a map a path
//! and pass.
Status straighten_paths(PatchComplex& complex, int passes, Context& context);

} // namespace bot2nurbs
