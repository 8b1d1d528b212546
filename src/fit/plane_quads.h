// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/surface_samples.h"

#include <vector>

namespace bot2nurbs {

//! Per sample: 1 when all samples of its quad lie in one plane and have its normal, both but for
//! the rounding of single precision, and it is not of a crease or boundary itself. All 0 without
//! normals. \pre points in a unit box
std::vector<char> in_plane_quads(Index quads, const std::vector<Vec3>& points,
                                 const std::vector<Vec3>& normals,
                                 const std::vector<DomainPoint>& where,
                                 const std::vector<char>& on_curve);

} // namespace bot2nurbs
