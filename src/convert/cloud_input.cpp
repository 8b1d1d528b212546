// SPDX-License-Identifier: MIT
#include "convert/cloud_input.h"

#include "bot2nurbs/closest_point.h"
#include "bot2nurbs/read_points.h"
#include "core/parallel.h"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

namespace bot2nurbs {

namespace {

constexpr std::size_t points_per_chunk = 256;
constexpr double detail_spacings = 0.25;
//! A mesh through points passes within about a spacing of each, and the noise; a point farther than
//! this from it shows something that it leaves out. Among scattered points the spacing is large: it
//! counts up to a multiple of the median.
constexpr double reach_spacings = 1.5, reach_deviations = 4.0, most_medians = 3.0;
//! Beyond this from the nearest point a place of a surface is in a hole.
constexpr double hole_spacings = 2.2, hole_deviations = 3.0;

std::string place_text(const Vec3& p)
{
    return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x, p.y, p.z);
}

double diagonal_of(const std::vector<Vec3>& points)
{
    Box3 box;
    for (const Vec3& p : points)
        box.add(p);
    return box.diagonal();
}

//! The points that take part in the fit: no outliers, and none without weight.
void choose_points(const CleanPoints& clean, const SurfaceEstimate& estimate, CloudInput& cloud)
{
    for (std::size_t i = 0; i < clean.positions.size(); ++i) {
        cloud.report.outliers += estimate.outlier[i] != 0;
        const double weight = estimate.confidence[i] * estimate.spacing[i] * estimate.spacing[i];
        if (estimate.outlier[i] != 0 || !(weight > 0.0))
            continue;
        cloud.points.push_back(clean.positions[i]);
        cloud.weights.push_back(weight);
        cloud.spacing.push_back(estimate.spacing[i]);
    }
    cloud.report.fitted = static_cast<Index>(cloud.points.size());
}

void add_notes(const CloudReport& r, std::vector<RepairNote>& notes)
{
    const auto add = [&](const char* code, Index count, const std::string& what) {
        if (count > 0)
            notes.push_back({code, fmt::format("{} {}", count, what), count, false});
    };
    add("not_finite_points", r.not_finite, "points are not finite: dropped");
    add("duplicate_points", r.duplicates, "points lie where others do: merged");
    add("outliers", r.outliers, "points lie far from where their neighbours lie: left out");
    add("missing_normals", r.normals.filled_in, "points have no normal: estimated");
}

std::string joined(const std::vector<std::string>& parts)
{
    std::string text;
    for (const std::string& part : parts)
        text += (text.empty() ? "" : "; ") + part;
    return text;
}

} // namespace

Result<CloudInput> load_cloud(const ConvertOptions& options, Context& context)
{
    context.begin_stage("read");
    const Result<PointCloud> cloud = read_points(options.input, context);
    if (!cloud)
        return cloud.error();
    const Result<CleanPoints> clean = clean_points(*cloud, context);
    if (!clean)
        return clean.error();

    context.begin_stage("normals");
    OrientOptions orient = options.cloud.orient;
    if (!orient.viewpoint)
        orient.viewpoint = cloud->viewpoint;
    const Result<CloudNormals> normals =
        find_normals(*clean, options.cloud.normals, orient, context);
    if (!normals)
        return normals.error();

    context.begin_stage("reconstruct");
    const SurfaceEstimate& estimate = normals->estimate;
    ReconstructOptions reconstruct = options.cloud.reconstruct;
    if (options.fill_holes) {
        const double diagonal = diagonal_of(clean->positions);
        reconstruct.fill_holes = std::min(options.fill_holes->of(diagonal) / diagonal, 1.0);
    }
    Result<Reconstruction> surface = reconstruct_surface(
        clean->positions, estimate, normals->report.disagreement, reconstruct, context);
    if (!surface)
        return surface.error();

    CloudInput input;
    CloudReport& report = input.report;
    report.points = static_cast<Index>(cloud->size());
    report.not_finite = clean->not_finite;
    report.duplicates = clean->duplicates;
    report.normals = normals->report;
    report.spacing = estimate.median_spacing;
    report.noise = estimate.noise;
    report.noise_ratio = estimate.noise_ratio;
    report.topology = surface->topology;
    report.evidence = std::move(surface->evidence);
    input.mesh = std::move(surface->mesh);
    choose_points(*clean, estimate, input);
    add_notes(report, input.notes);
    return input;
}

std::optional<Error> refuse_cloud_solid(const CloudReport& report)
{
    if (report.topology == CloudTopology::uncertain)
        return Error{ErrorCode::open_mesh,
                     fmt::format("the points do not decide the topology of a solid: {}. Leave out "
                                 "--solid to take the surface as it is",
                                 joined(report.evidence.doubts)),
                     invalid_index};
    if (report.topology != CloudTopology::open)
        return std::nullopt;
    const std::vector<CloudHole>& holes = report.evidence.holes; // the largest first
    const auto hole = std::find_if(holes.begin(), holes.end(),
                                   [](const CloudHole& candidate) { return !candidate.filled; });
    const std::string bare = report.evidence.uncovered_area > 0.0
                                 ? fmt::format("{:.1f} % of the closed surface has none near it; ",
                                               100.0 * report.evidence.uncovered_area)
                                 : std::string();
    return Error{
        ErrorCode::open_mesh,
        fmt::format("the points do not close: {}the largest hole, {:.4g} across, is at {}. "
                    "Leave out --solid for an open surface, or let --fill-holes close "
                    "larger holes",
                    bare, hole->size, place_text(hole->place)),
        invalid_index};
}

