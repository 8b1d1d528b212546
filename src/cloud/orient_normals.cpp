// SPDX-License-Identifier: MIT
#include "bot2nurbs/orient_normals.h"

#include "cloud/even_subset.h"
#include "cloud/plane_fit.h"
#include "cloud/point_tree.h"
#include "cloud/winding_orientation.h"
#include "core/parallel.h"

#include <algorithm>
#include <cmath>

namespace bot2nurbs {

namespace {

//! Cosine of the angle beyond which the direction of the winding number replaces the normal of the
//! plane: 30 degrees. Noise tilts planes by ten degrees, edges by more.
constexpr double plane_cosine = 0.8660254037844386;
//! Sine of the angle to the tangent plane below which a line of sight does not say the side.
constexpr double grazing = 0.17;
//! Neighbours that decide a side by their majority.
constexpr std::size_t voters = 12;
//! Of a subset, the nearest points that a point follows.
constexpr std::size_t leaders = 4;
//! Neighbours lie beside each other where their line is this close to the tangent planes (sine).
constexpr double beside = 0.3;
//! A cloud whose deviation from one plane is this share of its spacing has no inside.
constexpr double sheet_spacings = 0.5;
//! Cosine of the angle from which two normals contradict each other.
constexpr double opposed = -0.5;
constexpr std::size_t points_per_chunk = 256;

//! The subset's directions carried to all points: near ones count more, and those in the plane of
//! the point more than those across from it.
std::vector<Vec3> followed_directions(const std::vector<Vec3>& points,
                                      const std::vector<Vec3>& normals, const PointTree& tree,
                                      const std::vector<Vec3>& subset,
                                      const std::vector<Vec3>& directions, const Context& context)
{
    std::vector<Vec3> followed(points.size());
    for_each_chunk(
        context, points.size(), points_per_chunk, [&](std::size_t begin, std::size_t end) {
            std::vector<PointTree::Neighbor> found;
            for (std::size_t i = begin; i < end; ++i) {
                tree.nearest(points[i], leaders, found);
                if (found.front().distance2 == 0.0) {
                    followed[i] = directions[found.front().point];
                    continue;
                }
                Vec3 sum;
                for (const PointTree::Neighbor& n : found) {
                    const double across = std::abs(dot(subset[n.point] - points[i], normals[i])) /
                                          std::sqrt(n.distance2);
                    sum += (1.0 - across) / n.distance2 * directions[n.point];
                }
                followed[i] = sum;
            }
        });
    return followed;
}

//! Outward directions at all points; only their side counts where `exact` is false.
struct Directions {
    std::vector<Vec3> at_points;
    bool exact = true;
    Index solved = 0;
};

Result<Directions> find_directions(const std::vector<Vec3>& points, const SurfaceEstimate& estimate,
                                   Index most_points, Context& context)
{
    // Outliers get a direction, but none from them.
    std::vector<double> spacing = estimate.spacing;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (estimate.outlier[i])
            spacing[i] = 0.0;
    Directions result;
    if (points.size() <= most_points) {
        Result<std::vector<Vec3>> all =
            winding_directions(points, spacing, estimate.noise, context);
        if (!all)
            return all.error();
        result.at_points = std::move(*all);
        result.solved = static_cast<Index>(points.size());
        return result;
    }
    const std::vector<Index> chosen = even_subset(points, most_points);
    const double growth =
        std::sqrt(static_cast<double>(points.size()) / static_cast<double>(chosen.size()));
    std::vector<Vec3> subset;
    std::vector<double> subset_spacing;
    for (const Index i : chosen) {
        subset.push_back(points[i]);
        subset_spacing.push_back(growth * spacing[i]);
    }
    const Result<std::vector<Vec3>> directions =
        winding_directions(subset, subset_spacing, estimate.noise, context);
    if (!directions)
        return directions.error();
    const Result<PointTree> tree = PointTree::build(subset, context);
    if (!tree)
        return tree.error();
    result.at_points =
        followed_directions(points, estimate.normals, *tree, subset, *directions, context);
    result.exact = false;
    result.solved = static_cast<Index>(subset.size());
    return result;
}

//! Turns normals towards the viewpoint; those seen edge-on follow most of their neighbours.
Status turn_to_viewpoint(const std::vector<Vec3>& points, const Vec3& viewpoint,
                         std::vector<Vec3>& normals, Context& context)
{
    const Result<PointTree> tree = PointTree::build(points, context);
    if (!tree)
        return tree.error();
    const auto sight = [&](std::size_t i) {
        return dot(normals[i], normalized(viewpoint - points[i]));
    };
    for (std::size_t i = 0; i < points.size(); ++i)
        if (sight(i) < 0.0)
            normals[i] = -normals[i];
    std::vector<Vec3> turned = normals;
    for_each_chunk(context, points.size(), points_per_chunk,
                   [&](std::size_t begin, std::size_t end) {
                       std::vector<PointTree::Neighbor> found;
                       for (std::size_t i = begin; i < end; ++i) {
                           if (sight(i) > grazing)
                               continue;
                           tree->nearest(points[i], voters + 1, found);
                           double vote = 0.0;
                           for (const PointTree::Neighbor& n : found)
                               if (sight(n.point) > grazing)
                                   vote += dot(normals[n.point], normals[i]);
                           if (vote < 0.0)
                               turned[i] = -normals[i];
                       }
                   });
    normals = std::move(turned);
    return std::nullopt;
}

//! The normal of the plane that all points lie in, up to what their spacing and noise explain; zero
//! if there is none.
Vec3 sheet_normal(const std::vector<Vec3>& points, const SurfaceEstimate& estimate)
{
    std::vector<PointTree::Neighbor> inliers;
    for (Index i = 0; i < points.size(); ++i)
        if (!estimate.outlier[i])
            inliers.push_back({i, 0.0});
    if (inliers.empty())
        return {};
    const PlaneFit plane = fit_plane(points, inliers.data(), inliers.size());
    const double thickness = std::max(sheet_spacings * estimate.median_spacing, estimate.noise);
    return std::sqrt(plane.variances[0]) <= thickness ? plane.axes[0] : Vec3{};
}

} // namespace

std::optional<Error> OrientOptions::check() const
{
    if (viewpoint && !is_finite(*viewpoint))
        return Error{ErrorCode::bad_option, "the viewpoint is not finite", invalid_index};
    if (most_points < 1000)
        return Error{ErrorCode::bad_option, "most_points must be at least 1000", invalid_index};
    return std::nullopt;
}

Result<OrientationSummary> orient_normals(const std::vector<Vec3>& points,
                                          SurfaceEstimate& estimate, const OrientOptions& options,
                                          Context& context)
{
    if (const auto bad = options.check())
        return *bad;
    OrientationSummary summary;
    std::vector<Vec3>& normals = estimate.normals;
    if (options.viewpoint) {
        if (const Status bad = turn_to_viewpoint(points, *options.viewpoint, normals, context))
            return *bad;
    } else if (const Vec3 up = sheet_normal(points, estimate); up != Vec3{}) {
        for (Vec3& n : normals)
            if (dot(n, up) < 0.0)
                n = -n;
    } else {
        const Result<Directions> directions =
            find_directions(points, estimate, options.most_points, context);
        if (!directions)
            return directions.error();
        summary.solved_points = directions->solved;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Vec3& d = directions->at_points[i];
            const double along = dot(d, normals[i]);
            if (along < 0.0)
                normals[i] = -normals[i];
            if (directions->exact && std::abs(along) < plane_cosine && d != Vec3{})
                normals[i] = d;
        }
    }
    const Result<std::vector<char>> contradicted = contradicted_normals(points, normals, context);
    if (!contradicted)
        return contradicted.error();
    summary.disagreement =
        static_cast<double>(std::count(contradicted->begin(), contradicted->end(), 1)) /
        static_cast<double>(points.size());
    return summary;
}

