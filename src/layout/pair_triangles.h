// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "layout/patch_complex.h"

namespace bot2nurbs {

//! Joins the triangles of K_tri in pairs: K. Bottleneck-optimal in distortion, then least total of
//! distortion and valence terms. \cite eck_hoppe_1996, section 3.2.
//! Where no perfect matching exists, triangles that have more neighbours depending on them than
//! they can serve are split in three first. \return false when that does not help; the complex may
//! then have more triangles. Errors: cancelled. \pre the complex is compact.
Result<bool> pair_triangles(PatchComplex& complex, Context& context);

} // namespace bot2nurbs
