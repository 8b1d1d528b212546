// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/brep.h"

namespace bot2nurbs {

//! The integral of (x - origin) . n / 3 over the faces, normals
//! turned by BrepFace::reversed. For closed faces this is the enclosed volume, whatever the origin.
//! Exact up to rounding: per knot span a Gauss rule of sufficient degree.
double signed_volume(const Brep& brep, const std::vector<Index>& faces, const Vec3& origin);
double signed_volume(const Brep& brep);

//! Area of a patch: Gauss quadrature of |Su x Sv|, not exact.
double patch_area(const BsplinePatch& patch);

} // namespace bot2nurbs
