// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "layout/patch_complex.h"

namespace bot2nurbs {

//! Distortion of a face's map to the unit square: 1 for a similarity (MapDistortion::combined),
//! infinite when it cannot be mapped. Harmonic energy alone would not notice a limb squeezed into a
//! corner of its patch; stretch alone would not notice shear.
double face_distortion(const PatchComplex& complex, const std::vector<PatchComplex::Side>& border,
                       OverlayBuilder& builder);

//! Joins the triangles of K_tri in pairs: K. Bottleneck-optimal in distortion, then least total of
//! distortion and valence terms. \cite eck_hoppe_1996, section 3.2.
//! \return false, with nothing changed, when no perfect matching exists: some pairs cannot be
//! mapped. Errors: cancelled.
Result<bool> pair_triangles(PatchComplex& complex, Context& context);

//! The size patches should have: area counted with the square of a density per mesh vertex.
struct SizeMetric {
    const std::vector<double>& density;
    double target_area = 1.0;
};

//! Energy of a patch (a triangle of K_tri counts as half a patch): distortion times the square of
//! its size over the target. The sum over all patches grows with distortion, with uneven sizes, and
//! when fewer patches must cover the surface.
//! `size`, if given, receives the size over the target: the energy is at least its square.
double face_energy(const PatchComplex& complex, const std::vector<PatchComplex::Side>& border,
                   const SizeMetric& metric, OverlayBuilder& builder, double* size = nullptr);

//! Improves K_tri before pairing: flips edges, moves vertices to the middle of their star and
//! straightens edges, as long as that lowers the sum of energies and a penalty for valences other
//! than six. Vertices of low valence would become vertices of degree two in K.
void improve_triangles(PatchComplex& complex, const SizeMetric& metric, Context& context);

struct QuadImprovement {
    Index rotations = 0, collapses = 0, doublets = 0, relocations = 0;
};

//! Improves K: removes vertices of degree two, rotates edges, collapses quads along a diagonal,
//! moves vertices to the middle of their star and straightens edges, as long as that lowers the
//! sum of the quads' energies and a penalty for valences other than four. The number of quads only
//! falls while more than `min_quads` remain.
QuadImprovement improve_quads(PatchComplex& complex, Index min_quads, const SizeMetric& metric,
                              Context& context);

} // namespace bot2nurbs
