// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/map_level.h"
#include "maps/overlay.h"

#include <vector>

namespace bot2nurbs {

//! A map of an overlay to a convex polygon.
struct ConvexMap {
    std::vector<Vec2> uv; //!< Per overlay vertex.
    MapLevel level = MapLevel::harmonic;
};

//! Corners of a regular polygon on the unit circle, counter-clockwise; exactly convex.
std::vector<Vec2> regular_polygon(Index sides);

//! Corners of the unit square, counter-clockwise from the origin.
std::vector<Vec2> unit_square();

//! Maps an overlay to the convex polygon with the given corners (one per side), each side by arc
//! length. Inner vertices are convex combinations of their neighbours with positive weights, and so
//! the map is by Tutte and Floater injective: cotangents, bounded below, which give the discrete
//! harmonic map wherever the triangulation is Delaunay; mean values, where with cotangents much
//! surface is squeezed into little of the polygon (rows of needles); uniform weights when rounding
//! folds a triangle; then uniform weights in extended precision. Injectivity is decided exactly for
//! every triangle. Where a map squeezes (a limb, a long way round a hole), the weights there are
//! lowered, which any positive ones may be, and it is solved again. \cite eck_1995, section 3,
//! \cite tutte_1963 \cite floater_1997 \cite floater_2003 \cite yoshizawa_2004
//! Empty when even that map has a triangle that is not positive after rounding to doubles.
//! `first` is the level to begin with.
std::optional<ConvexMap> map_to_polygon(const Overlay& overlay, const std::vector<Vec2>& corners,
                                        MapLevel first = MapLevel::harmonic);

//! True when every triangle is positively oriented, decided exactly.
bool is_injective(const Overlay& overlay, const std::vector<Vec2>& uv);

//! Distortion of a map of an overlay to a region of the plane.
struct MapDistortion {
    //! Harmonic energy over the target's area: 1 for a conformal map, whatever its areas. Triangles
    //! of less height than 1/20 of their longest side count as if they had that.
    double dirichlet = 0.0;
    //! Square of the L2 stretch of the inverse map, normalised by both areas: 1 for a similarity,
    //! large where much surface is squeezed into little of the plane. \cite sander_2001
    double stretch = 0.0;

    //! One number for both: 1 for a similarity, larger for anything else.
    double combined() const { return 0.5 * (dirichlet + stretch); }
};
MapDistortion measure_distortion(const Overlay& overlay, const std::vector<Vec2>& uv);

} // namespace bot2nurbs
