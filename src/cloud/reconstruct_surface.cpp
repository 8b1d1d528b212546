// SPDX-License-Identifier: MIT
#include "bot2nurbs/reconstruct_surface.h"

#include "cloud/ball_pivoting.h"
#include "cloud/pivoted_mesh.h"
#include "cloud/poisson_surface.h"
#include "cloud/surface_coverage.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace bot2nurbs {

namespace {

//! A component with fewer points near it is an outlier's bubble: a closed surface of its own takes
//! more to be seen.
constexpr Index fewest_points = 30;
//! A component, or the whole surface, with more of its area without points is a guess.
constexpr double most_uncovered = 0.5;
//! Share of the points that may contradict their neighbours about the side: a tenth of what one
//! wrongly turned limb makes.
constexpr double most_disagreement = 0.005;
//! Neighbourhoods that leave this share of their radius unexplained fill space (a third) rather
//! than show a surface (a tenth and less). From here on known bodies came out with handles that
//! they do not have.
constexpr double most_noise_ratio = 0.175;

//! Share of the points that may lie beside the surface that balls roll over: noise hides them.
constexpr double most_unused = 0.1;
//! Size of the loops that balls leave by chance, over the mean length of their edges.
constexpr double loop_spacings = 5.0;

std::string percent(double share)
{
    const double tenths = std::round(1000.0 * share);
    const auto whole = static_cast<long>(tenths / 10.0);
    return std::to_string(whole) + "." + std::to_string(static_cast<long>(tenths) - 10 * whole) +
           " %";
}

//! Drops components that few points support; never the one with most points. \return how many
Result<Index> drop_spurious(TriangleSoup& mesh, const std::vector<Vec3>& points,
                            const SurfaceEstimate& estimate, Context& context)
{
    const Result<SurfaceCoverage> coverage = measure_coverage(mesh, points, estimate, context);
    if (!coverage)
        return coverage.error();
    const std::size_t count = coverage->points.size();
    const auto largest = static_cast<std::size_t>(
        std::max_element(coverage->points.begin(), coverage->points.end()) -
        coverage->points.begin());
    std::vector<char> drop(count, 0);
    for (std::size_t c = 0; c < count; ++c)
        drop[c] = c != largest && (coverage->points[c] < fewest_points ||
                                   coverage->uncovered[c] > most_uncovered * coverage->area[c]);
    const auto dropped = static_cast<Index>(std::count(drop.begin(), drop.end(), 1));
    if (dropped > 0)
        mesh = without_components(mesh, coverage->component, drop);
    return dropped;
}

double diagonal_of(const std::vector<Vec3>& points, const SurfaceEstimate& estimate)
{
    Box3 box;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (!estimate.outlier[i])
            box.add(points[i]);
    return box.diagonal();
}

//! A surface without what is spurious, open at the larger holes.
struct TrimmedSurface {
    TriangleSoup mesh;
    int depth = 0;
    Index dropped = 0;
    double uncovered = 0.0; //!< Share of the closed surface.
    double unused = 0.0;    //!< Share of the points.
    std::vector<CloudHole> holes;
    bool opened = false;
};

//! Whether a hole is one of those that the options fill, or else as wide as gaps are.
bool is_filled(const CloudHole& hole, const ReconstructOptions& options, double diagonal,
               double gap_spacings)
{
    return options.fill_holes ? hole.size <= *options.fill_holes * diagonal
                              : hole.spacings <= gap_spacings;
}

void sort_holes(std::vector<CloudHole>& holes)
{
    std::stable_sort(holes.begin(), holes.end(),
                     [](const CloudHole& a, const CloudHole& b) { return a.size > b.size; });
}

//! The Poisson surface.
Result<TrimmedSurface> trimmed_surface(const std::vector<Vec3>& points,
                                       const SurfaceEstimate& estimate,
                                       const ReconstructOptions& options, int halvings,
                                       Context& context)
{
    Result<PoissonSurface> closed = poisson_surface(points, estimate, options, halvings, context);
    if (!closed)
        return closed.error();
    TrimmedSurface result;
    result.depth = closed->depth;
    result.mesh = std::move(closed->mesh);
    Result<Index> dropped = drop_spurious(result.mesh, points, estimate, context);
    if (!dropped)
        return dropped.error();
    result.dropped = *dropped;
    const Result<SurfaceCoverage> coverage =
        measure_coverage(result.mesh, points, estimate, context);
    if (!coverage)
        return coverage.error();
    result.uncovered =
        std::accumulate(coverage->uncovered.begin(), coverage->uncovered.end(), 0.0) /
        std::accumulate(coverage->area.begin(), coverage->area.end(), 0.0);
    SurfaceHoles holes = find_holes(result.mesh, *coverage);
    const double diagonal = diagonal_of(points, estimate), gap = chance_gap(points.size());
    std::vector<char> cut;
    for (CloudHole& hole : holes.holes) {
        hole.filled = is_filled(hole, options, diagonal, gap);
        cut.push_back(!hole.filled);
    }
    result.opened = std::count(cut.begin(), cut.end(), 1) > 0;
    if (result.opened) {
        result.mesh = cut_out(result.mesh, *coverage, holes, cut);
        if (result.mesh.triangles.empty())
            return Error{ErrorCode::bad_geometry,
                         "no part of the reconstructed surface has points near it", invalid_index};
        // Scraps that the cut left.
        dropped = drop_spurious(result.mesh, points, estimate, context);
        if (!dropped)
            return dropped.error();
        result.dropped += *dropped;
    }
    result.holes = std::move(holes.holes);
    sort_holes(result.holes);
    return result;
}

//! The surface that balls roll over.
Result<TrimmedSurface> pivoted_surface(const std::vector<Vec3>& points,
                                       const SurfaceEstimate& estimate,
                                       const ReconstructOptions& options, Context& context)
{
    const Result<std::vector<std::array<Index, 3>>> triangles =
        pivot_balls(points, estimate, context);
    if (!triangles)
        return triangles.error();
    if (triangles->empty())
        return Error{ErrorCode::bad_geometry, "balls find no three points that show a surface",
                     invalid_index};
    TrimmedSurface result;
    std::vector<char> used(points.size(), 0);
    for (const auto& t : *triangles)
        for (const Index v : t)
            used[v] = 1;
    const auto all = std::count(estimate.outlier.begin(), estimate.outlier.end(), 0);
    result.unused = 1.0 - double(std::count(used.begin(), used.end(), 1)) / double(all);
    result.mesh = mesh_of_fans(points, *triangles);
    const Result<Index> dropped = drop_spurious(result.mesh, points, estimate, context);
    if (!dropped)
        return dropped.error();
    result.dropped = *dropped;
    const double diagonal = diagonal_of(points, estimate);
    result.holes = fill_loops(result.mesh, [&](const CloudHole& hole) {
        return !context.cancelled() && is_filled(hole, options, diagonal, loop_spacings);
    });
    if (context.cancelled())
        return Context::cancelled_error("reconstruction");
    sort_holes(result.holes);
    result.opened = std::any_of(result.holes.begin(), result.holes.end(),
                                [](const CloudHole& hole) { return !hole.filled; });
    return result;
}

//! Six times the volume that the points enclose if their normals point outward; negative if they
//! point inward.
double signed_volume(const std::vector<Vec3>& points, const SurfaceEstimate& estimate)
{
    Vec3 centre;
    double area = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (!estimate.outlier[i]) {
            const double a = estimate.spacing[i] * estimate.spacing[i];
            centre += a * (points[i] - points[0]);
            area += a;
        }
    centre = points[0] + (area > 0.0 ? centre / area : Vec3{});
    double sum = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (!estimate.outlier[i])
            sum += estimate.spacing[i] * estimate.spacing[i] *
                   dot(estimate.normals[i], points[i] - centre);
    return 2.0 * sum;
}

//! The same surface seen from the other side.
void turn_over(SurfaceEstimate& estimate)
{
    for (Vec3& n : estimate.normals)
        n = -n;
}

void turn_over(TriangleSoup& mesh)
{
    for (auto& t : mesh.triangles)
        std::swap(t[1], t[2]);
}

void find_doubts(const SurfaceEstimate& estimate, double disagreement, SurfaceEvidence& evidence)
{
    if (evidence.genus != evidence.finer_genus)
        evidence.doubts.push_back("the genus is " + std::to_string(evidence.genus) +
                                  ", but with cells of half the size " +
                                  std::to_string(evidence.finer_genus));
    if (disagreement > most_disagreement)
        evidence.doubts.push_back(percent(disagreement) +
                                  " of the points contradict their neighbours about which side is "
                                  "outside");
    if (estimate.noise_ratio > most_noise_ratio)
        evidence.doubts.push_back("the points are too sparse or too noisy to show a surface: "
                                  "neighbourhoods of every size are " +
                                  percent(2.0 * estimate.noise_ratio) + " as thick as wide");
    if (evidence.unused_points > most_unused)
        evidence.doubts.push_back("balls do not meet " + percent(evidence.unused_points) +
                                  " of the points");
    if (evidence.uncovered_area > most_uncovered)
        evidence.doubts.push_back("no points lie near " + percent(evidence.uncovered_area) +
                                  " of the closed surface");
}

//! \pre most normals point outward
Result<Reconstruction> reconstruct_outward(const std::vector<Vec3>& points,
                                           const SurfaceEstimate& estimate, double disagreement,
                                           const ReconstructOptions& options, Context& context)
{
    const bool pivots = options.method == ReconstructionMethod::ball_pivoting;
    Result<TrimmedSurface> surface = pivots
                                         ? pivoted_surface(points, estimate, options, context)
                                         : trimmed_surface(points, estimate, options, 0, context);
    if (!surface)
        return surface.error();
    int finer_genus = genus_of(surface->mesh);
    if (!pivots) {
        const Result<TrimmedSurface> finer = trimmed_surface(points, estimate, options, 1, context);
        if (!finer)
            return finer.error();
        finer_genus = genus_of(finer->mesh);
    }
    Reconstruction result;
    SurfaceEvidence& evidence = result.evidence;
    evidence.depth = surface->depth;
    evidence.uncovered_area = surface->uncovered;
    evidence.genus = genus_of(surface->mesh);
    evidence.finer_genus = finer_genus;
    evidence.unused_points = surface->unused;
    evidence.components = count_components(surface->mesh);
    evidence.dropped_components = surface->dropped;
    result.topology = surface->opened          ? CloudTopology::open
                      : surface->holes.empty() ? CloudTopology::closed
                                               : CloudTopology::holes_filled;
    evidence.holes = std::move(surface->holes);
    find_doubts(estimate, disagreement, evidence);
    if (!evidence.doubts.empty())
        result.topology = CloudTopology::uncertain;
    result.mesh = std::move(surface->mesh);
    return result;
}

} // namespace

