// SPDX-License-Identifier: MIT
#include "refine/layout_search.h"
#include "refine/trial.h"

#include <algorithm>
#include <utility>

namespace bot2nurbs {

namespace {

// The distance that a share of the patches are within.
double distance_of_share(const Trial& trial, double share)
{
    std::vector<double> distances;
    for (const PatchError& p : trial.patches)
        distances.push_back(p.distance);
    const std::size_t k =
        std::min(distances.size() - 1, static_cast<std::size_t>(share * double(distances.size())));
    std::nth_element(distances.begin(), distances.begin() + static_cast<std::ptrdiff_t>(k),
                     distances.end());
    return distances[k];
}

} // namespace

Result<TriedLayout> layout_for_tolerance(const ManifoldMesh& source, LayoutOptions layout,
                                         const ToleranceOptions& options, const PointData* points,
                                         Context& context)
{
    if (const auto error = options.check())
        return *error;
    const FitTarget target(source, points, options.tolerance);
    std::optional<TriedLayout> best;
    // One that cannot be made, or fitted, is no loss where there is another.
    const auto without = [&best](const Error& error) -> Result<TriedLayout> {
        if (best && error.code == ErrorCode::layout_failed)
            return std::move(*best);
        return error;
    };
    for (LayoutSearch search(options.max_patches);;) {
        layout.patches = search.patches();
        Result<LayoutResult> made = build_layout(source, layout, context);
        if (!made)
            return without(made.error());
        const Index count = made->domain.complex.quad_count();
        if (count > options.max_patches)
            return best ? std::move(*best) : TriedLayout{std::move(*made), nullptr};
        Result<Trial> made_trial = make_trial(target, std::move(made->domain), options, context);
        if (!made_trial)
            return without(made_trial.error());
        TriedLayout tried{std::move(*made), TrialPointer(new Trial(std::move(*made_trial)))};
        Trial& trial = *tried.trial;
        const double ratio = distance_of_share(trial, LayoutSearch::wanted_share) / target.limit;
        // Samples do not see what bulges between them.
        if (ratio <= 1.0)
            if (Status failed = prove_trial(target, trial, context))
                return *failed;
        tried.layout.domain = std::move(trial.domain);
        if (trial.to_cut() == 0)
            return Result<TriedLayout>(std::move(tried));
        const auto verdict = search.look_at(count, trial.to_cut(), ratio);
        if (verdict.best || !best)
            best = std::move(tried);
        if (verdict.done)
            return std::move(*best);
    }
}

} // namespace bot2nurbs
