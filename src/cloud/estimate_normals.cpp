// SPDX-License-Identifier: MIT
#include "bot2nurbs/estimate_normals.h"

#include "cloud/local_scale.h"
#include "cloud/plane_fit.h"
#include "core/parallel.h"

#include <algorithm>
#include <cmath>

namespace bot2nurbs {

namespace {

//! Enough for a plane with some redundancy; more would round off edges.
constexpr std::size_t least_neighbors = 12;
//! In a neighbourhood of three standard deviations' radius the noise tilts the plane by less than
//! ten degrees; its points then number some dozens at least.
constexpr double radius_over_noise = 3.0;
//! Bounds the cost where the noise is many times the spacing.
constexpr std::size_t most_neighbors = 256;
//! A point this many deviations away from its plane gets no weight (Tukey's constant for 95 %
//! efficiency with normal errors).
constexpr double tukey = 4.685;
constexpr std::size_t points_per_chunk = 128;
constexpr std::size_t fewest_points = 4;

double tukey_weight(double distance, double deviation)
{
    const double u = distance / (tukey * deviation);
    return u < 1.0 ? (1.0 - u * u) * (1.0 - u * u) : 0.0;
}

//! Confidence but for the density.
double plane_confidence(const PlaneFit& plane, const Vec3& point, double noise)
{
    const double separation =
        plane.variances[1] > 0.0 ? 1.0 - plane.variances[0] / plane.variances[1] : 0.0;
    const double distance = std::abs(dot(point - plane.centroid, plane.axes[0]));
    const double deviation = std::max(noise, std::sqrt(plane.variances[0]));
    return separation * (deviation > 0.0 ? tukey_weight(distance, deviation) : 1.0);
}

} // namespace

Result<SurfaceEstimate> estimate_normals(const std::vector<Vec3>& points, Context& context)
{
    const std::size_t n = points.size();
    if (n < fewest_points)
        return Error{ErrorCode::bad_geometry,
                     std::to_string(n) + " points are too few to estimate normals: at least " +
                         std::to_string(fewest_points),
                     invalid_index};
    for (std::size_t i = 0; i < n; ++i)
        if (!is_finite(points[i]))
            return Error{ErrorCode::bad_geometry,
                         "point " + std::to_string(i) + " has a coordinate that is not finite",
                         static_cast<Index>(i)};
    const Result<PointTree> tree = PointTree::build(points, context);
    if (!tree)
        return tree.error();
    const Result<NeighborGraph> graph = find_neighbors(*tree, points, least_neighbors, context);
    if (!graph)
        return graph.error();
    Result<LocalScale> scale = measure_scale(points, *tree, *graph, context);
    if (!scale)
        return scale.error();

    SurfaceEstimate estimate;
    estimate.normals.resize(n);
    estimate.confidence.resize(n);
    const double radius = radius_over_noise * scale->noise;
    if (!for_each_chunk(context, n, points_per_chunk, [&](std::size_t begin, std::size_t end) {
            std::vector<PointTree::Neighbor> found;
            for (std::size_t place = begin; place < end; ++place) {
                const Index i = tree->order()[place];
                std::size_t count = least_neighbors + 1;
                found.assign(1, {i, 0.0});
                found.insert(found.end(), graph->of(i), graph->of(i) + graph->k);
                // Doubled until the radius is reached, then cut to it.
                while (found.back().distance2 < radius * radius && count < most_neighbors &&
                       found.size() == count) {
                    count = std::min(2 * count, most_neighbors);
                    tree->nearest(points[i], count, found);
                }
                while (found.size() > least_neighbors + 1 &&
                       found.back().distance2 > radius * radius)
                    found.pop_back();
                const PlaneFit plane = fit_plane(points, found.data(), found.size());
                estimate.normals[i] = plane.axes[0];
                estimate.confidence[i] =
                    scale->outlier[i]
                        ? 0.0

                        : scale->density[i] * plane_confidence(plane, points[i], scale->noise);
            }
        }))
        return Context::cancelled_error("normals");
    estimate.spacing = std::move(scale->spacing);
    estimate.outlier = std::move(scale->outlier);
    estimate.median_spacing = scale->median_spacing;
    estimate.noise = scale->noise;
    estimate.noise_ratio = scale->noise_ratio;
    return estimate;
}

} // namespace bot2nurbs
