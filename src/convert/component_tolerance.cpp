// SPDX-License-Identifier: MIT
#include "convert/component_tolerance.h"

#include <algorithm>
#include <fmt/format.h>

namespace bot2nurbs {

namespace {

//! What refinement aims at, over what was asked for: room for rounding on the way to the units of
//! the input, and for ties of the bound.
constexpr double aim = 1.0 - 1e-5;

//! Whether a surface that is so near is near enough.
void decide(ToleranceReport& report)
{
    report.met = report.distance.upper <= report.tolerance;
    // Coordinates far from the origin are rounded when they are written, which no cut mends.
    if (!report.met && report.termination == RefinementEnd::tolerance_met)
        report.termination = RefinementEnd::stalled;
}

} // namespace

ToleranceOptions tolerance_options(const ConvertOptions& options, double tolerance)
{
    ToleranceOptions result;
    result.tolerance = aim * tolerance;
    if (options.max_patches)
        result.max_patches = *options.max_patches;
    result.spline = options.spline;
    result.keep_edges = options.domain_in.has_value() || options.quads.has_value() || options.cage;
    const double stall = result.fit.stall;
    result.fit = options.fit;
    result.fit.stall = std::min(options.fit.stall, stall);
    result.fit.fairness_floor = std::min(options.fit.fairness_floor, FitOptions().fairness_floor);
    return result;
}

ToleranceReport describe(const ToleranceFit& fit, double scale)
{
    ToleranceReport report;
    report.termination = fit.termination;
    report.rounds = fit.rounds;
    report.best = fit.best;
    for (RefinementRound& round : report.rounds) {
        round.rms *= scale;
        round.distance.lower *= scale;
        round.distance.upper *= scale;
    }
    return report;
}

void log_rounds(const ToleranceReport& report, const Context& context)
{
    for (std::size_t i = 0; i < report.rounds.size(); ++i) {
        const RefinementRound& r = report.rounds[i];
        context.log(LogLevel::info,
                    fmt::format("refinement round {}: {} patches, rms {:.4g}, distance at least "
                                "{:.4g} and at most {:.4g}, {} patches exceed the tolerance, {} "
                                "more may, {} fold, {:.2f} s",
                                i + 1, r.patches, r.rms, r.distance.lower, r.distance.upper,
                                r.exceeding, r.beyond - r.exceeding, r.folded, r.seconds));
    }
}

Status judge(const ManifoldMesh& source, const QuadComplex& complex, const SplineSurface& surface,
             const HausdorffBound& bound, ToleranceReport& report, Context& context)
{
    report.distance = {bound.lower(), bound.upper()};
    report.worst = bound.worse_side().worst;
    if (bound.lower() <= report.tolerance && bound.upper() > report.tolerance) {
        HausdorffOptions options;
        options.decide = report.tolerance;
        const Result<HausdorffBound> decided =
            bound_hausdorff(source, complex, surface, options, context);
        if (!decided)
            return decided.error();
        report.distance.upper = std::min(report.distance.upper, decided->upper());
    }
    decide(report);
    return {};
}

void judge_points(const FarPlace& worst, ComponentOutcome& outcome)
{
    ToleranceReport& report = *outcome.tolerance;
    report.distance = {worst.distance, worst.distance};
    report.worst = worst;
    // Points may be near a surface that strays from them elsewhere.
    if (report.termination == RefinementEnd::tolerance_met)
        decide(report);
    outcome.fit.termination = name(report.termination);
}

} // namespace bot2nurbs
