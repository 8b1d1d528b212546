// SPDX-License-Identifier: MIT
#include "layout/cut_mesh.h"

#include <algorithm>

namespace bot2nurbs {

CutMesh::CutMesh(const ManifoldMesh& mesh, const std::vector<char>& marks) : whole_(&mesh)
{
    if (std::none_of(marks.begin(), marks.end(), [](char mark) { return mark != 0; }))
        return;
    std::vector<Vec3> positions = mesh.positions();
    std::vector<std::array<Index, 3>> triangles = mesh.triangles();
    original_.resize(mesh.vertex_count());
    for (Index v = 0; v < mesh.vertex_count(); ++v)
        original_[v] = v;
    const auto divides = [&](Index h) {
        const Index t = mesh.twin(h);
        return t == invalid_index || marks[h] || marks[t];
    };
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
        // Begin where a run of faces does; without a cut any face will do.
        Index first = mesh.halfedge_at(v);
        do {
            if (divides(first))
                break;
            first = mesh.twin(ManifoldMesh::prev(first));
        } while (first != mesh.halfedge_at(v));
        Index number = v, h = first;
        do {
            if (h != first && divides(h)) {
                number = static_cast<Index>(positions.size());
                positions.push_back(mesh.position(v));
                original_.push_back(v);
            }
            triangles[h / 3][h % 3] = number;
            h = mesh.twin(ManifoldMesh::prev(h));
        } while (h != first && h != invalid_index);
    }
    // Every run of faces is a fan of its own: the result is manifold.
    cut_ = std::make_unique<ManifoldMesh>(
        std::move(*ManifoldMesh::build(std::move(positions), std::move(triangles))));
}

} // namespace bot2nurbs
