// SPDX-License-Identifier: MIT
#pragma once

#include "layout/draw_quads.h"
#include "layout/match_curves.h"
#include "layout/quad_carrier.h"

#include <array>
#include <vector>

namespace bot2nurbs {

//! The lines that edges of a quad mesh may follow: the boundary loops of a mesh, and its creases,
//! given as chains of vertices. Creases end where they meet, and at corners (one flag a vertex).
std::vector<CurveLine> followable_lines(const ManifoldMesh& mesh,
                                        const std::vector<std::vector<Index>>& creases,
                                        const std::vector<char>& is_corner);

//! The edges that follow lines, as chains of carrier vertices. Errors: invalid_domain naming an
//! edge whose two ends did not both find their places on its line.
Result<std::vector<DrawnCurve>>
drawn_along_lines(const CurveMatch& match, const ManifoldMesh& source, const QuadCarrier& board);

//! For every edge of the quads whose ends lie on one edge of the source: the part of that edge
//! between them, as carrier vertices; nothing for the others.
std::vector<std::vector<Index>>
ways_along_source(const QuadComplex& quads, const ManifoldMesh& source, const QuadCarrier& board);

//! Vertices of the quads that lie on corners of the mesh, ascending.
std::vector<Index> vertices_on_corners(const CurveMatch& match, const std::vector<char>& is_corner);

//! Edges of creases that no edge of the quads covers whole, as pairs of ascending vertices.
std::vector<std::array<Index, 2>>
edges_not_followed(const CurveMatch& match, const ManifoldMesh& mesh,
                   const std::vector<std::vector<Index>>& creases);

} // namespace bot2nurbs
