// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/manifold_mesh.h"

#include <vector>

namespace bot2nurbs {

//! An inner point of a path over a mesh: a crossing of a mesh edge, or a mesh vertex on the way.
struct PathNode {
    //! Crossing: the halfedge of the face the path leaves; invalid for a vertex.
    Index halfedge = invalid_index;
    //! The mesh vertex the path runs through; invalid for a crossing.
    Index vertex = invalid_index;
    //! Crossing: place on the edge, from 0 at the start of mesh.edge(halfedge) to 1 at its end.
    double t = 0.0;

    bool is_vertex() const { return vertex != invalid_index; }
};

//! A path over a mesh from vertex a to vertex b. Two consecutive points lie on one face. Crossings
//! of one edge by any number of paths have distinct t, whose order says which path runs where; so
//! two paths that do not cross in that order do not cross on the surface, whatever the rounding of
//! t.
struct SurfacePath {
    Index a = invalid_index, b = invalid_index;
    std::vector<PathNode> nodes;
};

//! A path traversed from one end to the other.
struct PathSide {
    const SurfacePath* path = nullptr;
    bool reversed = false;

    Index start() const { return reversed ? path->b : path->a; }
    Index end() const { return reversed ? path->a : path->b; }
    std::size_t node_count() const { return path->nodes.size(); }
    //! Node i in the direction of travel, its halfedge that of the face the traveller leaves.
    PathNode node(const ManifoldMesh& mesh, std::size_t i) const
    {
        if (!reversed)
            return path->nodes[i];
        PathNode n = path->nodes[path->nodes.size() - 1 - i];
        if (!n.is_vertex())
            n.halfedge = mesh.twin(n.halfedge);
        return n;
    }
};

//! Place of a crossing in space.
inline Vec3 edge_point(const ManifoldMesh& mesh, Index edge, double t)
{
    return (1.0 - t) * mesh.position(mesh.from(edge)) + t * mesh.position(mesh.to(edge));
}

//! Removes detours that hold nothing: an edge crossed forth and at once back, and edges at an end
//! vertex crossed right after leaving it. What stays is the same path up to a motion over the
//! surface that passes no vertex, so reduced paths that did not cross still do not. Of several
//! crossings that one is left of, the place of the one nearest to the start of the edge is kept.
void reduce(const ManifoldMesh& mesh, SurfacePath& path);

//! Length of the polyline.
double length(const ManifoldMesh& mesh, const SurfacePath& path);

} // namespace bot2nurbs
