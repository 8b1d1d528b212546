// SPDX-License-Identifier: MIT
#pragma once

#include "maps/retile.h"

namespace bot2nurbs {

//! A place on the border of a region: on one of its sides between the points `step` and `step` + 1
//! of that side's path as it is walked, at a share of the way; share 0 of step 0 is the corner
//! where the side starts. Which step it is in is combinatorial, so two regions on both sides of a
//! path name the same place.
struct BorderPlace {
    Index side = 0, step = 0;
    double share = 0.0;

    bool is_corner() const { return step == 0 && share == 0.0; }
    friend bool operator<(const BorderPlace& a, const BorderPlace& b)
    {
        if (a.side != b.side)
            return a.side < b.side;
        return a.step != b.step ? a.step < b.step : a.share < b.share;
    }
};

//! A straight path across a region from one place on its border to another.
struct BorderChord {
    BorderPlace from, to;
};

//! Draws chords, which do not cross and share no place but corners, in the map of the disk within
//! `border` to a regular polygon, and pulls them back to the mesh: for each, the mesh edges
//! crossed, in order. Where a border runs along a mesh edge, a place on it is a crossing of that
//! edge, and belongs to the chord that ends there, not to that which starts. Empty when the disk
//! cannot be mapped.
std::optional<std::vector<std::vector<PathNode>>>
lift_chords(const std::vector<PathSide>& border, const std::vector<BorderChord>& chords,
            OverlayBuilder& builder);

} // namespace bot2nurbs
