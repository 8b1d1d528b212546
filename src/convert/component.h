// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/convert.h"
#include "bot2nurbs/import_quads.h"
#include "bot2nurbs/repair_mesh.h"

#include <optional>
#include <string>
#include <vector>

namespace bot2nurbs {

//! One component's way from its mesh to B-Reps.
struct ConvertedComponent {
    ComponentOutcome outcome;
    QuadDomain domain;       //!< On the normalised mesh; its signature is the component's own.
    SplineSurface surface;   //!< In the coordinates of the input.
    std::vector<Brep> breps; //!< One for each of the knot forms asked for, in their order.
};

//! What replaces the automatic layout of a component, if anything.
struct SuppliedLayout {
    std::optional<QuadDomain> domain;
    std::optional<QuadMesh> quads; //!< In the coordinates of the input.
};

//! Converts one component. No knot forms asked
//! for: stops after the domain. `stage_suffix` is added to the names of the stages.
Result<ConvertedComponent> convert_component(const MeshComponent& component,
                                             SuppliedLayout supplied, const ConvertOptions& options,
                                             const std::vector<KnotForm>& forms,
                                             const std::string& stage_suffix, Context& context);

} // namespace bot2nurbs
