// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/quad_complex.h"
#include "fit/reduced_network.h"

#include <vector>

namespace bot2nurbs {

//! What is done about the quads that a step would fold, and about no others.
//!
//! For the rest of the fit the samples of such a quad slide less: their rows get more of a
//! point-distance part each time it folds. What of a step folds even so is shortened there. Any
//! move of the unknowns is allowed, so a spot that must not move does not stop the others.
class FoldResponse {
public:
    //! Both must outlive this.
    FoldResponse(const QuadComplex& complex, const ReducedNetwork& reduced);

    //! Answers a step with this point-distance part that folded these quads.
    void respond(const std::vector<Index>& folded, double mu);
    //! Point-distance part of the rows of a quad, at least.
    double least_mu(Index quad) const { return least_mu_[quad]; }

    //! Multiplies the moves of all unknowns that these quads depend on.
    void shorten(const std::vector<Index>& quads, double share, std::vector<Vec3>& move) const;
    //! The quads and all that share a vertex with them, ascending.
    std::vector<Index> with_neighbours(const std::vector<Index>& quads) const;

private:
    const QuadComplex& complex_;
    const ReducedNetwork& reduced_;
    std::vector<double> least_mu_;
};

//! The quads with more folds than before, ascending.
std::vector<Index> more_folded(const std::vector<Index>& before, const std::vector<Index>& after);

} // namespace bot2nurbs
