// SPDX-License-Identifier: MIT
#pragma once

#include "maps/retile.h"

#include <vector>

namespace bot2nurbs::fixtures {

//! A path along mesh edges through the given vertices.
inline SurfacePath edge_path(const std::vector<Index>& vertices)
{
    SurfacePath path;
    path.a = vertices.front();
    path.b = vertices.back();
    for (std::size_t i = 1; i + 1 < vertices.size(); ++i) {
        PathNode node;
        node.vertex = vertices[i];
        path.nodes.push_back(node);
    }
    return path;
}

//! The straight path across the two faces of an edge, from the corner on its left to that on its
//! right.
inline SurfacePath crossing_path(const ManifoldMesh& mesh, Index h, double t)
{
    SurfacePath path;
    path.a = mesh.from(ManifoldMesh::prev(h));
    path.b = mesh.from(ManifoldMesh::prev(mesh.twin(h)));
    PathNode node;
    node.halfedge = h;
    node.t = t;
    path.nodes.push_back(node);
    return path;
}

inline double area_in_space(const Overlay& overlay)
{
    double area = 0.0;
    for (const auto& t : overlay.triangles)
        area +=
            0.5 * norm(cross(overlay.vertices[t[1]].position - overlay.vertices[t[0]].position,
                             overlay.vertices[t[2]].position - overlay.vertices[t[0]].position));
    return area;
}

inline double surface_area(const ManifoldMesh& mesh)
{
    double area = 0.0;
    for (Index f = 0; f < mesh.face_count(); ++f)
        area += 0.5 * norm(mesh.area_vector(f));
    return area;
}

} // namespace bot2nurbs::fixtures
