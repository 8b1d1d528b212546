// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "bot2nurbs/quad_complex.h"
#include "maps/surface_path.h"

#include <vector>

namespace bot2nurbs {

//! An edge of a quad complex that runs along mesh edges: creases and the boundary.
struct DrawnCurve {
    Index edge = invalid_index;
    std::vector<Index> vertices; //!< Mesh vertices, in the direction of the edge.
};

//! Draws a quad complex on a mesh of the same topology: a path for every edge, in the edge's
//! direction, without crossings, so that every quad is a disk with its four sides. `vertices` are
//! distinct mesh vertices, one for each of the complex; `curves` holds all boundary edges;
//! `straight` has, for an edge, a straight way along mesh edges if there is one, else nothing.
//!
//! Edges are drawn one by one, each as a short path that leaves its ends between the right
//! neighbours, quad after quad. A path that would divide the mesh other than the complex is put
//! off until more is drawn. On a surface without handles that always ends with a drawing: while
//! regions agree there is always a path for some edge (RegionMatch), and where a region is a disk
//! with all its vertices on its border any path does. \cite praun_2001 \cite kraevoy_2004
//! Errors: invalid_domain, naming an edge that cannot be drawn as it would have to wind around a
//! handle; cancelled. Cost O(n log n) in practice.
Result<std::vector<SurfacePath>> draw_quads(const ManifoldMesh& mesh, const QuadComplex& complex,
                                            const std::vector<Index>& vertices,
                                            const std::vector<DrawnCurve>& curves,
                                            const std::vector<std::vector<Index>>& straight,
                                            Context& context);

} // namespace bot2nurbs