const char* name(ReconstructionMethod method)
{
    switch (method) {
    case ReconstructionMethod::poisson: return "poisson";
    case ReconstructionMethod::ball_pivoting: return "ball_pivoting";
    }
    return "";
}

const char* name(CloudTopology topology)
{
    switch (topology) {
    case CloudTopology::closed: return "closed";
    case CloudTopology::holes_filled: return "holes_filled";
    case CloudTopology::open: return "open";
    case CloudTopology::uncertain: return "uncertain";
    }
    return "";
}

std::optional<Error> ReconstructOptions::check() const
{
    if (depth && method == ReconstructionMethod::ball_pivoting)
        return Error{ErrorCode::bad_option,
                     "a depth is one of the Poisson reconstruction: balls have none",
                     invalid_index};
    if (depth && (*depth < 3 || *depth > 12))
        return Error{ErrorCode::bad_option,
                     "the depth " + std::to_string(*depth) + " is not in 3 .. 12", invalid_index};
    if (fill_holes && !(*fill_holes >= 0.0 && *fill_holes <= 1.0))
        return Error{ErrorCode::bad_option, "the size of holes to fill is not in 0 .. 1",
                     invalid_index};
    if (most_vertices < 1000)
        return Error{ErrorCode::bad_option, "most_vertices must be at least 1000", invalid_index};
    return std::nullopt;
}

Result<Reconstruction> reconstruct_surface(const std::vector<Vec3>& points,
                                           const SurfaceEstimate& estimate, double disagreement,
                                           const ReconstructOptions& options, Context& context)
{
    if (const auto bad = options.check())
        return *bad;
    if (signed_volume(points, estimate) < 0.0) {
        SurfaceEstimate turned = estimate;
        turn_over(turned);
        Result<Reconstruction> result =
            reconstruct_outward(points, turned, disagreement, options, context);
        if (result)
            turn_over(result->mesh);
        return result;
    }
    return reconstruct_outward(points, estimate, disagreement, options, context);
}

} // namespace bot2nurbs
