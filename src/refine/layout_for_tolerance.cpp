// SPDX-License-Identifier: MIT
#include "refine/trial.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace bot2nurbs {

namespace {

// Where the search starts: a few more than the six of a cube, as no limb gets a patch of its own
// below that.
constexpr Index first_patches = 24;
// Share of the patches that should be within the tolerance before any is cut. With fewer, closing
// the marks would cut nearly all patches; with all of them, the worst patch would set the size of
// every other.
constexpr double wanted_share = 0.9;
// The distance of bicubic patches falls with the power 2 of their number where the source is
// smooth, with less where it is not: the measured 1.5 of real models.
constexpr double patches_power = 1.0 / 1.5;
// Growth from one layout to the next: least, so that few layouts are tried, and most, as the
// prediction is rough.
constexpr double least_growth = 1.4, most_growth = 4.0;

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

Result<LayoutResult> layout_for_tolerance(const ManifoldMesh& source, LayoutOptions layout,
                                          const ToleranceOptions& options, const PointData* points,
                                          Context& context)
{
    if (const auto error = options.check())
        return *error;
    const FitTarget target(source, points, options.tolerance);
    std::optional<LayoutResult> best;
    double best_ratio = std::numeric_limits<double>::infinity();
    for (double patches = first_patches;;) {
        layout.patches = static_cast<Index>(patches);
        Result<LayoutResult> made = build_layout(source, layout, context);
        if (!made)
            return made;
        if (best && made->domain.complex.quad_count() > options.max_patches)
            return std::move(*best);
        const Result<Trial> trial = make_trial(target, made->domain, options, context);
        if (!trial)
            return trial.error();
        const double ratio = distance_of_share(*trial, wanted_share) / target.limit;
        if (ratio <= 1.0)
            return made;
        // More patches gain nothing: most of them have details, or facets, of the source to reach.
        if (ratio >= best_ratio)
            return std::move(*best);
        best_ratio = ratio;
        patches *= std::clamp(std::pow(ratio, patches_power), least_growth, most_growth);
        best = std::move(*made);
    }
}

} // namespace bot2nurbs
