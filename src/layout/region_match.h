// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/quad_complex.h"
#include "maps/path_web.h"

#include <cstdint>
#include <vector>

namespace bot2nurbs {

//! Edges of a quad complex that are paths of a web: which, and where.
struct DrawnEdges {
    const QuadComplex& complex;
    const PathWeb& web;         //!< Its sites are the vertices of the complex, in their order.
    std::vector<Index> path_of; //!< Per edge of the complex; invalid while it is not drawn. Paths
                                //!< run as the edges do.

    bool is_drawn(Index edge) const { return path_of[edge] != invalid_index; }
    //! The path end at the start of a halfedge of the complex. \pre its edge is drawn
    Index end_at(Index h) const;
    //! The drawn edge clockwise next to the corner at the start of h (or h's own), as the path end
    //! there; invalid_index where no edge is drawn. \pre boundary edges are drawn
    Index sector_at(Index h) const;
};

//! Decides whether a drawing of part of a quad complex can be completed.
//!
//! The edges drawn so far divide the complex into regions, and the mesh likewise. The drawing can
//! be completed if regions of the mesh are those of the complex: the same topology, and at every
//! vertex the same sectors between drawn edges, for then (classification of surfaces) a
//! homeomorphism that continues the drawing exists. One more path either joins two pieces of the
//! drawing, which keeps that in any case, or divides a region, or opens a handle.
class RegionMatch {
public:
    explicit RegionMatch(const DrawnEdges& drawn);

    //! Whether the path added last, of an edge that joins two vertices of one connected piece of
    //! the drawing, leaves regions of the mesh and of the complex alike. Cost that of the smaller
    //! of the regions it divides.
    bool fits(Index edge);

private:
    //! The part of a region seen so far.
    struct Tally {
        std::uint32_t stamp = 0;
        std::int64_t pieces = 0, sides = 0, inside = 0; // Faces or cells, joins twice, vertices.
        std::int64_t sectors = 0;

        std::int64_t euler() const { return pieces - sides / 2 + inside; }
    };
    struct QuadFlood : Tally {
        std::vector<Index> pending;
        std::size_t next = 0;
    };
    struct CellFlood : Tally {
        std::vector<PathWeb::Stretch> pending;
        bool at_seed = true;
    };
    enum class Step { on, done, met };

    QuadFlood start(Index quad);
    Step step(QuadFlood& flood, std::uint32_t other);
    CellFlood start(const PathWeb::Wedge& seed);
    //! `allowed`: the stamp of sectors that belong to the region; 0: all do. Meets also where a
    //! sector does not.
    Step step(CellFlood& flood, std::uint32_t other, std::uint32_t allowed);
    std::size_t sector_number(Index sector, Index vertex) const;

    const DrawnEdges& drawn_;
    std::uint32_t stamp_ = 0;
    std::vector<std::uint32_t> quad_mark_;
    std::vector<std::uint32_t> side_mark_;   // Twice the number of a stretch, and 1 at its right.
    std::vector<std::uint32_t> vertex_mark_; // Of the mesh.
    // Path ends, then vertices where none is drawn: in the complex, and found again in the mesh.
    std::vector<std::uint32_t> sector_mark_, found_mark_;
};

} // namespace bot2nurbs
