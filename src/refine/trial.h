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
    bool folded = false;   //!< It folds, see FitSummary.
    //! How much the distance from the source changes along u and along v: mean squares of its
    //! differences on the grid of the samples.
    std::array<double, 2> change{};
};

//! A domain, the surface fitted to it, and how far it is from the source.
struct Trial {
    QuadDomain domain;
    std::vector<QuadChart> charts;
    FitResult fit;
    HausdorffBound bound; //!< With points: of these alone.
    std::vector<PatchError> patches;
    bool proven = false; //!< By prove_trial().
    bool within = false; //!< Proven to be within the tolerance.
    Index anchors = 0;   //!< With points: samples of the source that stand in for some.

    Index exceeding() const;
    Index beyond() const;
    Index folded() const;
    Index to_cut() const; //!< Beyond or folded.
    //! The largest distance known of.
    double distance() const;
};

//! What is to be approximated, and how nearly.
struct FitTarget {
    FitTarget(const ManifoldMesh& mesh, const PointData* data, double wanted);

    const ManifoldMesh& source;
    const PointData* points; //!< Null: the source itself.
    double tolerance;
    //! Patches of which a place of the source, or a point, is farther than this are cut.
    double limit;
    //! Patches that are anywhere farther than this from the source are cut: with points the limit
    //! and what they are away from the mesh through them.
    double surface_limit;
    //! Places of the source that proofs have found beyond: samples of every further fit. Not with
    //! points.
    std::vector<SourcePoint> hard_places;
};

//! Fits a surface to a domain and measures its distance from the target at the samples alone:
//! patches beyond it are those that exceed the limit there. Errors: those of compute_charts(),
//! make_samples(), make_point_samples(), build_spline_network(), fit_network().
Result<Trial> make_trial(const FitTarget& target, QuadDomain domain,
                         const ToleranceOptions& options, Context& context);

//! Decides which patches of a trial are within the tolerance. Where that would take long, because
//! the surface is far from the source, some stay undecided: only while others exceed it. Errors:
//! those of bound_hausdorff() and find_point_feet().
Status prove_trial(const FitTarget& target, Trial& trial, Context& context);

} // namespace bot2nurbs
