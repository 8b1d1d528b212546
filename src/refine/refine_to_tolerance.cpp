// SPDX-License-Identifier: MIT
#include "bot2nurbs/refine_to_tolerance.h"

#include "bot2nurbs/refine_domain.h"
#include "layout/straighten_domain.h"
#include "refine/choose_marks.h"
#include "refine/progress.h"
#include "refine/trial.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <string>
#include <utility>

namespace bot2nurbs {

namespace {

// Rounds without progress before refinement may be given up, see stalled(): a place where a crease
// of the source is rounded may get worse before it gets better. While other rows are left to try,
// fewer.
constexpr std::size_t patience = 3, tangent_patience = 2;
// Of the edges of a domain after a cut. A second pass makes no fewer patches.
constexpr int straightening_passes = 1;

// With no more patches than this beyond the tolerance, and those by no more than this factor, a fit
// to the places that the proof found may do; so often for one domain, as long as it helps.
constexpr Index most_near_misses = 2;
constexpr double near_miss_ratio = 1.5;
constexpr int most_repeats = 3;

double now()
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

RefinementRound describe(const Trial& trial, double seconds)
{
    RefinementRound round;
    round.patches = trial.domain.complex.quad_count();
    round.unknowns = trial.fit.summary.unknowns;
    round.rms = trial.fit.summary.rounds.back().rms;
    round.distance.lower = std::max(trial.distance(), trial.bound.lower());
    round.distance.upper = std::max(round.distance.lower, trial.bound.upper());
    round.exceeding = trial.exceeding();
    round.beyond = trial.beyond();
    round.folded = trial.folded();
    round.seconds = seconds;
    return round;
}

// Whether the last round is nearer to the tolerance than the best one so far, or folds less.
bool better(const std::vector<RefinementRound>& rounds, Index best)
{
    const RefinementRound &a = rounds.back(), &b = rounds[best];
    if (rounds.size() == 1 || (a.beyond == 0) != (b.beyond == 0))
        return rounds.size() == 1 || a.beyond == 0;
    return a.beyond == 0 ? a.folded < b.folded : a.distance.lower < b.distance.lower;
}

// Cuts the domain of a trial where it must be. \return why not, if it cannot be.
Result<std::optional<RefinementEnd>> cut(const ManifoldMesh& source, const Trial& trial,
                                         const ToleranceOptions& options, QuadDomain& domain,
                                         Context& context)
{
    using End = std::optional<RefinementEnd>;
    const std::vector<char> marks = choose_marks(trial, options.max_patches);
    if (marks.empty())
        return End(RefinementEnd::patch_limit);
    Result<RefinedDomain> refined = refine_domain(source, trial.domain, marks, context);
    if (!refined && refined.error().code == ErrorCode::layout_failed)
        return End(RefinementEnd::quality_limit);
    if (!refined)
        return refined.error();
    domain = std::move(refined->domain);
    if (!options.keep_edges)
        if (Status stopped = straighten_domain(domain, straightening_passes, context))
            return *stopped;
    return End();
}

// The places where the proof has found the distance largest, one a side, as far as they are beyond.
void add_worst(const HausdorffBound& bound, double tolerance, std::vector<SourcePoint>& places)
{
    for (const OneSidedDistance* side : {&bound.surface_to_source, &bound.source_to_surface})
        if (side->lower > tolerance)
            places.push_back(side->worst.source);
}

// Whether so little is beyond the tolerance that a fit to the very places may do.
bool near_miss(const Trial& trial, double tolerance)
{
    const Index exceeding = trial.exceeding();
    return exceeding > 0 && exceeding <= most_near_misses &&
           trial.distance() <= near_miss_ratio * tolerance;
}

// Where refinement stands after a round.
struct Progress {
    bool reached = false; // A round before was within the tolerance.
    bool is_best = false;
    bool tangent = false;  // Rows of the fit.
    std::size_t first = 0; // Round with these rows.
    int repeats = 0;       // Of fits to the domain of now.
};

enum class Step { end, stall, repeat, change_rows, cut };

Step next_step(const std::vector<RefinementRound>& rounds, const FitTarget& target,
               const Trial& trial, const Progress& now)
{
    const bool near = trial.within || (target.points != nullptr && trial.beyond() == 0);
    // Within the tolerance only folds are left to cut: as long as that makes fewer of them.
    if (near)
        return trial.folded() == 0 || !now.is_best ? Step::end : Step::cut;
    if (now.reached)
        return Step::end;
    const auto distance = [&](std::size_t ago) {
        return rounds[rounds.size() - 1 - ago].distance.lower;
    };
    if (target.points == nullptr && near_miss(trial, target.tolerance) &&
        now.repeats < most_repeats && (now.repeats == 0 || distance(0) < distance(1)))
        return Step::repeat;
    if (!stalled(rounds, now.first, now.tangent ? tangent_patience : patience))
        return Step::cut;
    return now.tangent ? Step::change_rows : Step::stall;
}

} // namespace

const char* name(RefinementEnd end)
{
    switch (end) {
    case RefinementEnd::tolerance_met: return "tolerance_met";
    case RefinementEnd::patch_limit: return "patch_limit";
    case RefinementEnd::noise_limit: return "noise_limit";
    case RefinementEnd::stalled: return "stalled";
    case RefinementEnd::quality_limit: return "quality_limit";
    }
    return "";
}

ToleranceOptions::ToleranceOptions()
{
    fit.stall = 0.02;
    samples.max_vertices = 288;
}

std::optional<Error> ToleranceOptions::check() const
{
    const auto bad = [](const char* message) {
        return Error{ErrorCode::bad_option, message, invalid_index};
    };
    if (!(tolerance > 0.0) || !std::isfinite(tolerance))
        return bad("the tolerance must be a positive number");
    if (max_patches == 0)
        return bad("at least one patch must be allowed");
    if (auto error = fit.check())
        return error;
    return samples.check();
}

Result<ToleranceFit> refine_to_tolerance(const ManifoldMesh& source, QuadDomain start,
                                         const ToleranceOptions& options, const PointData* points,
                                         Context& context, TrialPointer tried)
{
    if (const auto error = options.check())
        return *error;
    FitTarget target(source, points, options.tolerance);
    ToleranceOptions current = options;
    ToleranceFit result;
    Trial best;
    QuadDomain domain = std::move(start);
    Progress progress;
    const auto next_trial = [&]() -> Result<Trial> {
        if (!tried)
            return make_trial(target, std::move(domain), current, context);
        Trial first_trial = std::move(*tried);
        tried.reset();
        assert(first_trial.patches.size() == domain.complex.quad_count());
        first_trial.domain = std::move(domain);
        return Result<Trial>(std::move(first_trial));
    };
    for (std::optional<RefinementEnd> end; !end;) {
        const double begin = now();
        Result<Trial> made = next_trial();
        if (!made && made.error().code == ErrorCode::layout_failed && !result.rounds.empty()) {
            result.termination = RefinementEnd::quality_limit;
            break;
        }
        if (!made)
            return made.error();
        Trial& trial = *made;
        if (!trial.proven)
            if (Status failed = prove_trial(target, trial, context))
                return *failed;
        result.rounds.push_back(describe(trial, now() - begin));
        progress.reached = result.rounds.size() > 1 && result.rounds[result.best].beyond == 0;
        progress.is_best = better(result.rounds, result.best);
        progress.tangent = current.fit.rows == DistanceRows::tangent;
        if (progress.is_best)
            result.best = static_cast<Index>(result.rounds.size() - 1);

        const Step step = next_step(result.rounds, target, trial, progress);
        progress.repeats = step == Step::repeat ? progress.repeats + 1 : 0;
        if (step == Step::end) {
            end = RefinementEnd::tolerance_met;
        } else if (step == Step::stall) {
            end = RefinementEnd::stalled;
        } else if (step == Step::repeat) {
            add_worst(trial.bound, options.tolerance, target.hard_places);
            domain = trial.domain;
        } else if (step == Step::change_rows) {
            current.fit.rows = DistanceRows::point;
            progress.first = result.rounds.size();
            domain = progress.is_best ? trial.domain : best.domain;
        } else {
            Result<std::optional<RefinementEnd>> failed =
                cut(source, trial, options, domain, context);
            if (!failed)
                return failed.error();
            end = *failed;
        }
        if (progress.is_best)
            best = std::move(trial);
        if (end)
            result.termination = *end;
    }
    // Whatever ended it: an earlier round may have been within.
    if (best.within)
        result.termination = RefinementEnd::tolerance_met;
    else if (points != nullptr && best.beyond() == 0)
        result.termination = RefinementEnd::noise_limit;
    result.domain = std::move(best.domain);
    result.fit = std::move(best.fit);
    result.bound = std::move(best.bound);
    result.anchors = best.anchors;
    return result;
}

} // namespace bot2nurbs
