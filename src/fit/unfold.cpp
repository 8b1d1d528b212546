// SPDX-License-Identifier: MIT
#include "fit/fit_loop.h"
#include "fit/fold_easing.h"
#include "fit/local_system.h"

#include <algorithm>
#include <numeric>

namespace bot2nurbs {

namespace {

//! What is not unfolded after so many passes is left as it is. Most quads take three to six.
constexpr int most_passes = 30;
//! Times the move of a region is halved before it is left out.
constexpr int halvings = 3;
//! With emphasis, samples may be so many times its distance away: so far is the tolerance of a
//! refinement.
constexpr double most_emphases = 2.0;

using Regions = std::vector<FoldEasing::Region>;

Index folds_of(const FoldEasing::Region& region, const std::vector<Index>& folds)
{
    return std::accumulate(region.core.begin(), region.core.end(), Index{0},
                           [&](Index sum, Index q) { return sum + folds[q]; });
}

//! Whether the move of a region makes nothing near it fold more, and less of itself if it is to.
bool helps(const FoldEasing::Region& region, const std::vector<Index>& before,
           const std::vector<Index>& after)
{
    return std::none_of(region.near.begin(), region.near.end(),
                        [&](Index q) { return after[q] > before[q]; }) &&
           (region.back || folds_of(region, after) < folds_of(region, before));
}

} // namespace

std::vector<double> FitLoop::largest_distances(const State& state) const
{
    std::vector<double> largest(network_.complex.quad_count(), 0.0);
    for (const FootPoint& foot : state.feet)
        largest[foot.where.quad] = std::max(largest[foot.where.quad], foot.distance);
    return largest;
}

FitLoop::State FitLoop::moved_in_regions(const State& state, Regions& regions,
                                         std::vector<Vec3>& move) const
{
    State next = moved(state, move);
    for (int cut = 0; cut <= halvings; ++cut) {
        bool changed = false;
        for (FoldEasing::Region& region : regions) {
            if (region.out || helps(region, state.folds, next.folds))
                continue;
            changed = true;
            region.out = cut == halvings;
            response_.shorten(region.quads, region.out ? 0.0 : 0.5, move);
        }
        if (!changed)
            break;
        next = moved(state, move);
    }
    return next;
}

Result<FitLoop::State> FitLoop::eased(const State& state, const LocalSystem& local,
                                      Regions& regions, const std::vector<double>& most) const
{
    const std::vector<FitRow> rows = rows_at(state, distance_factors(state, 1.0));
    const RowsByPiece groups = group_by_piece(rows, reduced_.piece_count());
    RoundProblem problem;
    problem.rows = &rows;
    problem.groups = &groups;
    problem.bezier = &state.surface.bezier();
    problem.fairness = &fairness_;
    std::vector<Vec3> move(reduced_.free_count(), Vec3{});
    for (FoldEasing::Region& region : regions)
        region.out = !local.solve(problem, region.quads, move);

    State next = moved_in_regions(state, regions, move);
    if (const auto error = find_feet(next))
        return *error;
    const std::vector<double> before = largest_distances(state), after = largest_distances(next);
    bool changed = false;
    for (FoldEasing::Region& region : regions) {
        double was = 0.0, is = 0.0;
        for (const Index q : region.near) {
            was = std::max({was, before[q], most[q]});
            is = std::max(is, after[q]);
        }
        if (region.out || is <= was)
            continue;
        region.out = changed = true;
        response_.shorten(region.quads, 0.0, move);
    }
    if (changed)
        next = moved(state, move);
    // Regions overlap: without one of them, another may fold after all.
    if (!more_folded(state.folds, next.folds).empty()) {
        for (FoldEasing::Region& region : regions)
            region.out = true;
        return state;
    }
    if (changed)
        if (const auto error = find_feet(next))
            return *error;
    return Result<State>(std::move(next));
}

Status FitLoop::unfold(State& state, double start)
{
    const auto folded = [&state] {
        return std::any_of(state.folds.begin(), state.folds.end(), [](Index n) { return n > 0; });
    };
    if (!folded())
        return std::nullopt;
    const std::vector<double> level = level_;
    std::vector<double> most = largest_distances(state);
    const double anywhere =
        emphasis > 0.0 ? most_emphases * emphasis : *std::max_element(most.begin(), most.end());
    for (double& m : most)
        m = std::max(m, anywhere);
    const LocalSystem local(reduced_);
    FoldEasing easing(response_, level.size());
    for (int pass = 0; pass < most_passes; ++pass) {
        Regions regions = easing.next(state.folds);
        if (regions.empty())
            break;
        level_ = easing.raised();
        for (std::size_t q = 0; q < level.size(); ++q)
            level_[q] *= level[q];
        apply_fairness();
        Result<State> next = eased(state, local, regions, most);
        if (!next)
            return next.error();
        easing.learn(regions, next->folds);
        state = std::move(*next);
        take_feet(state);
    }
    level_ = level;
    apply_fairness();
    record(state, 1.0, start);
    return std::nullopt;
}

} // namespace bot2nurbs
