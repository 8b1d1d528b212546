// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/quad_complex.h"
#include "bot2nurbs/vec.h"

#include <vector>

namespace bot2nurbs {

//! A quad mesh between steps of Catmull and Clark's subdivision. The boundary is refined as a cubic
//! B-spline curve; its vertices with one quad stay.
struct SubdividedQuads {
    QuadComplex complex;
    std::vector<Vec3> positions;

    //! One step: vertices keep their numbers, those of edges follow, then those of faces. Child k
    //! of quad q is quad 4 q + k and starts at the corner k. Errors: those of QuadComplex::build.
    //! Cost linear.
    Result<SubdividedQuads> refined() const;

    //! Where infinitely many steps move the vertices.
    std::vector<Vec3> limit() const;
};

//! The halfedges of the next step that a halfedge becomes, in order.
inline std::array<Index, 2> refined_halfedge(Index h)
{
    return {4 * h, 4 * QuadComplex::next(h) + 3};
}

} // namespace bot2nurbs
