// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/result.h"

#include <array>
#include <set>
#include <utility>
#include <vector>

namespace bot2nurbs {

//! Topology of a quadrilateral domain K: what the spline layer needs to know of a domain.
//!
//! Corners of a quad are counter-clockwise, side s runs from corner s to corner s + 1 (mod 4), and
//! halfedge h = 4 q + s. A *fan* is a maximal counter-clockwise run of quads at a vertex that is
//! not separated by a sharp edge (a boundary or crease edge), as in the specification of the
//! splines.
class QuadComplex {
public:
    QuadComplex() = default;

    //! Builds the topology. Errors: invalid_domain naming the quad (repeated corner, an edge with
    //! more than two quads or inconsistent orientation, a vertex whose quads do not form fans
    //! around it, an index out of range, an unused vertex).
    //! `creases` are undirected vertex pairs across which the surface is only continuous;
    //! `corners` are vertices where a crease or boundary turns.
    static Result<QuadComplex> build(Index vertex_count, std::vector<std::array<Index, 4>> quads,
                                     std::vector<std::pair<Index, Index>> creases = {},
                                     std::vector<Index> corners = {});

    Index vertex_count() const { return vertex_count_; }
    Index quad_count() const { return static_cast<Index>(quads_.size()); }
    Index halfedge_count() const { return 4 * quad_count(); }
    Index edge_count() const { return static_cast<Index>(edges_.size()); }
    const std::array<Index, 4>& quad(Index q) const { return quads_[q]; }
    const std::vector<std::array<Index, 4>>& quads() const { return quads_; }

    static Index quad_of(Index h) { return h / 4; }
    static Index side_of(Index h) { return h % 4; }
    static Index next(Index h) { return h % 4 == 3 ? h - 3 : h + 1; }
    static Index prev(Index h) { return h % 4 == 0 ? h + 3 : h - 1; }
    Index from(Index h) const { return quads_[h / 4][h % 4]; }
    Index to(Index h) const { return from(next(h)); }
    Index twin(Index h) const { return twin_[h]; }
    //! Number of the undirected edge of a halfedge, 0 .. edge_count() - 1, in order of first use.
    Index edge(Index h) const { return edge_of_[h]; }
    //! The halfedge that first used an edge; its direction is the edge's direction.
    Index halfedge_of_edge(Index e) const { return edges_[e]; }
    bool is_boundary_edge(Index e) const { return twin_[edges_[e]] == invalid_index; }
    bool is_crease(Index e) const { return crease_[e]; }
    //! Boundary or crease: positions agree across it, derivatives need not.
    bool is_sharp(Index e) const { return crease_[e] || is_boundary_edge(e); }
    bool is_corner(Index v) const { return corner_[v]; }
    //! Number of quads at a vertex.
    Index valence(Index v) const { return valence_[v]; }
    //! A halfedge that starts at v (at a boundary vertex: the first one counter-clockwise).
    Index halfedge_at(Index v) const { return vertex_halfedge_[v]; }
    //! The next halfedge counter-clockwise around its start, or invalid_index at a boundary.
    Index rotate_ccw(Index h) const { return twin_[prev(h)]; }
    bool closed() const { return boundary_edges_ == 0; }
    Index boundary_edge_count() const { return boundary_edges_; }
    //! V - E + F.
    int euler_characteristic() const
    {
        return static_cast<int>(vertex_count()) - static_cast<int>(edge_count()) +
               static_cast<int>(quad_count());
    }
    //! Number of interior vertices with other than four quads (boundary: other than two).
    Index extraordinary_count() const;
    Index max_valence() const;

private:
    Index vertex_count_ = 0;
    std::vector<std::array<Index, 4>> quads_;
    std::vector<Index> twin_, edge_of_, edges_, vertex_halfedge_, valence_;
    std::vector<char> crease_, corner_;
    Index boundary_edges_ = 0;
};

} // namespace bot2nurbs
