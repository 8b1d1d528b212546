// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/manifold_mesh.h"

#include <array>
#include <vector>

namespace bot2nurbs {

//! Polygons as a file lists them: polygon p has corners first[p] .. first[p + 1] - 1.
struct PolygonList {
    std::vector<Index> corners;
    std::vector<std::size_t> first{0};

    std::size_t size() const { return first.size() - 1; }
    //! Ends the polygon whose corners were just pushed.
    void close() { first.push_back(corners.size()); }
};

//! Appends triangles that cover one polygon, turning the same way. \pre all corners are in range.
//!
//! Quads are cut so that neither half is folded, else along the shorter diagonal; larger polygons
//! lose, one by one, the ear with the largest smallest angle in the plane of their mean normal.
//! Convex polygons with many corners are halved instead. Successive repeated corners count once.
//! A polygon that crosses itself still gets its n - 2 triangles. Cost O(n^2), O(n) when convex.
void triangulate_polygon(const std::vector<Vec3>& positions, const Index* corners,
                         std::size_t count, std::vector<std::array<Index, 3>>& triangles);

} // namespace bot2nurbs
