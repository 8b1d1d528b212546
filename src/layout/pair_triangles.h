// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "layout/patch_complex.h"

namespace bot2nurbs {

//! What must become of single pairs of triangles: named by the ends of the edge between them.
struct PairingWishes {
    std::vector<std::pair<Index, Index>> joined; //!< Become one quad, which then stays as it is.
    std::vector<std::pair<Index, Index>> parted; //!< Do not; the edge then stays.
};

//! Joins the triangles of K_tri in pairs: K. Bottleneck-optimal in distortion, then least total of
//! distortion and valence terms. \cite eck_hoppe_1996, section 3.2.
//! Where no perfect matching exists, triangles that have more neighbours depending on them than
//! they can serve are split in three first. \return false when that does not help; the complex may
//! then have more triangles. Errors: cancelled. \pre the complex is compact.
Result<bool> pair_triangles(PatchComplex& complex, const PairingWishes& wishes, Context& context);

} // namespace bot2nurbs
