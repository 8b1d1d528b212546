// SPDX-License-Identifier: MIT
#pragma once

//! Masks of the scheme SplineScheme::full around one vertex: its Bezier coefficients (0, 0), the
//! first legs of its edges, and the twists (1, 1), as rows over local columns.

#include "spline/vertex_masks.h"

namespace bot2nurbs {

//! Local columns: first the unknowns of the vertex, see `full_vertex_columns`, then one point for
//! every edge with a ring point of its own.
//!
//! The curve of edge i starts as a quadratic with controls q0 (the apex), q1 (the leg) and q2 (the
//! ring point) where the cosine of the fan is not zero; where it is, only q0 and q1 are its own.
struct FullMask {
    Index vertex_columns = 0;
    MaskRow apex;             //!< q0.
    std::vector<MaskRow> leg; //!< q1 per edge; over the vertex columns only.
    //! q2 per edge: one ring point; at the last edge of a closed fan of even n >= 6 the alternating
    //! sum of the others, without which the twists would have no solution. Empty for the outer
    //! edges of an open fan, and for all edges of a regular one.
    std::vector<MaskRow> ring;
    std::vector<MaskRow> twist; //!< Coefficient (1, 1) per sector.
    //! Per edge: the local column of its ring point, or invalid_index.
    std::vector<Index> ring_column;

    Index column_count() const { return static_cast<Index>(apex.size()); }
};

//! The unknowns of a vertex that a fan sees, in order of its local columns.
std::vector<VertexColumn> full_vertex_columns(FanKind kind, Index sectors);

//! \pre as peters_mask
FullMask full_mask(FanKind kind, Index sectors, double alpha);

} // namespace bot2nurbs