Result<std::vector<char>> contradicted_normals(const std::vector<Vec3>& points,
                                               const std::vector<Vec3>& normals, Context& context)
{
    const Result<PointTree> tree = PointTree::build(points, context);
    if (!tree)
        return tree.error();
    std::vector<char> contradicted(points.size(), 0);
    if (!for_each_chunk(
            context, points.size(), points_per_chunk, [&](std::size_t begin, std::size_t end) {
                std::vector<PointTree::Neighbor> found;
                for (std::size_t place = begin; place < end; ++place) {
                    const std::size_t i = tree->order()[place];
                    const Vec3 n = normalized(normals[i]);
                    tree->nearest(points[i], voters + 1, found);
                    int against = 0, all = 0;
                    for (const PointTree::Neighbor& f : found) {
                        const Vec3 m = normalized(normals[f.point]);
                        const Vec3 line = normalized(points[f.point] - points[i]);
                        if (n == Vec3{} || m == Vec3{} || line == Vec3{} ||
                            std::abs(dot(line, n)) > beside || std::abs(dot(line, m)) > beside)
                            continue;
                        ++all;
                        against += dot(n, m) < opposed;
                    }
                    contradicted[i] = 2 * against > all;
                }
            }))
        return Context::cancelled_error("orientation");
    return contradicted;
}

} // namespace bot2nurbs
