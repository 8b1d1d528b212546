// SPDX-License-Identifier: MIT
#include "mesh/boundary_loops.h"

namespace bot2nurbs {

std::vector<std::vector<Index>> boundary_loops(const ManifoldMesh& mesh)
{
    std::vector<std::vector<Index>> loops;
    std::vector<char> used(mesh.vertex_count(), 0);
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
        if (used[v] || !mesh.is_boundary_vertex(v))
            continue;
        std::vector<Index> loop;
        Index u = v;
        do {
            used[u] = 1;
            loop.push_back(u);
            u = mesh.to(mesh.halfedge_at(u));
        } while (u != v);
        loops.push_back(std::move(loop));
    }
    return loops;
}

} // namespace bot2nurbs
