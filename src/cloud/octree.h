// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "cloud/morton.h"

#include <vector>

namespace bot2nurbs {

//! Cells of one level of an octree over the unit cube, those with children included.
struct OctreeLevel {
    std::vector<std::uint64_t> cells;    //!< Morton keys, ascending; level l has 2^l cells an axis.
    std::vector<Index> refined;          //!< Cells with children, ascending.
    std::vector<Index> children;         //!< Per cell: its first child on the next level, or
                                         //!< invalid_index. Child k is on the side of corner k.
    std::vector<std::uint64_t> vertices; //!< Morton keys of the cells' corners, ascending.
    std::vector<Index> corners; //!< Slot 8 c + k: the vertex at corner k of cell c. Bit 0 of k says
                                //!< x, bit 1 y, bit 2 z.
    std::vector<Index> first_slot; //!< Per vertex: where its slots begin; one more at the end.
    std::vector<Index> slots;      //!< Slots of each vertex, ascending.

    Index cell_count() const { return static_cast<Index>(cells.size()); }
    Index vertex_count() const { return static_cast<Index>(vertices.size()); }
    bool is_leaf(Index cell) const { return children[cell] == invalid_index; }
    //! All eight cells around the vertex exist on this level.
    bool is_interior(Index vertex) const
    {
        return first_slot[vertex + 1] - first_slot[vertex] == 8;
    }
    //! invalid_index where there is none.
    Index find_cell(const Lattice& p) const;
    Index find_vertex(const Lattice& p) const;
};

//! A cell that must exist, with all its neighbours.
struct WantedCell {
    int level = 0;
    Lattice place{};
};

//! An octree whose leaves that touch differ by one level at most.
class Octree {
public:
    //! The smallest such tree in which the wanted cells exist, and around each the 26 of its size
    //! (within the cube), and which is full down to level `full`. Deterministic for any thread
    //! count. Cost O(n log n). Errors: cancelled. \pre levels are at most `deepest`, that at most
    //! 20
    static Result<Octree> build(const std::vector<WantedCell>& wanted, int full, int deepest,
                                const Context& context);

    int depth() const { return static_cast<int>(levels_.size()) - 1; } //!< Of the finest level.
    const OctreeLevel& level(int l) const { return levels_[static_cast<std::size_t>(l)]; }
    //! The parent, on level l - 1, of a cell of level l > 0.
    Index parent(int l, Index cell) const { return level(l - 1).refined[cell / 8]; }
    static double cell_size(int l) { return 1.0 / static_cast<double>(std::uint64_t{1} << l); }

private:
    bool number_vertices(OctreeLevel& level, int l, const Context& context);

    std::vector<OctreeLevel> levels_;
};

} // namespace bot2nurbs
