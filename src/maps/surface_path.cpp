// SPDX-License-Identifier: MIT
#include "maps/surface_path.h"

#include <algorithm>

namespace bot2nurbs {

void reduce(const ManifoldMesh& mesh, SurfacePath& path)
{
    std::vector<PathNode> kept;
    kept.reserve(path.nodes.size());
    for (const PathNode& n : path.nodes) {
        const bool back = !kept.empty() && !n.is_vertex() && !kept.back().is_vertex() &&
                          mesh.twin(kept.back().halfedge) == n.halfedge;
        if (back)
            kept.pop_back();
        else
            kept.push_back(n);
    }
    const auto touches = [&mesh](const PathNode& n, Index v) {
        return !n.is_vertex() && (mesh.from(n.halfedge) == v || mesh.to(n.halfedge) == v);
    };
    std::size_t first = 0, last = kept.size();
    while (first < last && touches(kept[first], path.a))
        ++first;
    while (last > first && touches(kept[last - 1], path.b))
        --last;
    path.nodes.assign(kept.begin() + static_cast<std::ptrdiff_t>(first),
                      kept.begin() + static_cast<std::ptrdiff_t>(last));
}

double length(const ManifoldMesh& mesh, const SurfacePath& path)
{
    Vec3 last = mesh.position(path.a);
    double sum = 0.0;
    for (const PathNode& n : path.nodes) {
        const Vec3 p =
            n.is_vertex() ? mesh.position(n.vertex) : edge_point(mesh, mesh.edge(n.halfedge), n.t);
        sum += norm(p - last);
        last = p;
    }
    return sum + norm(mesh.position(path.b) - last);
}

} // namespace bot2nurbs
