// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/vec.h"
#include "mesh/soup_topology.h"

namespace bot2nurbs {

struct SplitCount {
    Index edges = 0;    //!< Edges with more than two triangles.
    Index vertices = 0; //!< Vertices with several fans after the edges were split.
};

//! Pairs the triangles at edges with more than two so that each pair bounds the same solid: round
//! the edge, a triangle is joined to the next one on the side away from its normal, if that one
//! shows it its back too. Triangles without a partner are left with an open side.
SplitCount split_nonmanifold(const std::vector<Vec3>& positions, SoupTopology& topology);

} // namespace bot2nurbs
