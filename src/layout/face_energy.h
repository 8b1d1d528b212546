// SPDX-License-Identifier: MIT
#pragma once

#include "layout/patch_complex.h"

namespace bot2nurbs {

//! Distortion of a face's map to the unit square: 1 for a similarity (MapDistortion::combined),
//! infinite when it cannot be mapped. Harmonic energy alone would not notice a limb squeezed into a
//! corner of its patch; stretch alone would not notice shear.
double face_distortion(const PatchComplex& complex, const std::vector<PatchComplex::Side>& border,
                       OverlayBuilder& builder);

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

} // namespace bot2nurbs
