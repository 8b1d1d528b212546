// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/domain_constraints.h"
#include "bot2nurbs/quad_domain.h"
#include "bot2nurbs/repair_mesh.h"

#include <string>
#include <vector>

namespace bot2nurbs {

//! The constraints of a file, for each component of the mesh. Errors: those of
//! constraint_list_from_json, with the file's name.
Result<std::vector<DomainConstraints>> read_constraints(const std::string& path,
                                                        const RepairedMesh& mesh);

//! What was asked of a layout and what became of it, as constraints: `asked` with its sites first,
//! the features it was given, and a site with its valence for every other vertex of the domain.
//! A layout under them has the same vertices and the same features.
DomainConstraints constraints_used(const DomainConstraints& asked,
                                   const std::vector<FeaturePath>& features,
                                   const ManifoldMesh& source, const QuadDomain& domain);

} // namespace bot2nurbs
