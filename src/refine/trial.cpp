// SPDX-License-Identifier: MIT
#include "refine/trial.h"

#include "refine/point_trial.h"

#include <algorithm>
#include <utility>

namespace bot2nurbs {

namespace {

// Emphasis of the fit, over the tolerance. It halves the largest distances where edges are rounded:
// bunny and spot need 10 and 29 % fewer patches for 0.3 % of the diagonal than without.
constexpr double emphasis_share = 0.5;

// Cells bounded for every triangle and Bezier piece before the question is left open: decisions of
// surfaces that are near take 1 to 12, those of surfaces that are far would take hundreds.
constexpr std::uint64_t cells_per_element = 20;

// Mean squares of the differences of neighbours in a grid, row by row: along rows, then across.
std::array<double, 2> mean_changes(const double* grid, Index side)
{
    double along = 0.0, across = 0.0;
    for (Index j = 0; j < side; ++j)
        for (Index i = 0; i < side; ++i) {
            const double here = grid[j * side + i];
            if (i + 1 < side) {
                const double d = grid[j * side + i + 1] - here;
                along += d * d;
            }
            if (j + 1 < side) {
                const double d = grid[(j + 1) * side + i] - here;
                across += d * d;
            }
        }
    const double count = double(side) * (side - 1);
    return {along / count, across / count};
}

// What the samples of each patch say. `first`: per quad its first sample, of which side * side are
// on a grid of the chart.
void measure_samples(const SurfaceSampleSet& samples, const std::vector<std::size_t>& first,
                     const SplineSurface& surface, Index side, std::vector<PatchError>& patches)
{
    std::vector<double> residual(samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const Vec3 miss = surface.position(samples.domain[i]) - samples.positions[i];
        PatchError& patch = patches[samples.domain[i].quad];
        patch.distance = std::max(patch.distance, norm(miss));
        residual[i] = dot(miss, samples.normals[i]);
    }
    for (std::size_t q = 0; q < patches.size(); ++q)
        patches[q].change = mean_changes(residual.data() + first[q], side);
}

template <class Condition>
Index count(const std::vector<PatchError>& patches, const Condition& condition)
{
    return static_cast<Index>(std::count_if(patches.begin(), patches.end(), condition));
}

// Adds places of the source as samples, with this many times the mean weight of those in their
// quad, for there are few of them.
Status add_hard_places(const ManifoldMesh& source, const std::vector<QuadChart>& charts,
                       const std::vector<SourcePoint>& places, SurfaceSampleSet& samples,
                       Context& context)
{
    constexpr double emphasis = 4.0;
    if (places.empty())
        return {};
    std::vector<double> weight(charts.size(), 0.0), count(charts.size(), 0.0);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        weight[samples.domain[i].quad] += samples.weights[i];
        count[samples.domain[i].quad] += 1.0;
    }
    PointData data;
    data.source = places;
    for (const SourcePoint& p : places)
        data.positions.push_back(source.at(p));
    data.weights.assign(places.size(), 1.0);
    const Result<SurfaceSampleSet> added = project_samples(source, charts, data, context);
    if (!added)
        return added.error();
    for (std::size_t i = 0; i < added->size(); ++i) {
        const Index quad = added->domain[i].quad;
        samples.positions.push_back(added->positions[i]);
        samples.normals.push_back(normalized(source.area_vector(added->source[i].face)));
        samples.weights.push_back(emphasis * weight[quad] / count[quad]);
        samples.source.push_back(added->source[i]);
        samples.domain.push_back(added->domain[i]);
    }
    return {};
}

struct FitSamples {
    SurfaceSampleSet all;
    Index anchors = 0;
    std::vector<std::size_t> first; // Per quad, without points: see measure_samples().
};

Result<FitSamples> samples_of(const FitTarget& target, const QuadComplex& complex,
                              const std::vector<QuadChart>& charts, const ToleranceOptions& options,
                              Context& context)
{
    FitSamples result;
    if (target.points != nullptr) {
        Result<SurfaceSampleSet> made = make_point_samples(target.source, complex, charts,
                                                           *target.points, result.anchors, context);
        if (!made)
            return made.error();
        result.all = std::move(*made);
        return result;
    }
    Result<SurfaceSampleSet> made = make_samples(target.source, charts, options.samples, context);
    if (!made)
        return made.error();
    result.all = std::move(*made);
    result.first.assign(complex.quad_count(), result.all.size());
    for (std::size_t i = result.all.size(); i-- > 0;)
        result.first[result.all.domain[i].quad] = i;
    if (Status failed =
            add_hard_places(target.source, charts, target.hard_places, result.all, context))
        return *failed;
    add_curve_samples(target.source, complex, charts, options.samples, result.all);
    return result;
}

} // namespace

Index Trial::exceeding() const
{
    return count(patches, [](const PatchError& p) { return p.exceeds; });
}

