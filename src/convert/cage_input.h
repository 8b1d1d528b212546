// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/quad_domain.h"
#include "convert/input.h"

#include <vector>

namespace bot2nurbs {

//! A cage as an input: the surface of each connected piece, and its domain.
struct PreparedCage {
    PreparedInput input; //!< Vertices and faces are those of the file; nothing is checked for
                         //!< crossing itself.
    std::vector<QuadDomain> domains; //!< Per component.
};

//! Stages "read" and "subdivide". Errors: those of read_polygons, split_quads and cage_surface;
//! open_mesh.
Result<PreparedCage> prepare_cage(const ConvertOptions& options, Context& context);

} // namespace bot2nurbs
