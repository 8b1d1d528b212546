// SPDX-License-Identifier: MIT
#include "cloud/local_scale.h"

#include "cloud/plane_fit.h"
#include "core/parallel.h"

#include <algorithm>
#include <cmath>

namespace bot2nurbs {

namespace {

constexpr double pi = 3.14159265358979323846;
//! Points where noise is measured: their median is known to about one percent.
constexpr std::size_t noise_places = 4000;
//! Neighbourhoods that are tried, smallest first.
constexpr std::size_t noise_neighbors[] = {12, 16, 24, 32, 48, 64, 96, 128, 192, 256};
//! A neighbourhood shows noise if it is at most this share of its radius. In a smaller one the
//! points fill a ball, of whose radius they would always show a third.
constexpr double noise_share = 0.25;
//! With a ratio like this nobody asks for a better one.
constexpr double clear_ratio = 0.1;
//! Neighbourhoods are at most one in so many of all points: larger ones are the whole body.
constexpr std::size_t most_share = 8;
//! An outlier is this many times farther from its neighbours than they are from theirs: densities
//! of scans change by less over one neighbourhood. Or it is this many deviations away from a plane
//! that its neighbours show, and this many times their spacing: tips of corners are nearer.
constexpr double outlier_ratio = 2.5;
//! Or its whole neighbourhood is sparse, by this against the cloud, and fills a ball: its least
//! extent is at least this share of its largest.
constexpr double sparse_ratio = 6.0;
constexpr double ball_share = 0.3;
constexpr double outlier_deviations = 4.0;
constexpr double outlier_spacings = 1.5;
constexpr std::size_t points_per_chunk = 256;

//! The median over some points of the residual, and of the radius, of k neighbours.
struct NoiseAtScale {
    double residual = 0.0, radius = 0.0;
};

NoiseAtScale noise_at(const std::vector<Vec3>& points, const PointTree& tree, std::size_t k,
                      const Context& context)
{
    const std::size_t places = std::min(points.size(), noise_places);
    std::vector<double> residual(places), radius(places);
    for_each_chunk(context, places, points_per_chunk / 8, [&](std::size_t begin, std::size_t end) {
        std::vector<PointTree::Neighbor> found;
        for (std::size_t i = begin; i < end; ++i) {
            tree.nearest(points[i * points.size() / places], k, found);
            const PlaneFit plane = fit_plane(points, found.data(), found.size());
            residual[i] = quadric_residual(points, found.data(), found.size(), plane);
            radius[i] = std::sqrt(found.back().distance2);
        }
    });
    return {median_of(std::move(residual)), median_of(std::move(radius))};
}

struct Noise {
    double deviation = 0.0, ratio = 0.0;
};

Noise measure_noise(const std::vector<Vec3>& points, const PointTree& tree, const Context& context)
{
    NoiseAtScale best;
    Noise noise;
    bool shown = false;
    for (const std::size_t k : noise_neighbors) {
        if (k > std::max(points.size() / most_share, noise_neighbors[0]) || k > points.size())
            break;
        const NoiseAtScale here = noise_at(points, tree, k, context);
        const double ratio = here.radius > 0.0 ? here.residual / here.radius : 0.0;
        if (k == noise_neighbors[0] || ratio < noise.ratio) {
            best = here;
            noise.ratio = ratio;
        }
        if (!shown)
            noise.deviation = best.residual;
        shown = shown || ratio <= noise_share;
        if (noise.ratio <= clear_ratio)
            break;
    }
    return noise;
}

} // namespace

double median_of(std::vector<double> values)
{
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

Result<LocalScale> measure_scale(const std::vector<Vec3>& points, const PointTree& tree,
                                 const NeighborGraph& graph, Context& context)
{
    const std::size_t n = points.size();
    LocalScale scale;
    scale.spacing.resize(n);
    scale.density.resize(n);
    scale.outlier.assign(n, 0);
    std::vector<double> own(n);
    // k neighbours and the point itself less the one on the rim share the disk.
    for (std::size_t i = 0; i < n; ++i)
        own[i] = graph.radius(i) * std::sqrt(pi / static_cast<double>(graph.k));
    const Noise noise = measure_noise(points, tree, context);
    scale.noise = noise.deviation;
    scale.noise_ratio = noise.ratio;
    const double typical = median_of(own);
    const bool completed =
        for_each_chunk(context, n, points_per_chunk, [&](std::size_t begin, std::size_t end) {
            std::vector<double> around(graph.k);
            for (std::size_t i = begin; i < end; ++i) {
                for (std::size_t k = 0; k < graph.k; ++k)
                    around[k] = own[graph.of(i)[k].point];
                const double usual = median_of(around);
                scale.spacing[i] = usual;
                scale.density[i] = own[i] > usual ? usual / own[i] : 1.0;
                const PlaneFit plane = fit_plane(points, graph.of(i), graph.k);
                const double distance = std::abs(dot(points[i] - plane.centroid, plane.axes[0]));
                const double deviation = std::max(scale.noise, std::sqrt(plane.variances[0]));
                const bool ball = plane.variances[0] > ball_share * ball_share * plane.variances[2];
                scale.outlier[i] = own[i] > outlier_ratio * usual ||
                                   (own[i] > sparse_ratio * typical && ball) ||
                                   (distance > outlier_deviations * deviation &&
                                    distance > outlier_spacings * usual);
            }
        });
    if (!completed || context.cancelled())
        return Context::cancelled_error("scale of the cloud");
    scale.median_spacing = median_of(scale.spacing);
    return scale;
}

} // namespace bot2nurbs
