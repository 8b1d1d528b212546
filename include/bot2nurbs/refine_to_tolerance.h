// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "bot2nurbs/domain_samples.h"
#include "bot2nurbs/fit_network.h"
#include "bot2nurbs/hausdorff_bound.h"
#include "bot2nurbs/layout.h"
#include "bot2nurbs/quad_domain.h"
#include "bot2nurbs/spline_network.h"

#include <memory>
#include <optional>
#include <vector>

namespace bot2nurbs {

//! What refine_to_tolerance() may spend, and on what.
struct ToleranceOptions {
    //! Fits take more rounds and samples than by default. With those of default the 24 runs to 1
    //! and 0.3 % of scripts/tolerance.py need 3 % more patches in the geometric mean.
    ToleranceOptions();

    //! Largest distance wanted between source and surface, both ways, in units of the source; > 0.
    double tolerance = 0.0;
    //! No domain of more patches is made. The default keeps the factors of a fit within a few
    //! gigabytes.
    Index max_patches = 5000;
    SplineScheme spline = SplineScheme::peters;
    //! Of each fit; its emphasis is chosen here. Tangent-distance rows need fewer patches, but may
    //! let samples slide off parts of patches, where the surface then strays: when refinement
    //! stalls with them it goes on with point-distance rows.
    FitOptions fit;
    SampleOptions samples;
    //! Edges stay where they are, as someone drew them; else they are drawn anew after each cut,
    //! straight in the map of their two quads, but for those along edges of the carrier.
    bool keep_edges = false;

    std::optional<Error> check() const;
};

struct Trial;
struct TrialDeleter {
    void operator()(Trial* trial) const;
};
using TrialPointer = std::unique_ptr<Trial, TrialDeleter>;

//! A layout, and what refine_to_tolerance() can use of trying it: null where it was not tried, for
//! it has more than max_patches.
struct TriedLayout {
    LayoutResult layout;
    TrialPointer trial; //!< Without the domain, which is the layout's.
};

//! Why refinement ended.
enum class RefinementEnd {
    tolerance_met, //!< Proven: the upper bound of the distance both ways is within the tolerance;
                   //!< with points: all are, and the surface does not stray from their mesh.
    patch_limit,   //!< No patch that is beyond tolerance can be cut within max_patches, with what
                   //!< must be cut around it.
    noise_limit,   //!< Points: what is farther than the tolerance is no farther than their noise
                   //!< alone puts points, see noise_reach().
    stalled,       //!< Several rounds have lowered neither the distance nor what is beyond it.
    quality_limit, //!< A patch that is beyond tolerance cannot be cut, or its pieces not be fitted.
};

//! The name of an end as reports write it.
const char* name(RefinementEnd end);

//! One round: a fit to one domain, and what is known of its distance from the source. Distances in
//! units of the source.
struct RefinementRound {
    Index patches = 0, unknowns = 0;
    double rms = 0.0;        //!< Of the samples, weighted by area.
    DistanceBounds distance; //!< Both ways, as far as deciding about the tolerance needed it.
    Index exceeding = 0;     //!< Patches known to exceed the tolerance.
    Index beyond = 0;        //!< Patches that are not known to be within the tolerance.
    Index folded = 0;        //!< Patches that fold, see FitSummary.
    //! Including the cutting that led to its domain; of a start that was tried, only what was left.
    double seconds = 0.0;
};

//! The best surface of all rounds: of those within the tolerance the first with the fewest patches
//! that fold, else the one whose largest known distance is least.
struct ToleranceFit {
    QuadDomain domain;
    FitResult fit;
    //! Decided about the tolerance, see HausdorffOptions::decide. With points only their side.
    HausdorffBound bound;
    Index anchors = 0; //!< With points: see make_point_samples().
    std::vector<RefinementRound> rounds;
    Index best = 0; //!< The round it is of.
    RefinementEnd termination = RefinementEnd::tolerance_met;
};

//! The distance that normal noise of this standard deviation is not expected to put any of `count`
//! points beyond: sqrt(2 ln(2 count)) deviations, a bound of the expected largest of so many sizes
//! of normal variables \cite boucheron_2013 (theorem 2.5), and half a deviation for its spread and
//! that of the estimate. 0 for no points.
double noise_reach(double noise, std::size_t count);

//! Fits a spline surface within a tolerance of a mesh, on a domain refined where it must be: fit,
//! bound the distance of every patch, cut the patches that are beyond, close the marks, cut the
//! domain, and fit again; where little is beyond, fit again to what only the bound saw before that.
//! How, and why it ends: docs/algorithms/refinement.md. Cost: that of the last fit times a small
//! number, as the patches grow by a share each round. Same result for any number of threads. \cite
//! eck_hoppe_1996
//!
//! With `points` the surface is fitted to them, robustly, and the distance is theirs from it, one
//! way; patches all of whose points are within noise_reach() are not cut, as more patches would
//! follow the noise.
//!
//! \param tried null, or what layout_for_tolerance() left of trying `start` with the same source,
//! options and points: `start` is not fitted again.
//! \pre the domain is valid. Errors: bad_option; those of compute_charts(), make_samples(),
//! make_point_samples(), build_spline_network(), fit_network(), bound_hausdorff(),
//! find_point_feet(); cancelled.
Result<ToleranceFit> refine_to_tolerance(const ManifoldMesh& source, QuadDomain start,
                                         const ToleranceOptions& options, const PointData* points,
                                         Context& context, TrialPointer tried = nullptr);

//! A layout to start from. Of a few, each finer than the last: the first that is within the
//! tolerance, or as near as noise lets it, else of those of whose patches nine tenths are the one
//! that is expected to end with the fewest; else the nearest within max_patches, or before more
//! patches gained nothing. Where no layout has so few, the first. Cutting patches of a layout that
//! is too coarse nearly everywhere would copy their shapes, and need more of them. `layout.patches`
//! is not used. Errors: bad_option; those of build_layout() and of refine_to_tolerance().
Result<TriedLayout> layout_for_tolerance(const ManifoldMesh& source, LayoutOptions layout,
                                         const ToleranceOptions& options, const PointData* points,
                                         Context& context);

} // namespace bot2nurbs
