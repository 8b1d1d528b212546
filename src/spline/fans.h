// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/quad_complex.h"

#include <vector>

namespace bot2nurbs {

//! How the surface behaves at the vertex of a fan.
enum class FanKind {
    closed, //!< Inner vertex without sharp edges: the fan goes all the way round.
    smooth, //!< A boundary or crease runs smoothly through the vertex.
    dart,   //!< The one crease edge at an inner vertex ends here; both fan ends are that edge.
    corner, //!< The sharp edges at the vertex have independent tangents.
};

//! A maximal counter-clockwise run of quad corners ("sectors") at a vertex without a sharp edge in
//! between. Sector i lies between edges i and i + 1; a closed fan has as many edges as sectors, an
//! open one has one more, and its first and last edge are sharp.
struct Fan {
    Index vertex = invalid_index;
    FanKind kind = FanKind::closed;
    double alpha = 0.0; //!< Angle the fan spans in its parameter plane; 0 for a single sector.
    std::vector<Index> sectors; //!< Halfedges that start at the vertex, one a quad corner.

    Index sector_count() const { return static_cast<Index>(sectors.size()); }
    Index edge_count() const { return sector_count() + (kind == FanKind::closed ? 0 : 1); }
};

//! Angle of the parameter plane of a corner fan of k sectors where the shape to be fitted is not
//! known. Any value with sin(alpha) != 0 and alpha / k <= 2 pi / 3 gives exact smoothness within
//! the fan.
double corner_fan_angle(Index k);

//! The angle for a fan that spans `measured` on the shape. The plane is mapped to the tangent plane
//! of the surface by the end tangents of its two sharp edges, so that it must be on the same side
//! of pi: else the edges between leave on the wrong side and the patches fold.
double corner_fan_angle(Index k, double measured);

//! All fans, by vertex; fans of a vertex counter-clockwise from its first sharp edge (a closed fan
//! from halfedge_at). `corner_angles`: see build_spline_network(). Cost linear. Errors:
//! invalid_domain naming a vertex inside with fewer than three quads.
Result<std::vector<Fan>> find_fans(const QuadComplex& complex,
                                   const std::vector<double>& corner_angles);

} // namespace bot2nurbs