Index Trial::beyond() const
{
    return count(patches, [](const PatchError& p) { return p.beyond; });
}

Index Trial::folded() const
{
    return count(patches, [](const PatchError& p) { return p.folded; });
}

Index Trial::to_cut() const
{
    return count(patches, [](const PatchError& p) { return p.beyond || p.folded; });
}

double Trial::distance() const
{
    double largest = 0.0;
    for (const PatchError& p : patches)
        largest = std::max(largest, p.distance);
    return largest;
}

FitTarget::FitTarget(const ManifoldMesh& mesh, const PointData* data, double wanted)
    : source(mesh), points(data), tolerance(wanted), limit(wanted), surface_limit(wanted)
{
    if (points == nullptr)
        return;
    limit = std::max(tolerance, noise_reach(points->noise, points->positions.size()));
    surface_limit = limit + distance_of_mesh(source, *points);
}

Result<Trial> make_trial(const FitTarget& target, QuadDomain domain,
                         const ToleranceOptions& options, Context& context)
{
    const ManifoldMesh& source = target.source;
    Trial trial;
    trial.domain = std::move(domain);
    const QuadComplex& complex = trial.domain.complex;
    Result<std::vector<QuadChart>> charts = compute_charts(source, trial.domain, context);
    if (!charts)
        return charts.error();
    trial.charts = std::move(*charts);
    Result<FitSamples> samples = samples_of(target, complex, trial.charts, options, context);
    if (!samples)
        return samples.error();

    const Result<SplineNetwork> network =
        build_spline_network(complex, options.spline, corner_angles(trial.charts));
    if (!network)
        return network.error();
    FitOptions how = options.fit;
    if (target.points == nullptr) {
        how.emphasis = emphasis_share * options.tolerance;
    } else {
        // Points that are far away are outliers, or noise: they must not count more.
        how.robust = true;
        how.noise = target.points->noise;
        how.least_deviation = std::max(target.points->least_deviation, options.tolerance);
    }
    // Points are noisy, and what is between them is unknown.
    Result<FitResult> fit =
        fit_network(*network, samples->all, how, context,
                    target.points == nullptr ? nearest_place(source, context) : NearestPlace());
    if (!fit)
        return fit.error();
    trial.fit = std::move(*fit);
    trial.anchors = samples->anchors;

    trial.patches.resize(complex.quad_count());
    if (target.points != nullptr)
        measure_points(samples->all, target.points->positions.size(), trial.fit.surface,
                       trial.patches);
    else
        measure_samples(samples->all, samples->first, trial.fit.surface, options.samples.per_side,
                        trial.patches);
    for (Index q = 0; q < complex.quad_count(); ++q) {
        PatchError& patch = trial.patches[q];
        patch.exceeds = patch.beyond = patch.distance > target.limit;
        patch.folded = trial.fit.summary.smallest_jacobians[q] < 0.0;
    }
    return trial;
}

void TrialDeleter::operator()(Trial* trial) const
{
    delete trial;
}

Status prove_trial(const FitTarget& target, Trial& trial, Context& context)
{
    if (target.points != nullptr) {
        Status failed = prove_points(target, trial, context);
        trial.proven = !failed;
        return failed;
    }
    const ManifoldMesh& source = target.source;
    const double tolerance = target.tolerance;
    const QuadComplex& complex = trial.domain.complex;
    const auto exceeds = [](const PatchError& patch) { return patch.exceeds; };
    HausdorffOptions decide;
    decide.decide = tolerance;
    decide.max_cells = cells_per_element * (std::uint64_t{source.face_count()} +
                                            std::uint64_t{16} * complex.quad_count());
    for (;;) {
        Result<HausdorffBound> bound =
            bound_hausdorff(source, complex, trial.fit.surface, decide, context);
        if (!bound)
            return bound.error();
        trial.bound = std::move(*bound);
        trial.within = trial.bound.upper() <= tolerance;
        for (Index q = 0; q < complex.quad_count(); ++q) {
            const PatchDistance& known = trial.bound.patches[q];
            // Feet of samples are found by a local search, and may be farther than the distance.
            PatchError& patch = trial.patches[q];
            patch.distance = 0.0;
            patch.exceeds = patch.beyond = false;
            for (const DistanceBounds& d : {known.surface_to_source, known.source_to_surface}) {
                patch.distance = std::max(patch.distance, d.lower);
                patch.exceeds = patch.exceeds || d.lower > tolerance;
                patch.beyond = patch.beyond || d.upper > tolerance;
            }
        }
        const bool limited = trial.bound.termination == HausdorffTermination::cell_limit;
        if (!limited || decide.max_cells == 0 ||
            std::any_of(trial.patches.begin(), trial.patches.end(), exceeds)) {
            trial.proven = true;
            return {};
        }
        decide.max_cells = 0;
    }
}

} // namespace bot2nurbs
