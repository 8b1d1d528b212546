// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/quad_complex.h"
#include "layout/curve_line.h"

#include <optional>
#include <utility>
#include <vector>

namespace bot2nurbs {

//! A vertex of the quads on a line.
struct CurveSite {
    Index vertex = invalid_index; //!< Of the quads.
    double s = 0.0;               //!< Along the line, in [0, length].
    //! The vertex of the mesh where it must be, because lines end or turn there.
    Index node = invalid_index;
};

//! An edge of the quads that runs along a line, from one of its sites to the next, or back.
struct CurveEdge {
    Index edge = invalid_index;
    Index line = invalid_index;
    Index first_site = invalid_index; //!< In CurveMatch::sites of the line; the next site is its
                                      //!< other end, on a closed line after the last the first.
    bool reversed = false;            //!< The edge runs against the line.
};

//! Which edges of a quad mesh run along the boundary and the creases of the source, and where.
struct CurveMatch {
    std::vector<CurveLine> lines;
    std::vector<std::vector<CurveSite>> sites; //!< Per line, ascending.
    std::vector<CurveEdge> edges;

    //! From where to where on its line an edge runs, by arc length; over the start of a closed line
    //! the end is beyond its length.
    std::pair<double, double> span(const CurveEdge& edge) const
    {
        const std::vector<CurveSite>& at = sites[edge.line];
        const double begin = at[edge.first_site].s;
        const double end = at[(edge.first_site + 1) % at.size()].s;
        return {begin, end > begin ? end : end + lines[edge.line].length()};
    }
};

//! A quad mesh as it lies beside a mesh.
struct PlacedQuads {
    const QuadComplex& complex;
    const std::vector<Vec3>& positions;
    const std::vector<double>& size; //!< Per vertex: mean length of its edges.
};

//! Matches the boundary loops of the quads, all of them, and creases, as far as quad edges follow
//! them. Lines that end at one mesh vertex get one vertex of the quads there, if one is near.
//! Along a boundary loop the order of the quads' vertices rules: of those that lie in another order
//! as few as possible are moved. A crease is followed by an edge whose ends are near it and between
//! whose ends it makes no detour. \pre equally many boundary loops
CurveMatch match_curves(const ManifoldMesh& mesh, std::vector<CurveLine> lines,
                        const std::vector<char>& is_corner, const PlacedQuads& quads);

} // namespace bot2nurbs
