// SPDX-License-Identifier: MIT
#include "bot2nurbs/fit_network.h"

#include "fit/fit_loop.h"

#include <algorithm>
#include <cmath>

namespace bot2nurbs {

namespace {

//! The first solve and four corrections, as \cite eck_hoppe_1996 used.
constexpr int least_rounds = 5;

Status check_samples(const SplineNetwork& network, const SurfaceSampleSet& samples)
{
    const std::size_t n = samples.size();
    if (n == 0 || network.unknown_count == 0)
        return Error{ErrorCode::empty_input, "there is nothing to fit", invalid_index};
    if (samples.weights.size() != n || samples.domain.size() != n ||
        (!samples.normals.empty() && samples.normals.size() != n) ||
        (!samples.on_curve.empty() && samples.on_curve.size() != n))
        return Error{ErrorCode::bad_geometry,
                     "samples without a weight, a normal or parameters each", invalid_index};
    for (std::size_t i = 0; i < n; ++i) {
        const DomainPoint& d = samples.domain[i];
        if (!is_finite(samples.positions[i]) || !(samples.weights[i] > 0.0) ||
            !std::isfinite(samples.weights[i]) || d.quad >= network.complex.quad_count() ||
            !(d.u >= 0.0 && d.u <= 1.0 && d.v >= 0.0 && d.v <= 1.0))
            return Error{ErrorCode::bad_geometry,
                         "sample " + std::to_string(i) +
                             " has a position, weight or parameter out of range",
                         static_cast<Index>(i)};
        if (!samples.on_curve.empty() && samples.on_curve[i] && !on_sharp_edge(network.complex, d))
            return Error{ErrorCode::bad_geometry,
                         "sample " + std::to_string(i) +
                             " is one of a curve but its place is on no sharp edge",
                         static_cast<Index>(i)};
    }
    return std::nullopt;
}

} // namespace

std::optional<Error> FitOptions::check() const
{
    const auto bad = [](const char* what) {
        return Error{ErrorCode::bad_option, what, invalid_index};
    };
    if (max_rounds < least_rounds)
        return bad("fit: max_rounds must be at least 5");
    if (!(fairness > 0.0) || !std::isfinite(fairness))
        return bad("fit: fairness must be positive");
    if (!(fairness_floor > 0.0) || fairness_floor > fairness)
        return bad("fit: fairness_floor must be positive and at most fairness");
    if (!(noise >= 0.0) || !std::isfinite(noise))
        return bad("fit: noise must not be negative");
    if (!(least_deviation >= 0.0) || !std::isfinite(least_deviation))
        return bad("fit: least_deviation must not be negative");
    if (!(emphasis >= 0.0) || !std::isfinite(emphasis))
        return bad("fit: emphasis must not be negative");
    if (!(stall >= 0.0 && stall < 1.0))
        return bad("fit: stall must be in [0, 1)");
    if (!(condition_limit >= 1.0))
        return bad("fit: condition_limit must be at least 1");
    return std::nullopt;
}

Result<FitResult> fit_network(const SplineNetwork& network, SurfaceSampleSet& samples,
                              const FitOptions& options, Context& context,
                              const NearestPlace& nearest)
{
    if (const auto error = options.check())
        return *error;
    if (const auto error = check_samples(network, samples))
        return *error;
    // A unit box about the origin, and weights that sum to one: every number below is of order one.
    Box3 box;
    for (const Vec3& p : samples.positions)
        box.add(p);
    const Vec3 size = box.max - box.min, center = box.center();
    const double extent = std::max({size.x, size.y, size.z});
    if (!(extent > 0.0))
        return Error{ErrorCode::bad_geometry, "all samples lie on one point", invalid_index};
    double weight_sum = 0.0;
    for (const double w : samples.weights)
        weight_sum += w;
    auto reduced = ReducedNetwork::build(network, context);
    if (!reduced)
        return reduced.error();

    FitOptions scaled = options;
    scaled.noise /= extent;
    scaled.least_deviation /= extent;
    FitLoop loop(network, *reduced, scaled, context);
    loop.points.resize(samples.size());
    loop.weights.resize(samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
        loop.points[i] = (samples.positions[i] - center) / extent;
        loop.weights[i] = samples.weights[i] / weight_sum;
    }
    loop.emphasis = options.emphasis / extent;
    loop.where = samples.domain;
    loop.normals = samples.normals;
    loop.on_curve = samples.on_curve;
    if (nearest)
        loop.nearest = [&](const Vec3& p, const Vec3& along) {
            std::optional<NearPlace> found = nearest(extent * p + center, along);
            if (found)
                found->position = (found->position - center) / extent;
            return found;
        };
    if (const auto error = loop.run())
        return *error;

    FitResult result;
    result.summary = std::move(loop.summary);
    for (FitRound& round : result.summary.rounds) {
        round.rms *= extent;
        round.max *= extent;
    }
    // Undone on the free unknowns, so that the eliminated ones satisfy their rows to rounding.
    for (Index i = 0; i < reduced->free_count(); ++i) {
        Vec3& x = loop.unknowns[i];
        x = extent * x + (reduced->is_point(i) ? center : Vec3{});
    }
    result.unknowns = reduced->expand(loop.unknowns);
    result.surface = SplineSurface(network, result.unknowns);
    loop.where.resize(samples.size()); // Without those of gaps.
    samples.domain = std::move(loop.where);
    return result;
}

} // namespace bot2nurbs
