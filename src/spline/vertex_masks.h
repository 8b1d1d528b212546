// SPDX-License-Identifier: MIT
#pragma once

//! Masks around one vertex of a quad domain, as dense rows over *local* columns: how the Bezier
//! coefficients near the vertex depend on the unknowns near it. They depend on the kind of the fan
//! and its number of quads alone, so a network computes each once.
//!
//! In sector i, `A_i` is the control point of the quad next to the vertex, `B+_i` the next one
//! along edge i, `B-_(i+1)` the next one along edge i + 1, `C_i` the diagonal one; `B-_i` belongs
//! to sector i - 1 and lies along edge i too.

#include "spline/fans.h"
#include "spline/mask_algebra.h"

namespace bot2nurbs {

//! Masks of the scheme SplineScheme::peters.
//!
//! Local columns: first the unknowns of the vertex, see `peters_vertex_columns`, then for every
//! edge i of the fan two columns for the second controls along it: B+_i and B-_i of a smooth edge;
//! of a sharp one its second control point E and an unused column.
struct PetersMask {
    Index vertex_columns = 0;
    MaskRow apex;               //!< Position of the surface at the vertex.
    std::vector<MaskRow> leg;   //!< A_i per sector; over the vertex columns only.
    std::vector<MaskRow> twist; //!< Added to coefficient (1, 1) per sector; empty where all vanish.

    Index edge_column(Index edge, Index second) const { return vertex_columns + 2 * edge + second; }
};

//! The unknowns of a vertex that a fan sees, in order of its local columns. `plane_u` and `plane_v`
//! span the tangents of a closed fan; an open fan has the tangents of its first and last edge.
//! `shear` is the alternating part of the controls, `twist` that of the coefficients (1, 1).
enum class VertexColumn {
    control,
    position,
    plane_u,
    plane_v,
    first_tangent,
    last_tangent,
    shear,
    twist
};

//! `control` stands for A_i and is listed once a sector.
std::vector<VertexColumn> peters_vertex_columns(FanKind kind, Index sectors);

//! \pre closed: sectors >= 3. smooth, dart: sectors >= 2, 3. corner: sectors == 1 or sin(alpha) !=
//! 0.
PetersMask peters_mask(FanKind kind, Index sectors, double alpha);

//! Masks of Eck and Hoppe at an inner vertex of valence n != 4. Local columns: 4 i + 0, 1, 2, 3 are
//! A_i, B+_i, B-_i, C_i. Entry (J, K) counts J along edge i, K along edge i + 1.
struct EckHoppeMask {
    MaskRow apex;
    std::vector<MaskRow> edge1, edge2;       //!< Coefficients (1, 0) and (2, 0) per edge.
    std::vector<MaskRow> b11, b21, b12, b22; //!< Per sector.
};
EckHoppeMask eck_hoppe_mask(Index n);

} // namespace bot2nurbs
