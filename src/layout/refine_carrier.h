// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/quad_domain.h"

#include <vector>

namespace bot2nurbs {

//! How a carrier is made from its source.
struct CarrierPlan {
    //! Per source vertex: no edge is to be longer. Along an edge the smaller of its ends' values
    //! holds; a new vertex takes the mean.
    std::vector<double> limit;
    std::size_t max_splits = 0;      //!< Edges split for their length, at most.
    std::vector<char> marks;         //!< Per halfedge of the source.
    std::vector<SourcePoint> points; //!< Places that must become vertices.
};

struct PlannedCarrier {
    CarrierMesh carrier;
    std::vector<char> marks;           //!< Per halfedge: both parts of a split edge have its mark.
    std::vector<Index> point_vertices; //!< Per point of the plan.
};

//! The source mesh with vertices at the given points, then with every edge longer than the limit
//! split in the middle, longest first, until none is. Faces keep their source face and vertices
//! their exact weights in it; the surface is the same. Cost O(n log n).
PlannedCarrier refine_carrier(const ManifoldMesh& source, CarrierPlan plan);

} // namespace bot2nurbs
