// SPDX-License-Identifier: MIT
#include "bot2nurbs/point_deviation.h"

#include "core/parallel.h"
#include "fit/surface_locator.h"

#include <algorithm>
#include <cmath>

namespace bot2nurbs {

namespace {

//! Cells per Bezier piece that seed the search for a foot on the surface.
constexpr Index seed_cells = 2;
constexpr std::size_t points_per_chunk = 128;
//! Standard deviation of normal errors over their median absolute value.
constexpr double median_to_deviation = 1.4826;
constexpr double far_deviations = 3.0;

} // namespace

Result<std::vector<PointFoot>> find_point_feet(const std::vector<Vec3>& points,
                                               const QuadComplex& complex,
                                               const SplineSurface& surface, Context& context)
{
    if (surface.patch_count() == 0)
        return Error{ErrorCode::empty_input, "no surface to measure from", invalid_index};
    const SurfaceLocator locator(complex, surface, seed_cells, &context);
    std::vector<PointFoot> feet(points.size());
    const auto find = [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const FootPoint foot = locator.closest(points[i]);
            feet[i] = {foot.where, foot.distance};
        }
    };
    if (context.cancelled() || !for_each_chunk(context, points.size(), points_per_chunk, find))
        return Context::cancelled_error("deviation");
    return feet;
}

PointDeviation summarise_distances(const std::vector<double>& distances, double least_deviation)
{
    PointDeviation d;
    d.points = static_cast<Index>(distances.size());
    if (distances.empty())
        return d;
    const std::size_t n = distances.size();
    std::vector<double> sorted = distances;
    std::sort(sorted.begin(), sorted.end());
    d.max = sorted.back();
    d.median = sorted[n / 2];
    d.percentile_95 =
        sorted[std::min(n - 1, static_cast<std::size_t>(std::ceil(0.95 * double(n))))];
    d.worst = static_cast<Index>(std::max_element(distances.begin(), distances.end()) -
                                 distances.begin());
    double sum = 0.0;
    for (const double x : distances)
        sum += x * x;
    d.rms = std::sqrt(sum / double(n));
    const double limit = far_deviations * std::max(median_to_deviation * d.median, least_deviation);
    d.far_points =
        static_cast<Index>(sorted.end() - std::upper_bound(sorted.begin(), sorted.end(), limit));
    return d;
}

double share_within(const std::vector<double>& distances, double limit)
{
    if (distances.empty())
        return 1.0;
    const auto count =
        std::count_if(distances.begin(), distances.end(), [limit](double d) { return d <= limit; });
    return double(count) / double(distances.size());
}

} // namespace bot2nurbs
