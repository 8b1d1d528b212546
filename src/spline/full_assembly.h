// SPDX-License-Identifier: MIT
#pragma once

#include "spline/full_masks.h"
#include "spline/network_assembly.h"

#include <array>
#include <map>
#include <tuple>
#include <utility>

namespace bot2nurbs {

//! Assembles the network of SplineScheme::full: all C1 bicubic macro patches of 10 x 10 controls
//! that join with the quadratic cross derivative law.
//!
//! Shared by patches are the vertex positions, the 13 coefficients of an edge, and, with opposite
//! signs, the vectors that lead from a smooth edge to its next rows. All else is a patch's own.
class FullAssembly : NetworkAssembly {
public:
    explicit FullAssembly(const QuadComplex& complex);
    void build(const std::vector<Fan>& fans, SplineNetwork& network);

private:
    //! Indices along a side that are not fixed by the corners or by C1 at the inner knots.
    static constexpr std::array<Index, 6> own_indices{2, 4, 5, 7, 8, 10};

    const FullMask& mask_of(const Fan& fan);
    void apply_mask(std::size_t fan_number, const Fan& fan);
    void add_edges();
    void add_edge_row(Index edge, Index j);
    void add_first_rows();
    void add_patch(Index quad, SparseRows& stencils);

    // How the unknowns follow from the coefficients (full_recovery.cpp). Terms are weights of
    // stencil rows.
    using Terms = std::vector<std::pair<double, Index>>;
    void recover(Index unknown, const Terms& terms);
    void recover_vertices(const std::vector<Fan>& fans);
    void recover_tangents(const Fan& fan, const std::vector<Signed>& columns);
    void recover_twist(const Fan& fan, const std::vector<Signed>& columns);
    void recover_edges();
    void recover_patches();
    void finish_recovery(SplineNetwork& network);

    std::map<std::tuple<FanKind, Index, double>, FullMask> masks_;
    // Per edge end: pool rows of the leg q1 and of the ring point q2, where it has one.
    std::vector<Index> leg_, ring_;
    std::vector<Index> twist_; //!< Per sector: pool row of coefficient (1, 1).
    //! Per edge end: unknowns of coefficients 2, 4 (where there is no ring point) and 5.
    std::vector<std::array<Index, 3>> curve_unknowns_;
    std::vector<Index> edge_rows_; //!< Per edge: first of its 13 pool rows.
    //! Per halfedge: unknowns of the six places of the row next to its side: points of its own on a
    //! sharp edge, else those vectors that both halfedges of the edge share.
    std::vector<std::array<Index, 6>> first_row_;
    std::vector<Index> interior_; //!< Per quad: first of its 36 inner unknowns.

    SparseRows recovered_;            //!< Over stencil rows.
    std::vector<Index> recovery_row_; //!< Per unknown: its row of recovered_.
};

} // namespace bot2nurbs
