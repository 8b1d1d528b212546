// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "bot2nurbs/vec.h"

#include <array>
#include <cstdint>
#include <vector>

namespace bot2nurbs {

//! True when the triangles abc and def have inner points in common: they cross or, in one plane,
//! overlap. Touching is not crossing, so neighbours in a mesh need no special case: they cross only
//! when folded onto each other or when they meet beyond what they share. Triangles without area
//! have no inner points. Exact as orient3d.
bool triangles_cross(const std::array<Vec3, 3>& t, const std::array<Vec3, 3>& s);

struct SelfIntersections {
    std::uint64_t count = 0;
    //! The first of those found, ascending, smaller face first.
    std::vector<std::array<Index, 2>> pairs;
    bool complete = true; //!< False when cancelled or cut short because of too many pairs.
};

//! All pairs of triangles that cross, by triangles_cross. Pairs with the same three positions are
//! duplicates, not crossings, and left out. Needs no topology: soups are fine. Result does not
//! depend on the number of threads. Cost O(F log F + candidate pairs); a search that meets an
//! absurd number of candidates stops early.
SelfIntersections find_self_intersections(const std::vector<Vec3>& positions,
                                          const std::vector<std::array<Index, 3>>& triangles,
                                          Index kept_pairs, Context& context);

} // namespace bot2nurbs
