// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/result.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace bot2nurbs {

//! Disjoint sets of 0 .. n - 1; the smallest member stands for its set.
class DisjointSets {
public:
    explicit DisjointSets(std::size_t n) : parent_(n)
    {
        std::iota(parent_.begin(), parent_.end(), Index{0});
    }
    Index find(Index i)
    {
        while (parent_[i] != i)
            i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(Index a, Index b)
    {
        a = find(a), b = find(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

private:
    std::vector<Index> parent_;
};

} // namespace bot2nurbs
