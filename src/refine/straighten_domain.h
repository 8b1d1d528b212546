// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "bot2nurbs/quad_domain.h"

namespace bot2nurbs {

//! Draws the edges of a domain anew, each as the straight line in the map of its two quads: after
//! cuts the edges around a vertex leave it in uneven directions, which no surface that is smooth
//! there can follow. Vertices stay, and so do edges that run along edges of the carrier, as creases
//! and required paths do. Quads and vertices keep their numbers. Errors: cancelled.
Result<QuadDomain> straighten_domain(QuadDomain domain, Context& context);

} // namespace bot2nurbs
