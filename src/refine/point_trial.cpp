// SPDX-License-Identifier: MIT
#include "refine/point_trial.h"

#include "bot2nurbs/point_deviation.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace bot2nurbs {

namespace {

// Mean squares of the differences of values at scattered places of a patch, along u and along v: of
// the means in the cells of a grid. Cells without a place tell nothing.
class ScatteredChanges {
public:
    void add(const DomainPoint& at, double value)
    {
        const auto cell = [](double x) {
            return static_cast<Index>(std::clamp(x * side, 0.0, side - 1.0));
        };
        Cell& c = cells_[cell(at.v) * side + cell(at.u)];
        c.sum += value;
        ++c.count;
    }
    std::array<double, 2> mean_changes() const
    {
        std::array<double, 2> sums{};
        std::array<Index, 2> counts{};
        for (Index j = 0; j < side; ++j)
            for (Index i = 0; i < side; ++i) {
                if (i + 1 < side)
                    add_change(j * side + i, j * side + i + 1, sums[0], counts[0]);
                if (j + 1 < side)
                    add_change(j * side + i, (j + 1) * side + i, sums[1], counts[1]);
            }
        // No direction is known to change less than the other where one of them is not seen.
        if (counts[0] == 0 || counts[1] == 0)
            return {};
        return {sums[0] / counts[0], sums[1] / counts[1]};
    }

private:
    static constexpr Index side = 4; //!< Cells, one a Bezier piece.
    struct Cell {
        double sum = 0.0;
        Index count = 0;
    };

    void add_change(Index a, Index b, double& sum, Index& count) const
    {
        if (cells_[a].count == 0 || cells_[b].count == 0)
            return;
        const double d = cells_[b].sum / cells_[b].count - cells_[a].sum / cells_[a].count;
        sum += d * d;
        ++count;
    }

    std::array<Cell, std::size_t{side} * side> cells_{};
};

} // namespace

double noise_reach(double noise, std::size_t count)
{
    if (count == 0)
        return 0.0;
    constexpr double spread = 0.5;
    return noise * (std::sqrt(2.0 * std::log(2.0 * double(count))) + spread);
}

void measure_points(const SurfaceSampleSet& samples, std::size_t points,
                    const SplineSurface& surface, std::vector<PatchError>& patches)
{
    std::vector<ScatteredChanges> changes(patches.size());
    for (std::size_t i = 0; i < points; ++i) {
        const DomainPoint& at = samples.domain[i];
        const SurfacePoint place = surface.evaluate(at);
        const Vec3 miss = place.position - samples.positions[i];
        patches[at.quad].distance = std::max(patches[at.quad].distance, norm(miss));
        const Vec3 normal = cross(place.du, place.dv);
        const double length = norm(normal);
        if (length > 0.0)
            changes[at.quad].add(at, dot(miss, normal) / length);
    }
    for (std::size_t q = 0; q < patches.size(); ++q)
        patches[q].change = changes[q].mean_changes();
}

double distance_of_mesh(const ManifoldMesh& source, const PointData& points)
{
    double largest = 0.0;
    for (std::size_t i = 0; i < points.positions.size(); ++i)
        largest = std::max(largest, norm(points.positions[i] - source.at(points.source[i])));
    return largest;
}

Status prove_points(const FitTarget& target, Trial& trial, Context& context)
{
    const QuadComplex& complex = trial.domain.complex;
    const std::vector<Vec3>& points = target.points->positions;
    const Result<std::vector<PointFoot>> feet =
        find_point_feet(points, complex, trial.fit.surface, context);
    if (!feet)
        return feet.error();
    HausdorffOptions decide;
    decide.decide = target.surface_limit;
    const Result<HausdorffBound> strays =
        bound_hausdorff(target.source, complex, trial.fit.surface, decide, context);
    if (!strays)
        return strays.error();

    trial.bound = {};
    trial.bound.termination = HausdorffTermination::decided;
    trial.bound.patches.resize(complex.quad_count());
    OneSidedDistance& side = trial.bound.source_to_surface;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const PointFoot& foot = (*feet)[i];
        DistanceBounds& patch = trial.bound.patches[foot.where.quad].source_to_surface;
        patch.lower = patch.upper = std::max(patch.upper, foot.distance);
        if (foot.distance > side.upper) {
            side.lower = side.upper = foot.distance;
            side.worst = {points[i], foot.distance, foot.where, {}};
        }
    }
    const double mesh_distance = target.surface_limit - target.limit;
    bool strayed = false;
    for (Index q = 0; q < complex.quad_count(); ++q) {
        PatchError& patch = trial.patches[q];
        const double of_points = trial.bound.patches[q].source_to_surface.upper;
        const DistanceBounds& stray = strays->patches[q].surface_to_source;
        patch.distance = std::max(of_points, stray.lower - mesh_distance);
        patch.exceeds = of_points > target.limit || stray.lower > target.surface_limit;
        patch.beyond = of_points > target.limit || stray.upper > target.surface_limit;
        strayed = strayed || stray.upper > target.surface_limit;
    }
    trial.within = side.upper <= target.tolerance && !strayed;
    return {};
}

} // namespace bot2nurbs
