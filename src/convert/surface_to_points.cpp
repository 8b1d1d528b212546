// SPDX-License-Identifier: MIT
#include "convert/surface_to_points.h"

#include "cloud/point_tree.h"
#include "core/parallel.h"

#include <algorithm>
#include <cmath>

namespace bot2nurbs {

namespace {

//! Places of a patch per direction, at cell midpoints.
constexpr Index side = 12;
constexpr std::size_t patches_per_chunk = 4;

} // namespace

Result<SurfaceToPoints> measure_surface_to_points(const std::vector<const SplineSurface*>& surfaces,
                                                  const std::vector<Vec3>& points, double reach,
                                                  Context& context)
{
    const Result<PointTree> tree = PointTree::build(points, context);
    if (!tree)
        return tree.error();
    SurfaceToPoints result;
    result.reach = reach;
    double sum = 0.0;
    for (const SplineSurface* surface : surfaces) {
        std::vector<double> distances(std::size_t{side} * side * surface->patch_count());
        const auto measure = [&](std::size_t begin, std::size_t end) {
            for (std::size_t q = begin; q < end; ++q)
                for (Index k = 0; k < side * side; ++k) {
                    const double u = (k % side + 0.5) / side, v = (double(k / side) + 0.5) / side;
                    const Vec3 p = surface->position({static_cast<Index>(q), u, v});
                    distances[q * side * side + k] = std::sqrt(tree->nearest(p).distance2);
                }
        };
        if (!for_each_chunk(context, surface->patch_count(), patches_per_chunk, measure))
            return Context::cancelled_error("deviation");
        for (const double d : distances) {
            ++result.samples;
            if (d > reach)
                continue;
            ++result.covered;
            result.max = std::max(result.max, d);
            sum += d * d;
        }
    }
    if (result.covered > 0)
        result.rms = std::sqrt(sum / result.covered);
    return result;
}

} // namespace bot2nurbs
