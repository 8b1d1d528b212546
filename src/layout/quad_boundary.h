// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/quad_complex.h"

#include <vector>

namespace bot2nurbs {

//! Whether a vertex is on the boundary of a complex.
inline bool is_boundary_vertex(const QuadComplex& complex, Index v)
{
    return complex.twin(complex.halfedge_at(v)) == invalid_index;
}

//! The boundary loops of a complex, as halfedges in order, the surface to the left; in the order of
//! their smallest halfedges. Cost linear.
std::vector<std::vector<Index>> boundary_loops(const QuadComplex& complex);

} // namespace bot2nurbs
