// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/convert.h"
#include "bot2nurbs/domain_constraints.h"
#include "bot2nurbs/import_quads.h"
#include "bot2nurbs/repair_mesh.h"
#include "convert/cloud_input.h"

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

    //! For an input of points: their distances from the surface, in units of the input, and the
    //! samples of the mesh that stand in where there are no points.
    std::vector<double> point_distances;
    Index anchors = 0;
};

//! What the caller says of one component's domain.
struct DomainWishes {
    std::optional<QuadDomain> supplied; //!< Replaces the automatic layout.
    std::optional<QuadMesh> quads;      //!< Become it, in the coordinates of the input.
    DomainConstraints constraints;      //!< Bind the automatic layout.
    //! Largest distance wanted, in units of the input: refines the domain.
    std::optional<double> tolerance;
};

//! Converts one component. No knot forms asked for: stops after the domain. `points`, unless null,
//! are what the surface is fitted to in place of the mesh, in units of the input. `stage_suffix` is
//! added to the names of the stages.
Result<ConvertedComponent> convert_component(const MeshComponent& component, DomainWishes wishes,
                                             const PointData* points, const ConvertOptions& options,
                                             const std::vector<KnotForm>& forms,
                                             const std::string& stage_suffix, Context& context);

} // namespace bot2nurbs
