// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/quad_domain.h"
#include "bot2nurbs/repair_mesh.h"

#include <string>
#include <vector>

namespace bot2nurbs {

//! The domains of a file, one for each component of the mesh, proved to be domains up to their
//! charts (which the caller computes anyway). Errors: those of domains_from_json; invalid_domain
//! with the first broken rule; cancelled.
Result<std::vector<QuadDomain>> valid_domains(const std::string& path, const RepairedMesh& mesh,
                                              Context& context);

} // namespace bot2nurbs
