// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "layout/patch_complex.h"

namespace bot2nurbs {

//! Joins the triangles of K_tri in pairs: K. Bottleneck-optimal in distortion, then least total of
//! distortion and valence terms. \cite eck_hoppe_1996, section 3.2.
//! \return false, with nothing changed, when no perfect matching exists: some pairs cannot be
//! mapped. Errors: cancelled.
Result<bool> pair_triangles(PatchComplex& complex, Context& context);

} // namespace bot2nurbs
