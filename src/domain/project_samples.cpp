// SPDX-License-Identifier: MIT
#include "bot2nurbs/closest_point.h"
#include "bot2nurbs/domain_samples.h"
#include "core/parallel.h"

#include <algorithm>
#include <cmath>

namespace bot2nurbs {

namespace {

constexpr std::size_t points_per_chunk = 256;
//! Bezier pieces of a quad per direction.
constexpr Index pieces_per_side = 4;

//! The chart triangles that cover each face of the source.
class FaceCharts {
public:
    FaceCharts(const ManifoldMesh& source, const std::vector<QuadChart>& charts) : charts_(charts)
    {
        first_.assign(source.face_count() + std::size_t{1}, 0);
        for (const QuadChart& chart : charts)
            for (const Index f : chart.source_face)
                ++first_[f + std::size_t{1}];
        for (std::size_t f = 1; f < first_.size(); ++f)
            first_[f] += first_[f - 1];
        pieces_.resize(first_.back());
        std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
        for (Index q = 0; q < charts.size(); ++q)
            for (Index t = 0; t < charts[q].triangles.size(); ++t)
                pieces_[next[charts[q].source_face[t]]++] = {q, t};
    }

    //! Where a place of the source lies in the domain: in the triangle in which it lies deepest, so
    //! that rounding at its edges loses nothing.
    DomainPoint locate(const SourcePoint& p) const
    {
        DomainPoint best;
        double deepest = -INFINITY;
        for (std::size_t i = first_[p.face]; i < first_[p.face + std::size_t{1}]; ++i) {
            const auto [q, t] = pieces_[i];
            const QuadChart& chart = charts_[q];
            const auto& corner = chart.bary[t];
            const auto minor = [&](const std::array<double, 3>& a, const std::array<double, 3>& b,
                                   const std::array<double, 3>& c) {
                return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
            };
            const double all = minor(corner[0], corner[1], corner[2]);
            if (all == 0.0)
                continue;
            std::array<double, 3> w{minor(p.bary, corner[1], corner[2]) / all,
                                    minor(corner[0], p.bary, corner[2]) / all,
                                    minor(corner[0], corner[1], p.bary) / all};
            const double depth = std::min({w[0], w[1], w[2]});
            if (!(depth > deepest))
                continue;
            deepest = depth;
            Vec2 uv;
            double sum = 0.0;
            for (std::size_t k = 0; k < 3; ++k) {
                w[k] = std::max(w[k], 0.0);
                sum += w[k];
                uv = uv + w[k] * chart.vertices[chart.triangles[t][k]].uv;
            }
            best = {q, std::clamp(uv.x / sum, 0.0, 1.0), std::clamp(uv.y / sum, 0.0, 1.0)};
        }
        return best;
    }

private:
    struct Piece {
        Index quad, triangle;
    };
    const std::vector<QuadChart>& charts_;
    std::vector<std::size_t> first_; //!< Per face.
    std::vector<Piece> pieces_;
};

} // namespace

NearestPlace nearest_place(const ManifoldMesh& source, const Context& context)
{
    return [&source, closest = ClosestPoint(source, &context)](
               const Vec3& point, const Vec3& along) -> std::optional<NearPlace> {
        const ClosestPoint::Hit hit = closest.query_facing(point, along);
        if (hit.where.face == invalid_index)
            return std::nullopt;
        return NearPlace{hit.position, normalized(source.area_vector(hit.where.face))};
    };
}

Result<std::vector<SourcePoint>> closest_places(const ManifoldMesh& source,
                                                const std::vector<Vec3>& points, Context& context)
{
    const ClosestPoint closest(source, &context);
    std::vector<SourcePoint> places(points.size());
    if (!for_each_chunk(context, points.size(), points_per_chunk,
                        [&](std::size_t begin, std::size_t end) {
                            for (std::size_t i = begin; i < end; ++i)
                                places[i] = closest.query(points[i]).where;
                        }))
        return Context::cancelled_error("sampling");
    return places;
}

Result<SurfaceSampleSet> project_samples(const ManifoldMesh& source,
                                         const std::vector<QuadChart>& charts,
                                         const PointData& points, Context& context)
{
    const FaceCharts faces(source, charts);
    SurfaceSampleSet samples;
    samples.positions = points.positions;
    samples.weights = points.weights;
    samples.source = points.source;
    samples.domain.resize(samples.size());
    if (!for_each_chunk(context, samples.size(), points_per_chunk,
                        [&](std::size_t begin, std::size_t end) {
                            for (std::size_t i = begin; i < end; ++i)
                                samples.domain[i] = faces.locate(samples.source[i]);
                        }))
        return Context::cancelled_error("sampling");
    for (Index i = 0; i < samples.size(); ++i)
        if (samples.domain[i].quad == invalid_index)
            return Error{ErrorCode::invalid_domain,
                         "no chart covers face " + std::to_string(samples.source[i].face),
                         samples.source[i].face};
    return samples;
}

Result<SurfaceSampleSet> make_point_samples(const ManifoldMesh& source, const QuadComplex& complex,
                                            const std::vector<QuadChart>& charts,
                                            const PointData& points, Index& anchors,
                                            Context& context)
{
    Result<SurfaceSampleSet> samples = project_samples(source, charts, points, context);
    if (!samples)
        return samples;
    const Result<Index> added = add_anchor_samples(source, charts, *samples, context);
    if (!added)
        return added.error();
    anchors = *added;
    add_curve_samples(source, complex, charts, {}, *samples);
    return samples;
}

Result<Index> add_anchor_samples(const ManifoldMesh& source, const std::vector<QuadChart>& charts,
                                 SurfaceSampleSet& samples, Context& context)
{
    constexpr Index side = pieces_per_side;
    const auto piece_of = [](const DomainPoint& d) {
        const auto cell = [](double x) {
            return static_cast<Index>(std::clamp(x * side, 0.0, side - 1.0));
        };
        return (d.quad * side + cell(d.u)) * side + cell(d.v);
    };
    SampleOptions grid;
    grid.per_side = side;
    grid.max_vertices = 0;
    const Result<SurfaceSampleSet> all = make_samples(source, charts, grid, context);
    if (!all)
        return all.error();
    std::vector<char> seen(charts.size() * side * side, 0);
    for (const DomainPoint& d : samples.domain)
        seen[piece_of(d)] = 1;
    Index added = 0;
    for (std::size_t i = 0; i < all->size(); ++i) {
        if (seen[piece_of(all->domain[i])])
            continue;
        samples.positions.push_back(all->positions[i]);
        samples.weights.push_back(all->weights[i]);
        samples.source.push_back(all->source[i]);
        samples.domain.push_back(all->domain[i]);
        ++added;
    }
    return added;
}

} // namespace bot2nurbs
