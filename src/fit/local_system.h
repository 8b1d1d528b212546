// SPDX-License-Identifier: MIT
#pragma once

#include "fit/normal_system.h"

#include <vector>

namespace bot2nurbs {

//! The least squares of a round in the unknowns of few quads, while all others keep their values.
//! Dense: for tens of quads at most.
class LocalSystem {
public:
    //! `network` must outlive this. Cost linear in its pieces.
    explicit LocalSystem(const ReducedNetwork& network);

    //! Sets the moves of all unknowns that the quads depend on to those that solve the problem with
    //! point-distance rows (problem.mu is taken as 1). \return false, and no move is changed, where
    //! rows and fairness do not decide them.
    bool solve(const RoundProblem& problem, const std::vector<Index>& quads,
               std::vector<Vec3>& move) const;

private:
    const ReducedNetwork& network_;
    std::vector<std::size_t> offset_; //!< Per unknown: the first of its pieces, and one more.
    std::vector<Index> piece_;        //!< Those that depend on it, ascending.
};

} // namespace bot2nurbs
