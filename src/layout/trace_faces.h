// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/result.h"

#include <utility>
#include <vector>

namespace bot2nurbs {

//! A straight path inside a convex polygon: between two of its corners, or from a corner to a point
//! inside (second is invalid_index).
using Chord = std::pair<Index, Index>;

//! A side of a piece: a side of the polygon, or a chord in the given direction.
struct TracedSide {
    bool is_chord = false;
    Index number =
        invalid_index;     //!< Of the chord, or the corner at which the polygon's side starts.
    bool reversed = false; //!< A chord walked from its second to its first end.
};

//! The pieces into which non-crossing chords divide a convex polygon, each counter-clockwise. Of a
//! point inside, two chords or more lead to corners. Pieces come in the order of the first polygon
//! side in them. Needs no coordinates: corners are numbered counter-clockwise, and that decides.
std::vector<std::vector<TracedSide>> trace_faces(Index corner_count,
                                                 const std::vector<Chord>& chords);

} // namespace bot2nurbs
