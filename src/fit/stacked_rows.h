// SPDX-License-Identifier: MIT
#pragma once

#include "fit/normal_system.h"

namespace bot2nurbs {

//! The fallback of a round whose normal equations are too ill-conditioned: sparse QR of the stacked
//! rows themselves, which sees the condition of the rows and not its square. Point-distance rows
//! only (problem.mu is taken as 1). Rows of one Bezier piece are compressed by a dense QR first, so
//! the cost depends on the pieces and hardly on the samples; still many times that of the normal
//! equations. A rank-deficient system gets a basic solution. The condition is that of R, squared,
//! estimated by its diagonal.
NormalSystem::Solution solve_stacked_rows(const ReducedNetwork& network,
                                          const RoundProblem& problem, const Context& context);

} // namespace bot2nurbs
