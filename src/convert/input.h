// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/convert.h"
#include "bot2nurbs/repair_mesh.h"

#include <optional>
#include <string>
#include <vector>

namespace bot2nurbs {

//! An input that can be converted: manifold components, and what was found on the way.
struct PreparedInput {
    RepairedMesh mesh;
    MeshReport found; //!< Of the file as it is.
    Index vertices = 0, faces = 0;
    std::string units; //!< As the file says; may be empty.
};

//! open_mesh where a component is open: names the boundary loops by their first vertices in the
//! numbering of the input.
std::optional<Error> refuse_open(const RepairedMesh& mesh);

//! Stages "read", "check" and "repair". Errors: those of read_mesh and repair_mesh, and
//! bad_geometry where a repair is needed and options.repair is off; open_mesh; self_intersecting.
Result<PreparedInput> prepare_input(const ConvertOptions& options, Context& context);

} // namespace bot2nurbs
