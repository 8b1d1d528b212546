// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/quad_complex.h"

#include <vector>

namespace bot2nurbs {

//! Marks edges that would be left too long beside those that are cut.
//!
//! Patches around a smooth vertex have one parametrization, up to a linear map: edges that are
//! opposite to each other there get derivatives of about one length, however long the edges are.
//! Where one is many times longer the surface overshoots and folds in the patches at the other.
//! So at every vertex of the given quads, and where this marks more edges, an edge is marked when
//! it is more than three times as long as the longer of those opposite to it, of which marked ones
//! count half. Vertices on boundaries and creases are left, as patches end there.
//! `lengths` and `marks` have an entry per edge. Cost O(valence) a vertex and mark.
void grade_marks(const QuadComplex& complex, const std::vector<double>& lengths,
                 const std::vector<Index>& quads, std::vector<char>& marks);

} // namespace bot2nurbs
