// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/import_quads.h"
#include "bot2nurbs/repair_mesh.h"
#include "bot2nurbs/report.h"

#include <string>
#include <vector>

namespace bot2nurbs {

//! The quad mesh of each component of the input, from a file: of its connected pieces the nearest
//! one. Errors: those of read_polygons and split_quads; invalid_domain where a component has none,
//! or a piece is left over.
Result<std::vector<QuadMesh>> quads_of_components(const std::string& path, const RepairedMesh& mesh,
                                                  Context& context);

//! Warns of edges of quads that take a long way over the mesh: it is another shape there.
void add_detour_warnings(ConvertReport& report);

} // namespace bot2nurbs
