// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "layout/layout_level.h"

namespace bot2nurbs {

//! How many sites tiles get, and where.
struct SitePlan {
    double width = 0.0;  //!< Wanted distance of neighbours on curves, in the metric of the density.
    Index inner = 0;     //!< Wanted number of sites beside those on curves.
    bool spread = false; //!< Spread the inner sites in one sweep, for many; otherwise one by one,
                         //!< each farthest from all others.
    int relaxations = 0; //!< Rounds of Lloyd's relaxation.
    bool keep_apart =
        false; //!< Separates tiles that LayoutLevel::apart says must not be neighbours.
    bool even_regions = false; //!< Every region gets an even number of sites on its boundary, if
                               //!< its curves can be divided further: so that it has an even
                               //!< number of triangles.
};

//! Places sites on a level: on every node and along every curve, every copy of a vertex at once;
//! then inside; then, until the conditions of Tiles hold, whatever they ask. Ends: each round adds
//! a site. \return how many sites the conditions added. Stops early when the context is cancelled.
Index place_sites(const LayoutLevel& level, const SitePlan& plan, Tiles& tiles,
                  const Context& context);

} // namespace bot2nurbs
