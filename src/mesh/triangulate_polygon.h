// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/manifold_mesh.h"
#include "bot2nurbs/polygon_mesh.h"

#include <array>
#include <vector>

namespace bot2nurbs {

//! Cuts polygons into triangles.
//!
//! Quads are cut so that neither half is folded, else along the shorter diagonal; larger polygons
//! lose, one by one, the ear with the largest smallest angle in the plane of their mean normal;
//! convex ones with many corners are halved instead. A diagonal never joins two vertices that
//! another edge or diagonal of the list joins already, as long as there is another way: two quads
//! that share two sides would otherwise end up with four faces on one edge.
class PolygonTriangulator {
public:
    //! Looks at all polygons; keeps references to both. \pre corners are in range. Cost O(corners).
    PolygonTriangulator(const std::vector<Vec3>& positions, const PolygonList& polygons);

    //! Appends triangles that cover polygon p, turning the same way. Successive repeated corners
    //! count once; what has fewer than three corners then gives nothing, but a triangle is passed
    //! on as it is. A polygon that crosses itself still gets its n - 2 triangles. Cost O(n^2), O(n)
    //! when convex.
    void triangulate(std::size_t p, std::vector<std::array<Index, 3>>& triangles);

private:
    bool joined(Index a, Index b) const;
    void add_edge(Index a, Index b);
    void cut_quad(const std::vector<Index>& q, std::vector<std::array<Index, 3>>& triangles);
    bool halve(const std::vector<Index>& ring, std::vector<std::array<Index, 3>>& triangles);
    void clip_ears(std::vector<Index> ring, std::vector<Vec2> plane,
                   std::vector<std::array<Index, 3>>& triangles);

    const std::vector<Vec3>& positions_;
    const PolygonList& polygons_;
    //! Open addressing over vertex pairs; empty when all polygons are triangles.
    std::vector<std::uint64_t> edges_;
};

} // namespace bot2nurbs
