// SPDX-License-Identifier: MIT
#include "mesh/features.h"

namespace bot2nurbs {

namespace {

constexpr double degrees_per_radian = 57.295779513082320877;

} // namespace

double normal_angle_deg(const Vec3& a, const Vec3& b)
{
    // Unit length first: squares of the areas of tiny faces would underflow.
    const Vec3 u = normalized(a), v = normalized(b);
    return degrees_per_radian * std::atan2(norm(cross(u, v)), dot(u, v));
}

double dihedral_angle_deg(const ManifoldMesh& mesh, Index h)
{
    const Index t = mesh.twin(h);
    return t == invalid_index ? 0.0
                              : normal_angle_deg(mesh.area_vector(ManifoldMesh::face(h)),
                                                 mesh.area_vector(ManifoldMesh::face(t)));
}

Index count_sharp_edges(const ManifoldMesh& mesh, double angle_deg)
{
    Index sharp = 0;
    for (Index h = 0; h < mesh.halfedge_count(); ++h)
        sharp += mesh.edge(h) == h && dihedral_angle_deg(mesh, h) > angle_deg;
    return sharp;
}

} // namespace bot2nurbs
