// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "bot2nurbs/quad_domain.h"

namespace bot2nurbs {

//! Draws the edges of a domain anew, `passes` times, each as the straight line in the map of its
//! two quads, as straighten_paths() does. Vertices stay, and so do edges that run along edges of
//! the carrier, as creases and required paths do. Quads, edges and vertices keep their numbers.
//! Errors: invalid_domain as domain_path(), cancelled; the domain is then as it was.
Status straighten_domain(QuadDomain& domain, int passes, Context& context);

} // namespace bot2nurbs
