// SPDX-License-Identifier: MIT
#include "bot2nurbs/find_normals.h"

#include "cloud/point_tree.h"
#include "core/parallel.h"

#include <algorithm>

namespace bot2nurbs {

namespace {

//! Share of the file's normals that may contradict their neighbours: noise and thin sheets make
//! some tenths of a percent, sides that were chosen at random a half.
constexpr double most_contradicted = 0.02;
//! Share of points that may lack a normal.
constexpr double most_missing = 0.5;
//! Nearest given normals that say the side of a missing one.
constexpr std::size_t voters = 12;
constexpr std::size_t points_per_chunk = 256;

double share_of(std::size_t part, std::size_t all)
{
    return static_cast<double>(part) / static_cast<double>(all);
}

//! The file's normals in place of the estimated ones. Where one is missing the estimated one stays,
//! turned to the side of the given ones around it. \return how many were missing
Result<Index> take_given(const CleanPoints& points, SurfaceEstimate& estimate, Context& context)
{
    std::vector<Vec3> places, given;
    for (std::size_t i = 0; i < points.positions.size(); ++i)
        if (points.normals[i] != Vec3{}) {
            places.push_back(points.positions[i]);
            given.push_back(points.normals[i]);
        }
    const Result<PointTree> tree = PointTree::build(places, context);
    if (!tree)
        return tree.error();
    if (!for_each_chunk(context, points.positions.size(), points_per_chunk,
                        [&](std::size_t begin, std::size_t end) {
                            std::vector<PointTree::Neighbor> found;
                            for (std::size_t i = begin; i < end; ++i) {
                                Vec3& normal = estimate.normals[i];
                                if (points.normals[i] != Vec3{}) {
                                    normal = points.normals[i];
                                    continue;
                                }
                                tree->nearest(points.positions[i], voters, found);
                                double side = 0.0;
                                for (const PointTree::Neighbor& n : found)
                                    side += dot(given[n.point], normal);
                                if (side < 0.0)
                                    normal = -normal;
                            }
                        }))
        return Context::cancelled_error("normals");
    return static_cast<Index>(points.positions.size() - places.size());
}

} // namespace

Result<CloudNormals> find_normals(const CleanPoints& points, NormalMode mode,
                                  const OrientOptions& options, Context& context)
{
    if (const auto bad = options.check())
        return *bad;
    const std::size_t n = points.positions.size();
    const bool has_normals = !points.normals.empty();
    const double missing = has_normals ? share_of(points.without_normal, n) : 1.0;
    if (mode == NormalMode::given && missing > most_missing)
        return Error{ErrorCode::bad_geometry,
                     std::to_string(has_normals ? points.without_normal : n) + " of " +
                         std::to_string(n) +
                         " points have no normal, or a zero one: leave out --normals given to have "
                         "normals estimated",
                     invalid_index};
    Result<SurfaceEstimate> estimate = estimate_normals(points.positions, context);
    if (!estimate)
        return estimate.error();
    CloudNormals result;
    NormalReport& report = result.report;
    report.file_has_normals = has_normals;
    if (has_normals) {
        const Result<std::vector<char>> contradicted =
            contradicted_normals(points.positions, points.normals, context);
        if (!contradicted)
            return contradicted.error();
        report.given_contradicted = share_of(
            static_cast<std::size_t>(std::count(contradicted->begin(), contradicted->end(), 1)), n);
    }
    report.given =
        mode == NormalMode::given || (mode == NormalMode::automatic && missing <= most_missing &&
                                      report.given_contradicted <= most_contradicted);
    if (report.given) {
        const Result<Index> filled = take_given(points, *estimate, context);
        if (!filled)
            return filled.error();
        report.filled_in = *filled;
        report.disagreement = report.given_contradicted;
    } else {
        const Result<OrientationSummary> oriented =
            orient_normals(points.positions, *estimate, options, context);
        if (!oriented)
            return oriented.error();
        report.solved_points = oriented->solved_points;
        report.disagreement = oriented->disagreement;
        std::size_t flipped = 0;
        for (std::size_t i = 0; has_normals && i < n; ++i)
            flipped += dot(points.normals[i], estimate->normals[i]) < 0.0;
        report.given_flipped = has_normals ? share_of(flipped, n) : 0.0;
    }
    for (std::size_t i = 0; i < points.confidence.size(); ++i)
        estimate->confidence[i] *= points.confidence[i];
    result.estimate = std::move(*estimate);
    return result;
}

} // namespace bot2nurbs
