// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/convert.h"
#include "bot2nurbs/domain_constraints.h"
#include "bot2nurbs/import_quads.h"
#include "bot2nurbs/repair_mesh.h"

#include <optional>
#include <string>
#include <vector>

namespace bot2nurbs {

//! One component's way from its mesh to B-Reps.
struct ConvertedComponent {
    ComponentOutcome outcome;
    QuadDomain domain; //!< On the normalised mesh; its signature is the component's own.
    DomainConstraints constraints; //!< What the layout kept to and chose.
    SplineSurface surface;         //!< In the coordinates of the input.
    std::vector<Brep> breps;       //!< One for each of the knot forms asked for, in their order.
};

//! What the caller says of one component's domain.
struct DomainWishes {
    std::optional<QuadDomain> supplied; //!< Replaces the automatic layout.
    std::optional<QuadMesh> quads;      //!< Become it, in the coordinates of the input.
    DomainConstraints constraints;      //!< Bind the automatic layout.
    //! Largest distance wanted, in units of the input: refines the domain.
    std::optional<double> tolerance;
};

//! Converts one component. No knot forms asked for: stops after the domain. `stage_suffix` is added
//! to the names of the stages.
Result<ConvertedComponent> convert_component(const MeshComponent& component, DomainWishes wishes,
                                             const ConvertOptions& options,
                                             const std::vector<KnotForm>& forms,
                                             const std::string& stage_suffix, Context& context);

} // namespace bot2nurbs
