// SPDX-License-Identifier: MIT
#pragma once

#include "spline/network_assembly.h"

namespace bot2nurbs {

//! Assembles the stencils of schemes with 4 x 4 controls a quad (peters, eck_hoppe).
//!
//! Away from the corners a patch is the clamped quadratic tensor spline of 6 x 6 controls: the 4 x
//! 4 controls of the quad, a border row per side that both neighbours share, and the vertex
//! positions. Shared are the vertex positions and the 13 coefficients of an edge.
class ControlNet : protected NetworkAssembly {
protected:
    explicit ControlNet(const QuadComplex& complex);

    //! Pool row of the control (along, depth) of a quad as seen from its corner at halfedge h.
    Index& control(Index h, Index along, Index depth);
    //! The unknown of a control that is one.
    Index control_unknown(Index h, Index along, Index depth)
    {
        return unknown_of(control(h, along, depth));
    }
    //! Pool row of side control a of an edge, a counted from the start of h.
    Index& side(Index h, Index a);
    //! At an inner vertex of even valence above four the alternating sum of the second controls
    //! along the edges must vanish.
    void add_even_constraint(const Fan& fan, SparseRows& constraints);
    //! Stencils of all patches, from controls, apices, sides of sharp edges and corner pieces.
    void add_patches(SplineNetwork& network);

    std::vector<Index> control_; //!< 16 pool rows per quad.
    std::vector<Index> side_;    //!< Four pool rows per edge: its border controls.
    //! Per edge end: first of two pool rows that replace Bezier coefficients 1 and 2, or none.
    std::vector<Index> edge_end_;
    std::vector<Index> twist_; //!< Per sector: pool row added to coefficient (1, 1), or none.
    //! Per sector: first of the pool rows replacing (1, 1), (2, 1), (1, 2), (2, 2), or none.
    std::vector<Index> corner_piece_;

private:
    void add_smooth_sides();
    void add_edges();
    void add_patch(Index quad, SparseRows& stencils);

    std::vector<Index> edge_rows_; //!< Per edge: first of its 13 pool rows.
};

} // namespace bot2nurbs
