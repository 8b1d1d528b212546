// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/quad_domain.h"
#include "layout/patch_complex.h"

namespace bot2nurbs {

//! Whether no two paths join the same vertices: edges of a domain are told by their ends.
bool is_simple(const PatchComplex& quads);

//! Whether every vertex inside has the quads that splines need there: three, or two between
//! creases. Improvement sees to it by whatever changes there are, which at the end of a dart
//! between curves may be none.
bool has_enough_quads(const PatchComplex& quads);

//! A compact complex of quads on a carrier as a domain, with the creases that its marks say and
//! corners by carrier vertex (those beyond the end of `is_corner` are none). Errors:
//! invalid_domain. \pre is_simple(quads) and has_enough_quads(quads)
Result<QuadDomain> make_domain(const PatchComplex& quads, CarrierMesh carrier,
                               const std::vector<char>& is_corner);

} // namespace bot2nurbs