std::vector<Warning> cloud_warnings(const CloudReport& r)
{
    std::vector<Warning> warnings;
    if (r.normals.file_has_normals && !r.normals.given)
        warnings.push_back(
            {"normals_estimated",
             fmt::format("{:.1f} % of the file's normals contradict those beside them, {:.1f} % "
                         "point to the other side than estimated: estimated ones are used. "
                         "--normals given takes them as they are",
                         100.0 * r.normals.given_contradicted, 100.0 * r.normals.given_flipped),
             invalid_index});
    if (r.topology == CloudTopology::uncertain)
        warnings.push_back({"uncertain_topology",
                            "the points do not decide the topology: " + joined(r.evidence.doubts),
                            invalid_index});
    const std::vector<CloudHole>& holes = r.evidence.holes; // the largest first
    const auto is_filled = [](const CloudHole& hole) { return hole.filled; };
    const auto filled = std::count_if(holes.begin(), holes.end(), is_filled);
    const auto places = [](std::ptrdiff_t count) {
        return fmt::format("{} place{} without points {}", count, count == 1 ? "" : "s",
                           count == 1 ? "is" : "are");
    };
    if (filled > 0) {
        const CloudHole& hole = *std::find_if(holes.begin(), holes.end(), is_filled);
        warnings.push_back({"holes_filled",
                            fmt::format("{} closed; the largest, {:.4g} across, is at {}. "
                                        "--fill-holes 0 leaves them open",
                                        places(filled), hole.size, place_text(hole.place)),
                            invalid_index});
    }
    const auto left = static_cast<std::ptrdiff_t>(holes.size()) - filled;
    if (left > 0) {
        const CloudHole& largest = *std::find_if_not(holes.begin(), holes.end(), is_filled);
        const CloudHole& smallest = *std::find_if_not(holes.rbegin(), holes.rend(), is_filled);
        const std::string sizes =
            left == 1 ? fmt::format("{:.4g} across, at {}", largest.size, place_text(largest.place))
                      : fmt::format("{:.4g} to {:.4g} across, the largest at {}", smallest.size,
                                    largest.size, place_text(largest.place));
        warnings.push_back(
            {"holes_left_open",
             fmt::format("{} left open: {}. --fill-holes SIZE closes those up to SIZE",
                         places(left), sizes),
             invalid_index});
    }
    if (r.evidence.dropped_components > 0)
        warnings.push_back({"dropped_components",
                            fmt::format("{} small pieces of the surface with few points near them "
                                        "are left out",
                                        r.evidence.dropped_components),
                            invalid_index});
    return warnings;
}

double expected_deviation(const CloudReport& report)
{
    return std::max(report.noise, detail_spacings * report.spacing);
}

double coverage_reach(const CloudReport& report)
{
    return hole_spacings * report.spacing + hole_deviations * report.noise;
}

Result<std::vector<PointData>> points_of_components(const CloudInput& cloud,
                                                    const RepairedMesh& mesh, Index& off_mesh,
                                                    Context& context)
{
    std::vector<Vec3> positions;
    std::vector<std::array<Index, 3>> triangles;
    std::vector<Index> component; // per triangle
    for (Index c = 0; c < mesh.components.size(); ++c) {
        const ManifoldMesh& m = mesh.components[c].mesh;
        const Index shift = static_cast<Index>(positions.size());
        positions.insert(positions.end(), m.positions().begin(), m.positions().end());
        for (const auto& t : m.triangles())
            triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
        component.resize(triangles.size(), c);
    }
    const ClosestPoint closest(positions, triangles);
    std::vector<Index> nearest(cloud.points.size());
    if (!for_each_chunk(context, nearest.size(), points_per_chunk,
                        [&](std::size_t begin, std::size_t end) {
                            for (std::size_t i = begin; i < end; ++i) {
                                const double spacing =
                                    std::min(cloud.spacing[i], most_medians * cloud.report.spacing);
                                const double reach = reach_spacings * spacing +
                                                     reach_deviations * cloud.report.noise;
                                const Index face = closest.query(cloud.points[i], reach).where.face;
                                nearest[i] = face != invalid_index ? component[face] : face;
                            }
                        }))
        return Context::cancelled_error("sampling");
    std::vector<PointData> result(mesh.components.size());
    for (PointData& points : result) {
        points.least_deviation = expected_deviation(cloud.report);
        points.noise = cloud.report.noise;
    }
    off_mesh = 0;
    for (std::size_t i = 0; i < nearest.size(); ++i) {
        if (nearest[i] == invalid_index) {
            ++off_mesh;
            continue;
        }
        result[nearest[i]].positions.push_back(cloud.points[i]);
        result[nearest[i]].weights.push_back(cloud.weights[i]);
    }
    return result;
}

} // namespace bot2nurbs
