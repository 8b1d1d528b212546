// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/result.h"

#include <optional>
#include <vector>

namespace bot2nurbs {

//! Two faces that may be joined, and the distortion of their common map to the square.
struct PairCandidate {
    Index face_a = invalid_index, face_b = invalid_index;
    double distortion = 0.0; //!< Bottleneck: the largest one chosen is as small as possible.
    double cost = 0.0;       //!< Then the sum of these is as small as possible.
};

//! A perfect matching of `face_count` faces: numbers of the chosen candidates, ascending. First the
//! largest distortion is minimised (MAX-MIN matching of Eck and Hoppe 1996, section 3.2, by
//! bisection over maximum cardinality matchings); then, among the matchings whose largest
//! distortion is at most `slack` times that optimum, the total cost. Faces that no candidates
//! connect do not count for each other's optimum. Empty when no perfect matching exists.
std::optional<std::vector<Index>>
match_faces(Index face_count, const std::vector<PairCandidate>& candidates, double slack);

//! Faces that are in the way of a perfect matching: each has more neighbours that depend on it than
//! it can be joined with (the set A of Gallai and Edmonds). Ascending; empty exactly when only
//! faces without any candidate are left over, or none.
std::vector<Index> blocking_faces(Index face_count, const std::vector<PairCandidate>& candidates);

} // namespace bot2nurbs
