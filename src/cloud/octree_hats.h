// SPDX-License-Identifier: MIT
#pragma once

#include "cloud/octree.h"
#include "core/parallel.h"

#include <array>
#include <vector>

namespace bot2nurbs {

//! One number a vertex, on each level.
using OctreeField = std::vector<std::vector<double>>;

//! Functions on an octree as sums of the hat functions of all levels. The hat of a vertex of level
//! l is trilinear on the cells of that level; a vertex has one if all eight cells around it exist,
//! so that a hat vanishes on the border of the cube and of its level.
class OctreeHats {
public:
    using Corners = std::array<double, 8>;

    OctreeHats(const Octree& tree, const Context& context) : tree_(tree), context_(context) {}

    OctreeField zeros() const;
    //! From coefficients of hats to values at vertices, in place: on every level what the coarser
    //! ones amount to is added. Coefficients of vertices without a hat must be zero.
    void to_values(OctreeField& field) const;
    //! The transpose: `leaf(l, cell)` gives eight numbers at the corners of a leaf; the sum that
    //! each hat sees of them becomes the field, zero at vertices without a hat.
    template <class Leaf> void from_leaves(const Leaf& leaf, OctreeField& field);

private:
    static constexpr std::size_t cells_per_chunk = 2048;

    //! What the corners of a cell see of the values at its children's vertices.
    Corners restricted(int l, Index cell, const std::vector<double>& finer) const;
    void gather(int l, std::vector<double>& field) const;
    void clear_without_hat(int l, std::vector<double>& field) const;

    const Octree& tree_;
    const Context& context_;
    std::vector<Corners> at_corners_; //!< Per cell of the level at hand.
};

template <class Leaf> void OctreeHats::from_leaves(const Leaf& leaf, OctreeField& field)
{
    for (int l = tree_.depth(); l >= 0; --l) {
        const OctreeLevel& level = tree_.level(l);
        at_corners_.resize(std::max<std::size_t>(at_corners_.size(), level.cells.size()));
        for_each_chunk(
            context_, level.cells.size(), cells_per_chunk, [&](std::size_t begin, std::size_t end) {
                for (std::size_t c = begin; c < end; ++c) {
                    const Index cell = static_cast<Index>(c);
                    at_corners_[c] =
                        level.is_leaf(cell)
                            ? leaf(l, cell)
                            : restricted(l, cell, field[static_cast<std::size_t>(l) + 1]);
                }
            });
        gather(l, field[static_cast<std::size_t>(l)]);
        // The coarser level has taken what it needs of the finer one.
        if (l < tree_.depth())
            clear_without_hat(l + 1, field[static_cast<std::size_t>(l) + 1]);
    }
    clear_without_hat(0, field[0]);
}

} // namespace bot2nurbs
