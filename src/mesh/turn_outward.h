// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/repair_mesh.h"

namespace bot2nurbs {

//! Finds which closed components surround which, and turns those with a negative volume outward,
//! but for cavities; see repair_mesh(). Adds the notes turned_outward, nested_solid and no_volume;
//! the last two replace earlier ones. `distance`: closed components thinner than this enclose none.
void turn_outward(RepairedMesh& mesh, double distance);

} // namespace bot2nurbs
