// SPDX-License-Identifier: MIT
#pragma once

#include "layout/layout_level.h"

namespace bot2nurbs {

//! Vertices on curves that must become sites so that every region has an even number of sites on
//! its boundary. A region with b of them has b + 2 n triangles, so only then can they be paired; a
//! site on a curve counts for the regions on both sides. Chosen on a spanning forest of the
//! regions, long pieces of curves first; one such vertex a piece. Empty when all are even, or where
//! a region's curves have no vertex left between two sites.
std::vector<Index> sites_for_even_regions(const LayoutLevel& level, const Tiles& tiles);

} // namespace bot2nurbs
