// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/import_quads.h"

namespace bot2nurbs {

//! The surface of a subdivision cage, as a mesh with a domain on it.
struct CageSurface {
    ManifoldMesh mesh; //!< Its vertices lie on the surface; those of the cage come first.
    QuadDomain domain; //!< The quads, edges and vertices of the cage, numbered as they are.
    //! Per face of the mesh: the quad of the cage that it is part of.
    std::vector<Index> quad_of_face;
    int levels = 0; //!< How often the cage was refined.
};

//! The limit surface that Catmull and Clark's subdivision gives a cage of quads: refined until the
//! mesh has about 100,000 faces, at least three and at most five times, then moved to the limit.
//! The boundary becomes a cubic B-spline curve that keeps its corners, the vertices with one quad.
//! \cite catmull_1978 \cite halstead_1993
//! Errors: invalid_domain naming a vertex of the polygons the cage was made of: an inner one with
//! fewer than three quads, one with too many; bad_geometry for a cage without extent. Also
//! cancelled. Cost linear.
Result<CageSurface> cage_surface(const QuadMesh& cage, Context& context);

} // namespace bot2nurbs
