// SPDX-License-Identifier: MIT
#include "domain/domain_paths.h"

namespace bot2nurbs {

namespace {

// A face that has both the place the path is at and the mesh edge of halfedge h, as the halfedge of
// that edge in it. `face` is the face the path is in, or invalid when it is at a vertex.
Index leaving_halfedge(const ManifoldMesh& mesh, Index h, Index face, Index vertex)
{
    for (const Index g : {h, mesh.twin(h)}) {
        if (g == invalid_index)
            continue;
        if (face != invalid_index ? ManifoldMesh::face(g) == face
                                  : mesh.from(ManifoldMesh::prev(g)) == vertex)
            return g;
    }
    return invalid_index;
}

} // namespace

Result<SurfacePath> domain_path(const QuadDomain& domain, Index edge)
{
    const ManifoldMesh& mesh = domain.carrier.mesh;
    const DomainEdge& source = domain.edges[edge];
    const auto broken = [edge](const std::string& what) {
        return Error{ErrorCode::invalid_domain, "domain edge " + std::to_string(edge) + ": " + what,
                     edge};
    };
    SurfacePath path;
    path.a = domain.vertices[source.a];
    path.b = domain.vertices[source.b];
    path.nodes.reserve(source.path.size());
    // Where the path is: at a mesh vertex, or inside a face it has just entered.
    Index vertex = path.a, face = invalid_index;
    for (std::size_t i = 0; i < source.path.size(); ++i) {
        const PathPoint& p = source.path[i];
        PathNode node;
        if (p.is_vertex()) {
            node.vertex = p.from;
            const bool reached = face == invalid_index
                                     ? mesh.find_halfedge(vertex, p.from) != invalid_index ||
                                           mesh.find_halfedge(p.from, vertex) != invalid_index
                                     : mesh.triangle(face)[0] == p.from ||
                                           mesh.triangle(face)[1] == p.from ||
                                           mesh.triangle(face)[2] == p.from;
            if (!reached)
                return broken("point " + std::to_string(i) +
                              " is not on the face of the one before");
            vertex = p.from;
            face = invalid_index;
        } else {
            Index h = mesh.find_halfedge(p.from, p.to);
            if (h == invalid_index)
                h = mesh.find_halfedge(p.to, p.from);
            if (h == invalid_index)
                return broken("point " + std::to_string(i) + " lies on no mesh edge");
            node.halfedge = leaving_halfedge(mesh, h, face, vertex);
            if (node.halfedge == invalid_index)
                return broken("point " + std::to_string(i) +
                              " is not on the face of the one before");
            const Index named = mesh.edge(node.halfedge);
            node.t = mesh.from(named) == p.from ? p.t : 1.0 - p.t;
            if (mesh.twin(node.halfedge) == invalid_index)
                return broken("point " + std::to_string(i) + " leaves the mesh");
            face = ManifoldMesh::face(mesh.twin(node.halfedge));
            vertex = invalid_index;
        }
        path.nodes.push_back(node);
    }
    const auto& last = face == invalid_index ? std::array<Index, 3>{} : mesh.triangle(face);
    const bool arrives = face == invalid_index
                             ? mesh.find_halfedge(vertex, path.b) != invalid_index ||
                                   mesh.find_halfedge(path.b, vertex) != invalid_index
                             : last[0] == path.b || last[1] == path.b || last[2] == path.b;
    if (!arrives)
        return broken("its last point is not on a face of its end");
    return path;
}

std::vector<PathPoint> path_points(const ManifoldMesh& mesh, const SurfacePath& path)
{
    std::vector<PathPoint> points;
    points.reserve(path.nodes.size());
    for (const PathNode& n : path.nodes) {
        if (n.is_vertex()) {
            points.push_back({n.vertex, n.vertex, 0.0});
        } else {
            const Index e = mesh.edge(n.halfedge);
            points.push_back({mesh.from(e), mesh.to(e), n.t});
        }
    }
    return points;
}

} // namespace bot2nurbs
