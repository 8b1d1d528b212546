// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/domain_constraints.h"

#include <vector>

namespace bot2nurbs {

//! A chain of mesh edges that must become edges of the domain, between two nodes or closed.
struct Curve {
    FeatureKind kind = FeatureKind::crease;
    bool whole = false;          //!< Must become one edge of the domain.
    std::vector<Index> vertices; //!< In order; the first is repeated at the end of a closed one.

    bool closed() const { return vertices.front() == vertices.back(); }
};

//! Marks of halfedges: 0 for none, otherwise what the edge is part of.
char mark_of(FeatureKind kind);
//! The mark of a smooth seam that joins two sites and must not be divided.
inline constexpr char joint_mark = 5;

//! Marks the edges of paths on both halfedges, and the boundary of the mesh. Later paths win.
//! \pre paths follow edges of the mesh
std::vector<char> mark_edges(const ManifoldMesh& mesh, const std::vector<FeaturePath>& paths);

//! The marked edges as chains. A chain ends at nodes: where the number of marked edges is not two,
//! where the kind changes, and at `nodes` (one flag a vertex). Closed chains without a node start
//! at their smallest vertex. Cost linear.
std::vector<Curve> trace_curves(const ManifoldMesh& mesh, const std::vector<char>& marks,
                                const std::vector<char>& nodes);

//! Numbers of the points of a polyline that divide it into pieces of about `width`, lengths counted
//! with a density per point, and of a right angle of turning at most: its ends, and those nearest
//! to equal spacing. At least `least` pieces, if it has as many edges. Ascending, ends included.
std::vector<std::size_t> divide_polyline(const std::vector<Vec3>& points,
                                         const std::vector<double>& density, double width,
                                         std::size_t least);

} // namespace bot2nurbs
