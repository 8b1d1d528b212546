// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "bot2nurbs/vec.h"

#include <vector>

namespace bot2nurbs {

//! A binary tree of boxes around numbered items. Same tree for the same boxes on every machine.
class BoxTree {
public:
    struct Node {
        Vec3 min, max;
        Index first = 0; //!< Leaf: first entry of items(). Inner node: first child; the other is
                         //!< first + 1.
        Index count = 0; //!< Leaf: number of items; inner node: 0.
    };

    BoxTree() = default;
    //! Cost O(n log n). Without any items when `context` is cancelled meanwhile. \pre no box is
    //! empty.
    explicit BoxTree(const std::vector<Box3>& boxes, const Context* context = nullptr);

    //! nodes()[0] is the root; empty without items.
    const std::vector<Node>& nodes() const { return nodes_; }
    //! Item numbers in the order of the leaves.
    const std::vector<Index>& items() const { return items_; }

private:
    std::vector<Node> nodes_;
    std::vector<Index> items_;
};

} // namespace bot2nurbs
