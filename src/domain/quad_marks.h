// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/quad_complex.h"

#include <optional>
#include <vector>

namespace bot2nurbs {

//! The corner that no marked side of a quad meets, when exactly two adjacent sides are marked.
std::optional<Index> turned_corner(const QuadComplex& complex, const std::vector<char>& marks,
                                   Index quad);

//! How many sides of a quad are marked.
Index marked_sides(const QuadComplex& complex, const std::vector<char>& marks, Index quad);

} // namespace bot2nurbs
