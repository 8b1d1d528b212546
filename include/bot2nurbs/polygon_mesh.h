// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/result.h"
#include "bot2nurbs/vec.h"

#include <cstddef>
#include <vector>

namespace bot2nurbs {

//! Polygons as a file lists them: polygon p has corners first[p] .. first[p + 1] - 1.
struct PolygonList {
    std::vector<Index> corners;
    std::vector<std::size_t> first{0};

    std::size_t size() const { return first.size() - 1; }
    //! Number of corners of polygon p.
    std::size_t count(std::size_t p) const { return first[p + 1] - first[p]; }
    //! Corner k of polygon p.
    Index corner(std::size_t p, std::size_t k) const { return corners[first[p] + k]; }
    //! Ends the polygon whose corners were just pushed.
    void close() { first.push_back(corners.size()); }
};

//! Polygons with their vertices as a reader found them: no topology is promised.
struct PolygonMesh {
    std::vector<Vec3> positions;
    PolygonList polygons; //!< With the numbers they have in the file. Corners are in range.
};

} // namespace bot2nurbs
