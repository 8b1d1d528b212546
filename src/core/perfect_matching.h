// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/result.h"

#include <optional>
#include <vector>

namespace bot2nurbs {

//! An edge of a graph with what choosing it costs; the cost may be negative.
struct MatchingEdge {
    Index a = invalid_index, b = invalid_index;
    double cost = 0.0;
};

//! Edges that cover each of `nodes` nodes once, of least total cost: their positions in `edges`,
//! ascending. Empty when there are none. Costs are rounded to a millionth of a millionth of the
//! largest, so that the search is exact and the same on every machine. Cost O(n m log n).
std::optional<std::vector<Index>> cheapest_perfect_matching(Index nodes,
                                                            const std::vector<MatchingEdge>& edges);

} // namespace bot2nurbs
