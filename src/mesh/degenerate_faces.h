// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/result.h"
#include "bot2nurbs/vec.h"

#include <array>
#include <vector>

namespace bot2nurbs {

//! True when the triangle is no thicker than `distance`: its height over its longest side.
bool has_no_area(const Vec3& a, const Vec3& b, const Vec3& c, double distance);

//! Triangles whose set of vertices an earlier triangle has already, ascending. Cost O(F log F +
//! V). \pre indices are those of V vertices
std::vector<Index> duplicate_faces(const std::vector<std::array<Index, 3>>& triangles);

struct DegenerateRemoval {
    Index collapsed_edges = 0; //!< Edges of no length drawn together.
    Index flipped_caps = 0;    //!< Corners on the opposite side, which split the face behind it.
    std::vector<Index> kept;   //!< Triangles without area that had to stay, ascending.
};

//! Removes triangles without area from a mesh without tearing it: see repair_mesh, rule 3. Removed
//! triangles become {invalid_index, ...}; a triangle that is cut in two keeps its number for one
//! part and gives the other to the removed cap. Cost O(F) plus local work.
DegenerateRemoval remove_degenerate_faces(const std::vector<Vec3>& positions, double distance,
                                          std::vector<std::array<Index, 3>>& triangles);

} // namespace bot2nurbs
