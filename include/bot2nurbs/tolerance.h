// SPDX-License-Identifier: MIT
#pragma once

//! Thresholds that more than one stage uses. Lengths are fractions of the bounding box diagonal.
namespace bot2nurbs::tolerance {

//! Vertices closer than this are one vertex: one nanometre on a one-metre part. Far above the
//! rounding of doubles, far below the spacing of single-precision file coordinates (1e-7), so that
//! only copies are welded.
inline constexpr double weld = 1e-9;

} // namespace bot2nurbs::tolerance
