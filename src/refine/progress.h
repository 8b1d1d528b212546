// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/refine_to_tolerance.h"

#include <cstddef>
#include <vector>

namespace bot2nurbs {

//! Whether the last rounds, of those from `first` on, have come no nearer to the tolerance.
//!
//! Nearer is a largest distance lower by a tenth than the least at any such round before, or a
//! tenth fewer patches known to exceed the tolerance. At least `waits` rounds must be in vain, and
//! their patches must have grown by a fifth since the last one that was nearer, for a round that
//! cuts one patch of hundreds costs little; but eight rounds are enough in any case.
//!
//! \pre first < rounds.size()
bool stalled(const std::vector<RefinementRound>& rounds, std::size_t first, std::size_t waits);

} // namespace bot2nurbs
