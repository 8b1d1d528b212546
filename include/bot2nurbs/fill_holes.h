// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "bot2nurbs/repair_mesh.h"

namespace bot2nurbs {

//! Fills the holes of a mesh whose boundary loop fits into a box with a diagonal of at most `size`:
//! each with triangles of the least total area between its vertices \cite barequet_sharir_1995, or,
//! where there is no such triangulation (its diagonals are edges of the mesh already) or the loop
//! has more than 500 edges, with a fan around the mean of its vertices. Larger loops stay. New
//! faces and vertices have no source. What is closed by this is turned outward, and judged for
//! cavities and for volume, as in repair_mesh().
//!
//! Adds a note hole_filled for each hole, naming it by the first vertex of its loop in the
//! numbering of the soup, and a note hole_left with the number of the others. Errors: bad_option (a
//! size that is negative or not finite); cancelled. Cost O(E^3) for a loop of E edges up to 500.
Status fill_holes(RepairedMesh& mesh, double size, const Context& context);

} // namespace bot2nurbs
