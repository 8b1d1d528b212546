// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/manifold_mesh.h"
#include "bot2nurbs/reconstruct_surface.h"

#include <array>
#include <functional>
#include <vector>

namespace bot2nurbs {

//! The mesh of triangles between points, with a vertex for every fan of triangles at a point: where
//! pivot_balls() made several meet, they come apart, and the mesh is two-manifold. Points without
//! triangles are left out. \pre no edge has two triangles that run along it the same way
TriangleSoup mesh_of_fans(const std::vector<Vec3>& points,
                          const std::vector<std::array<Index, 3>>& triangles);

//! Finds the boundary loops of a two-manifold mesh, and fills those that `may_fill` says yes to
//! with triangles between their vertices: where there are at most 200 of these, as the cost grows
//! with their cube, and no edge is needed that the mesh has already. \return the loops and what
//! became of them: the size is the diagonal of the box around a loop, the spacings are that over
//! the mean length of its edges, the area is that of the triangles
std::vector<CloudHole> fill_loops(TriangleSoup& mesh,
                                  const std::function<bool(const CloudHole&)>& may_fill);

} // namespace bot2nurbs
