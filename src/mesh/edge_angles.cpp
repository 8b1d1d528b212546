// SPDX-License-Identifier: MIT
#include "mesh/edge_angles.h"

#include "core/parallel.h"
#include "mesh/features.h"

#include <algorithm>

namespace bot2nurbs {

namespace {

// A side of an edge is averaged over the faces of this many steps from it, and so many at most.
constexpr int side_rings = 3;
constexpr std::size_t side_faces = 16;

// One side of an edge: the mean normal of the faces near it, and how far they spread from it.
struct EdgeSide {
    Vec3 normal;
    double spread = 0.0; // Degrees, mean over area.
};

EdgeSide side_of(const ManifoldMesh& mesh, const std::vector<double>& face_angle, double dividing,
                 Index halfedge)
{
    std::vector<std::pair<Index, int>> faces{{ManifoldMesh::face(halfedge), 0}};
    for (std::size_t i = 0; i < faces.size() && faces.size() < side_faces; ++i) {
        const auto [f, ring] = faces[i];
        for (Index h = 3 * f; ring < side_rings && h < 3 * f + 3; ++h) {
            const Index t = mesh.twin(h);
            if (t == invalid_index || face_angle[h] >= dividing)
                continue;
            const Index g = ManifoldMesh::face(t);
            const auto known = std::find_if(faces.begin(), faces.end(),
                                            [g](const auto& other) { return other.first == g; });
            if (known == faces.end())
                faces.emplace_back(g, ring + 1);
        }
    }
    EdgeSide side;
    double total = 0.0;
    for (const auto& [f, ring] : faces)
        side.normal += mesh.area_vector(f);
    for (const auto& [f, ring] : faces) {
        const double area = norm(mesh.area_vector(f));
        total += area;
        side.spread += area * normal_angle_deg(mesh.area_vector(f), side.normal);
    }
    if (total > 0.0)
        side.spread /= total;
    return side;
}

} // namespace

EdgeAngles measure_edge_angles(const ManifoldMesh& mesh, double dividing, const Context& context)
{
    EdgeAngles angles;
    for (auto* values : {&angles.face, &angles.side, &angles.spread})
        values->assign(mesh.halfedge_count(), 0.0);
    const auto for_each_edge = [&](const auto& act) {
        for_each_chunk(context, mesh.halfedge_count(), 4096,
                       [&](std::size_t begin, std::size_t end) {
                           for (Index h = static_cast<Index>(begin); h < end; ++h)
                               if (mesh.twin(h) != invalid_index && mesh.edge(h) == h)
                                   act(h, mesh.twin(h));
                       });
    };
    for_each_edge(
        [&](Index h, Index t) { angles.face[h] = angles.face[t] = dihedral_angle_deg(mesh, h); });
    for_each_edge([&](Index h, Index t) {
        if (angles.face[h] < dividing)
            return;
        const EdgeSide left = side_of(mesh, angles.face, dividing, h);
        const EdgeSide right = side_of(mesh, angles.face, dividing, t);
        const double angle = normal_angle_deg(left.normal, right.normal);
        angles.side[h] = angles.side[t] = angle;
        if (angle > 0.0)
            angles.spread[h] = angles.spread[t] = 0.5 * (left.spread + right.spread) / angle;
    });
    return angles;
}

} // namespace bot2nurbs
