// SPDX-License-Identifier: MIT
#pragma once

//! The builders of the schemes: unknowns, stencils and constraint rows of a network.

#include "bot2nurbs/spline_network.h"
#include "spline/fans.h"

#include <vector>

namespace bot2nurbs {

//! `fans` are all fans of the complex. Cost linear.
void build_peters(const QuadComplex& complex, const std::vector<Fan>& fans, SplineNetwork& network);
void build_full(const QuadComplex& complex, const std::vector<Fan>& fans, SplineNetwork& network);
//! Errors: invalid_domain, naming a vertex on a boundary or crease.
Status build_eck_hoppe(const QuadComplex& complex, const std::vector<Fan>& fans,
                       SplineNetwork& network);

} // namespace bot2nurbs
