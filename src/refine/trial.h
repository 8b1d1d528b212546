// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/refine_to_tolerance.h"

#include <array>

namespace bot2nurbs {

//! What a fit leaves of one patch.
struct PatchError {
    double distance = 0.0; //!< Largest distance known of, both ways.
    bool exceeds = false;  //!< A place is known to be beyond the tolerance.
    bool beyond = false;   //!< Not known to be within the tolerance.
    //! How much the distance from the source changes along u and along v: mean squares of its
    //! differences on the grid of the samples.
    std::array<double, 2> change{};
};

//! A domain, the surface fitted to it, and how far it is from the source.
struct Trial {
    QuadDomain domain;
    std::vector<QuadChart> charts;
    FitResult fit;
    HausdorffBound bound;
    std::vector<PatchError> patches;

    Index exceeding() const;
    Index beyond() const;
    //! The largest distance known of.
    double distance() const;
};

//! Fits a surface to a domain and measures its distance from the source at the samples alone:
//! patches beyond it are those that exceed the tolerance there. Errors: those of compute_charts(),
//! make_samples(), build_spline_network(), fit_network().
Result<Trial> make_trial(const ManifoldMesh& source, QuadDomain domain,
                         const ToleranceOptions& options, Context& context);

//! Decides which patches of a trial are within the tolerance. Where that would take long, because
//! the surface is far from the source, some stay undecided: only while others exceed it. Errors:
//! those of bound_hausdorff().
Status prove_trial(const ManifoldMesh& source, double tolerance, Trial& trial, Context& context);

} // namespace bot2nurbs
