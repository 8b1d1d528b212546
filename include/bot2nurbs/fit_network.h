// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "bot2nurbs/spline_network.h"
#include "bot2nurbs/surface_samples.h"

#include <optional>
#include <string>
#include <vector>

namespace bot2nurbs {

//! What a fit round minimises.
enum class DistanceRows {
    point,   //!< |S(u, v) - p|^2 (Eck and Hoppe 1996); one factorisation for x, y and z.
    tangent, //!< (n . (S(u, v) - p))^2 with a small point-distance part: converges much faster.
};

struct FitOptions {
    int max_rounds = 8;     //!< Solves, each but the first after parameter correction; at least 5.
    double fairness = 1e-4; //!< Weight of the thin-plate energy in the first round, dimensionless.
    double fairness_floor = 1e-6; //!< The weight falls by sqrt(10) a round down to this.
    //! Standard deviation of the samples across the surface, in their units. Fairness is raised at
    //! the start until the surface is no nearer to them than this, and does not fall while it is
    //! nearer: a closer fit would follow the noise (Morozov's discrepancy principle).
    double noise = 0.0;
    DistanceRows rows = DistanceRows::tangent;
    //! Distance at which a sample counts twice: from round to round its weight is multiplied by
    //! 1 + (distance / emphasis)^2, up to 11. Lowers the largest distance at the cost of the rms.
    //! 0: all count as their weights say.
    double emphasis = 0.0;
    bool robust = false; //!< Iteratively reweighted least squares (Huber) against outliers.
    //! Standard deviation, in units of the samples, that robust fits assume at least: what lies
    //! nearer than about this is not taken for an outlier, however well other samples are met.
    double least_deviation = 0.0;
    double stall = 0.04; //!< Stop when a round lowers the rms error by less than this share.
    //! Largest condition of the scaled normal matrix that is trusted (half the digits of a double
    //! are left for the solution at 1e8); above it the rows are solved by QR.
    double condition_limit = 1e10;

    std::optional<Error> check() const;
};

//! One round as measured after its solve, at the corrected parameters. Distances in units of the
//! samples.
struct FitRound {
    double rms = 0.0, max = 0.0;
    double fairness = 0.0;
    double damping = 0.0; //!< Point-distance part of tangent-distance rows.
    Index crossed = 0;    //!< Samples whose foot point moved to another patch.
    double seconds = 0.0;
};

struct FitSummary {
    std::vector<FitRound> rounds;
    Index unknowns = 0; //!< After elimination of the constraints.
    Index samples = 0;
    double condition = 0.0;     //!< Estimate for the (scaled) normal matrix.
    bool used_fallback = false; //!< The augmented or QR solve was needed.
    std::string termination;    //!< "stalled" or "round_limit".
    //! Patches that run back over themselves, as seen at 25 places on each of their Bezier pieces:
    //! du x dv passes through zero between two of them, or is more than a right angle away from the
    //! normals of the samples around.
    Index folded_patches = 0;
    //! Per patch: the smallest length of du x dv at these places, negative where it folds, over the
    //! mean length.
    std::vector<double> smallest_jacobians;
};

struct FitResult {
    std::vector<Vec3> unknowns; //!< Satisfy the constraint rows to rounding.
    SplineSurface surface;
    FitSummary summary;
};

//! Fits all patches at once: least squares over the samples, exact thin-plate fairness, constraints
//! eliminated exactly, alternating with closest-point parameter correction that walks over patch
//! edges. `samples.domain` is updated. Same result for any thread count.
//!
//! \param nearest where it is given, further samples are taken from round to round where those
//! there were have slid away, at the places nearest to the surface there; they are not returned.
//! Without them nothing holds the surface there, and no distance from samples to it would tell.
//! Errors: bad_option, empty_input, fit_failed, cancelled.
Result<FitResult> fit_network(const SplineNetwork& network, SurfaceSampleSet& samples,
                              const FitOptions& options, Context& context,
                              const NearestPlace& nearest = {});

} // namespace bot2nurbs
