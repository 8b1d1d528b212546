// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "layout/face_energy.h"
#include "layout/patch_complex.h"

namespace bot2nurbs {

//! Improves K_tri before pairing: flips edges, moves vertices to the middle of their star and
//! straightens edges, as long as that lowers the sum of energies and a penalty for valences other
//! than six. Vertices of low valence would become vertices of degree two in K.
void improve_triangles(PatchComplex& complex, const SizeMetric& metric, Context& context);

//! Improves K: removes vertices of degree two, rotates edges, collapses quads along a diagonal,
//! moves vertices to the middle of their star and straightens edges, as long as that lowers the
//! sum of the quads' energies and a penalty for valences other than four. The number of quads only
//! falls while more than `min_quads` remain.
void improve_quads(PatchComplex& complex, Index min_quads, const SizeMetric& metric,
                   Context& context);

} // namespace bot2nurbs
