// SPDX-License-Identifier: MIT
#pragma once

#include "maps/overlay.h"

namespace bot2nurbs {

//! Distortion of a face's map to the unit square: 1 for a similarity (MapDistortion::combined),
//! infinite when it cannot be mapped. Harmonic energy alone would not notice a limb squeezed into a
//! corner of its patch; stretch alone would not notice shear.
double face_distortion(const std::vector<PathSide>& border, OverlayBuilder& builder);

//! The size patches should have: area counted with the square of a density per mesh vertex.
struct SizeMetric {
    const std::vector<double>& density;
    double target_area = 1.0;
};

//! Energy of a patch (a triangle of K_tri counts as half a patch): distortion times the square of
//! its size over the target, or of one half if that is more. The sum over all patches grows with
//! distortion, with uneven sizes, and when fewer patches must cover the surface.
struct FaceEnergy {
    double energy = 0.0; //!< Infinite when the face cannot be mapped.
    double size = 0.0;   //!< Over the target: the energy is at least its square.
};
FaceEnergy face_energy(const std::vector<PathSide>& border, const SizeMetric& metric,
                       OverlayBuilder& builder);

} // namespace bot2nurbs
