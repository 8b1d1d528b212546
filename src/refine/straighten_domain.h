// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "bot2nurbs/quad_domain.h"

namespace bot2nurbs {

//! Draws the edges of a domain anew, each as the straight line in the map of its two quads: after
//! cuts the edges around a vertex leave it in uneven directions, which no surface that is smooth
//! there can follow. Vertices stay, and so do edges that run along edges of the carrier, as creases
//! and required paths do, and those whose two quads do not make a disk. Quads and vertices keep
//! their numbers. Where a quad would have no map, the domain stays as it is. Errors: invalid_domain
//! as domain_path(), cancelled.
Result<QuadDomain> straighten_domain(const ManifoldMesh& source, QuadDomain domain,
                                     Context& context);

} // namespace bot2nurbs
