// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/import_quads.h"

#include <string>

namespace bot2nurbs {

//! A vertex of a quad mesh for a message: by its number in the polygons it was made of.
std::string vertex_name(const QuadMesh& quads, Index vertex);
//! An edge of its complex, by its ends.
std::string edge_name(const QuadMesh& quads, const QuadComplex& complex, Index edge);

//! Errors: invalid_domain naming a vertex for which there is no spline: an inner one with fewer
//! than three quads, or one with more than a valid domain may have.
Status check_valences(const QuadComplex& complex, const QuadMesh& quads);

} // namespace bot2nurbs
