// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "bot2nurbs/manifold_mesh.h"

#include <vector>

namespace bot2nurbs {

//! Angles between normals in degrees, per halfedge and equal for twins; 0 at boundaries.
struct EdgeAngles {
    std::vector<double> face; //!< Between the two faces.
    //! Between the mean normals of the two sides: of the faces within a few rings that no edge of
    //! `dividing` or more separates from the edge. 0 where the faces meet at less.
    std::vector<double> side;
    //! How far normals spread within the sides, mean of both, over `side`.
    std::vector<double> spread;
};

//! Cost O(n). Stops early, with the rest zero, when the context is cancelled.
EdgeAngles measure_edge_angles(const ManifoldMesh& mesh, double dividing, const Context& context);

} // namespace bot2nurbs
