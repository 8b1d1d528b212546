// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/spline_network.h"
#include "spline/fans.h"
#include "spline/patch_grid.h"
#include "spline/sparse_row.h"
#include "spline/vertex_masks.h"

#include <vector>

namespace bot2nurbs {

//! What the builders of all schemes share: unknowns, rows in the making, and the vertices.
//!
//! Everything that two patches share is made once, as a row of the pool, and copied into the
//! stencils of both.
class NetworkAssembly {
protected:
    explicit NetworkAssembly(const QuadComplex& complex);

    //! A vertex unknown as a fan sees it: an opposite tangent is minus the unknown.
    struct Signed {
        Index unknown = invalid_index;
        double sign = 1.0;
    };

    Index new_unknown(bool point);
    //! A pool row that is one new unknown.
    Index new_unit_row(bool point);
    //! The pool row with the weights of a mask on the unknowns of its columns.
    Index mask_row(const MaskRow& mask, const std::vector<Signed>& columns);
    //! The unknown of a pool row that is one.
    Index unknown_of(Index row) const { return pool_.column[pool_.offset[row]]; }

    //! The domain edge that is edge i of a fan.
    Index fan_edge(const Fan& fan, Index i) const;
    //! Numbers the ends of all edges: 2 e for the start of the edge's halfedge, 2 e + 1 for its
    //! end.
    Index end_at(Index edge, Index vertex) const;
    //! The same for the start of a halfedge.
    Index end_of(Index h) const { return end_at(complex_.edge(h), complex_.from(h)); }

    using VertexColumns = std::vector<VertexColumn> (*)(FanKind kind, Index sectors);
    //! Makes the unknowns of all vertices: fills tangent_ and fan_columns_.
    void add_vertex_unknowns(const std::vector<Fan>& fans, VertexColumns columns);
    //! Moves unknowns into the network. \pre the stencils are complete
    void finish(SplineNetwork& network);

    const QuadComplex& complex_;
    std::vector<char> is_point_;
    SparseRows pool_;
    RowSum sum_;
    std::vector<Index> apex_;     //!< Per vertex: pool row of its position, if made.
    std::vector<Signed> tangent_; //!< Per end of a sharp edge: its tangent there.
    std::vector<std::vector<Signed>> fan_columns_; //!< Vertex columns of each fan.

private:
    void add_fans_of_vertex(const std::vector<Fan>& fans, std::size_t begin, std::size_t end,
                            VertexColumns columns);
};

} // namespace bot2nurbs
