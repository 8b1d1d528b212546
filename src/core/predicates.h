// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/vec.h"

namespace bot2nurbs {

//! Orientation of the triangle abc: 1 counter-clockwise, -1 clockwise, 0 collinear. Exact for all
//! finite coordinates whose products neither overflow nor underflow. \cite shewchuk_1997
int orient2d(const Vec2& a, const Vec2& b, const Vec2& c);

//! Side of the plane abc on which d lies: 1 below (abc clockwise seen from d is counter-clockwise
//! from above), -1 above, 0 coplanar; the sign of det[a - d; b - d; c - d]. Exact as orient2d.
int orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

} // namespace bot2nurbs
