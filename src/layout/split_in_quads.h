// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/quad_domain.h"
#include "layout/patch_complex.h"

#include <memory>

namespace bot2nurbs {

//! A complex of quads together with the carrier its paths run on.
struct SplitComplex {
    std::unique_ptr<CarrierMesh> carrier; //!< At a fixed address: the complex refers to its mesh.
    PatchComplex complex;
};

//! The global fallback where triangles cannot be paired: every triangle of K_tri becomes three
//! quads, by its centre and the middles of its sides (Eck and Hoppe 1996, section 3.2). Needs no
//! matching and always exists. The paths are cut into the carrier, so that the new vertices on
//! and between them are carrier vertices again.
//! Errors: layout_failed when a triangle cannot be mapped, cancelled.
Result<SplitComplex> split_in_quads(PatchComplex& triangles, const ManifoldMesh& source,
                                    const CarrierMesh& carrier, Context& context);

} // namespace bot2nurbs
