// SPDX-License-Identifier: MIT
#pragma once

#include "refine/trial.h"

namespace bot2nurbs {

//! The edges to cut, closed: those of the patches beyond tolerance, of the worst of them where all
//! would make too many patches; across the direction along which the distance changes, or across
//! both. Empty when no patch can be cut within the limit. Patches much nearer than the worst one
//! are left for later rounds, for what is fitted better beside them often brings them within
//! tolerance.
std::vector<char> choose_marks(const Trial& trial, Index max_patches);

} // namespace bot2nurbs
