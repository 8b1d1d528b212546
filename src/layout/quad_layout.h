// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "layout/patch_complex.h"

namespace bot2nurbs {

//! Distortion of a face's map: its harmonic energy on the unit square (1 for a conformal map of a
//! region with the proportions of a square), infinite when it cannot be mapped.
double face_distortion(PatchComplex& complex, const std::vector<PatchComplex::Side>& border);

//! Joins the triangles of K_tri in pairs: K. Bottleneck-optimal in distortion, then least total of
//! distortion and valence terms. \cite eck_hoppe_1996, section 3.2.
//! \return false, with nothing changed, when no perfect matching exists: some pairs cannot be
//! mapped. Errors: cancelled.
Result<bool> pair_triangles(PatchComplex& complex, Context& context);

struct QuadImprovement {
    Index rotations = 0, collapses = 0, doublets = 0, relocations = 0;
};

//! Improves K: removes vertices of degree two, rotates edges, collapses quads along a diagonal,
//! moves vertices to the middle of their star and straightens edges, as long as that lowers the
//! sum of the quads' distortion and a penalty for valences other than four. Quads are only
//! collapsed while more than `min_quads` remain.
QuadImprovement improve_quads(PatchComplex& complex, Index min_quads, Context& context);

} // namespace bot2nurbs
