// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/manifold_mesh.h"

namespace bot2nurbs {

//! Angle in degrees between two face normals (area vectors of any length), 0 to 180; 0 when a face
//! has no area.
double normal_angle_deg(const Vec3& a, const Vec3& b);

//! Angle in degrees between the normals of the two faces at an edge: 0 where the mesh is flat; 0 at
//! boundaries.
double dihedral_angle_deg(const ManifoldMesh& mesh, Index h);

//! Edges whose dihedral_angle_deg is larger than `angle_deg`.
Index count_sharp_edges(const ManifoldMesh& mesh, double angle_deg);

} // namespace bot2nurbs
