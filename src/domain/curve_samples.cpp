// SPDX-License-Identifier: MIT
#include "bot2nurbs/domain_samples.h"

#include "domain/chart_locator.h"

#include <algorithm>

namespace bot2nurbs {

namespace {

// Samples of a crease count this much more than those of the surface around: the patches on its two
// sides pull at it, and a crease off its place is seen where a surface is not. See fit.md.
constexpr double crease_weight = 16.0;

// Place at parameter t along side s of a quad, from corner s to corner s + 1.
Vec2 on_side(Index s, double t)
{
    switch (s) {
    case 0: return {t, 0.0};
    case 1: return {1.0, t};
    case 2: return {1.0 - t, 1.0};
    default: return {0.0, 1.0 - t};
    }
}

bool starts_on_sharp_side(const QuadComplex& complex, const DomainPoint& d)
{
    const bool on[4] = {d.v <= 0.0, d.u >= 1.0, d.v >= 1.0, d.u <= 0.0};
    for (Index s = 0; s < 4; ++s)
        if (on[s] && complex.is_sharp(complex.edge(4 * d.quad + s)))
            return true;
    return false;
}

} // namespace

void add_curve_samples(const ManifoldMesh& source, const QuadComplex& complex,
                       const std::vector<QuadChart>& charts, const SampleOptions& options,
                       SurfaceSampleSet& samples)
{
    std::vector<double> weight(complex.quad_count(), 0.0);
    std::vector<Index> count(complex.quad_count(), 0);
    samples.on_curve.assign(samples.size(), 0);
    bool any = false;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const DomainPoint& d = samples.domain[i];
        weight[d.quad] += samples.weights[i];
        ++count[d.quad];
        samples.on_curve[i] = starts_on_sharp_side(complex, d);
        any = any || samples.on_curve[i];
    }
    for (Index e = 0; e < complex.edge_count(); ++e) {
        if (!complex.is_sharp(e))
            continue;
        any = true;
        const Index h = complex.halfedge_of_edge(e), q = QuadComplex::quad_of(h);
        const ChartLocator locator(charts[q]);
        const double share = complex.is_boundary_edge(e) ? 1.0 : crease_weight;
        const double each = share * weight[q] / std::max<Index>(count[q], 1);
        const auto add = [&](double t) {
            const Vec2 uv = on_side(QuadComplex::side_of(h), t);
            const SourcePoint point = source_point(charts[q], locator.locate(uv));
            samples.positions.push_back(source.at(point));
            if (!samples.normals.empty())
                samples.normals.push_back(normalized(source.area_vector(point.face)));
            samples.weights.push_back(each);
            samples.source.push_back(point);
            samples.domain.push_back({q, uv.x, uv.y});
            samples.on_curve.push_back(1);
        };
        add(0.0);
        for (Index i = 0; i < options.per_side; ++i)
            add((i + 0.5) / options.per_side);
        add(1.0);
    }
    if (!any)
        samples.on_curve.clear();
}

} // namespace bot2nurbs
