// SPDX-License-Identifier: MIT
#include "fit/parameter_correction.h"

#include "core/parallel.h"
#include "fit/surface_locator.h"

#include <algorithm>

namespace bot2nurbs {

namespace {

constexpr std::size_t chunk_points = 64;
//! A distance of more than this many medians is suspicious: for normal errors one in five thousand
//! is, so that the search from scratch costs little unless something is wrong.
constexpr double suspicious_medians = 5.0;
//! Cells per Bezier piece of the tessellation that seeds the search from scratch: only the basin of
//! the right foot has to be found.
constexpr Index seed_cells = 1;

} // namespace

double median(std::vector<double> values)
{
    if (values.empty())
        return 0.0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

std::vector<FootPoint> correct_parameters(const QuadComplex& complex, const SplineSurface& surface,
                                          const std::vector<Vec3>& points,
                                          const std::vector<DomainPoint>& where,
                                          const std::vector<char>& on_curve, const Context& context)
{
    const SurfaceWalk walk(complex, surface);
    const auto is_of_curve = [&](std::size_t i) { return !on_curve.empty() && on_curve[i]; };
    std::vector<FootPoint> feet(points.size());
    if (!for_each_chunk(
            context, points.size(), chunk_points, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i)
                    feet[i] = is_of_curve(i) ? walk.descend_along_curve(points[i], where[i])
                                             : walk.descend(points[i], where[i]);
            }))
        return {};
    std::vector<double> distances(feet.size());
    for (std::size_t i = 0; i < feet.size(); ++i)
        distances[i] = feet[i].distance;
    const double limit = suspicious_medians * median(distances);
    std::vector<std::size_t> suspicious;
    for (std::size_t i = 0; i < feet.size(); ++i)
        if (distances[i] > limit && !is_of_curve(i))
            suspicious.push_back(i);
    if (suspicious.empty())
        return feet;
    const SurfaceLocator locator(complex, surface, seed_cells);
    if (!for_each_chunk(
            context, suspicious.size(), chunk_points, [&](std::size_t begin, std::size_t end) {
                for (std::size_t s = begin; s < end; ++s) {
                    FootPoint& foot = feet[suspicious[s]];
                    const auto other = locator.closest_within(points[suspicious[s]], foot.distance);
                    if (other && other->distance < foot.distance)
                        foot = *other;
                }
            }))
        return {};
    return feet;
}

} // namespace bot2nurbs
