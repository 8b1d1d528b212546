// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/quad_complex.h"
#include "fit/reduced_network.h"

#include <vector>

namespace bot2nurbs {

//! What is done about the quads that a step would fold, and about no others.
//!
//! A quad that folds is *held* for the rest of the fit: its samples keep point-distance rows and
//! its fairness falls no further. One that folds again is damped in this round, with the quads
//! around it, more from time to time. Damping shortens the step and any step is allowed, so a spot
//! that must not move does not stop the others.
class FoldResponse {
public:
    //! Both must outlive this.
    FoldResponse(const QuadComplex& complex, const ReducedNetwork& reduced);

    //! Forgets the damping, not the holds.
    void begin_round();
    //! Answers a step that folded these quads. \return the quads that are held from now on.
    std::vector<Index> respond(const std::vector<Index>& folded);
    bool held(Index quad) const { return held_[quad]; }
    //! Per free unknown, for the solve; null when there is none.
    const std::vector<double>* damping() const { return damped_ ? &damping_ : nullptr; }

    //! Multiplies the moves of all unknowns of the quads; those near to them on the rim of the
    //! quads' neighbours move in full.
    void shorten(const std::vector<Index>& quads, double share, std::vector<Vec3>& move) const;
    //! The quads and all that share a vertex with them, ascending.
    std::vector<Index> with_neighbours(const std::vector<Index>& quads) const;

private:
    void damp(Index quad, double damping);

    const QuadComplex& complex_;
    const ReducedNetwork& reduced_;
    std::vector<char> held_;
    std::vector<double> quad_damping_, damping_;
    bool damped_ = false;
};

//! The quads with more folds than before, ascending.
std::vector<Index> more_folded(const std::vector<Index>& before, const std::vector<Index>& after);

} // namespace bot2nurbs
