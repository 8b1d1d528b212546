// SPDX-License-Identifier: MIT
#include "bot2nurbs/layout_quality.h"

#include <algorithm>
#include <cmath>

namespace bot2nurbs {

namespace {

constexpr double degrees_per_radian = 57.295779513082320877;
// Share of a chart's area left out at either end when its areas per parameter are compared.
constexpr double ignored_share = 0.01;

Spread spread_of(const std::vector<double>& values)
{
    Spread s;
    if (values.empty())
        return s;
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    s.least = *least;
    s.most = *most;
    s.least_at = static_cast<Index>(least - values.begin());
    s.most_at = static_cast<Index>(most - values.begin());
    std::vector<double> sorted(values);
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    s.median = *middle;
    return s;
}

struct ChartMeasures {
    double area = 0.0, stretch = 0.0, angle = 0.0, area_ratio = 1.0;
};

ChartMeasures measure_chart(const QuadChart& chart)
{
    ChartMeasures m;
    double squared_stretch = 0.0;
    std::vector<std::pair<double, double>> speed; // Area per parameter, area.
    for (const auto& t : chart.triangles) {
        const Vec3 p = chart.vertices[t[1]].position - chart.vertices[t[0]].position;
        const Vec3 q = chart.vertices[t[2]].position - chart.vertices[t[0]].position;
        const Vec2 a = chart.vertices[t[1]].uv - chart.vertices[t[0]].uv;
        const Vec2 b = chart.vertices[t[2]].uv - chart.vertices[t[0]].uv;
        const double twice_source = norm(cross(p, q)), twice_target = cross(a, b);
        if (!(twice_source > 0.0 && twice_target > 0.0))
            continue;
        const double area = 0.5 * twice_source;
        const Vec3 du = (b.y * p - a.y * q) / twice_target, dv = (a.x * q - b.x * p) / twice_target;
        m.area += area;
        squared_stretch += 0.5 * area * (norm_squared(du) + norm_squared(dv));
        m.angle +=
            area * degrees_per_radian * std::atan2(norm(cross(du, dv)), std::fabs(dot(du, dv)));
        speed.emplace_back(twice_source / twice_target, area);
    }
    if (!(m.area > 0.0))
        return m;
    m.angle /= m.area;
    // The square has area one, so a similarity has squared stretch m.area.
    m.stretch = squared_stretch / (m.area * m.area);
    std::sort(speed.begin(), speed.end());
    const auto at_share = [&](double share) {
        double sum = 0.0;
        for (const auto& [s, area] : speed) {
            sum += area;
            if (sum >= share * m.area)
                return s;
        }
        return speed.back().first;
    };
    m.area_ratio = at_share(1.0 - ignored_share) / at_share(ignored_share);
    return m;
}

double length_of(const QuadDomain& domain, const DomainEdge& edge)
{
    const ManifoldMesh& mesh = domain.carrier.mesh;
    Vec3 last = mesh.position(domain.vertices[edge.a]);
    double sum = 0.0;
    for (const PathPoint& p : edge.path) {
        const Vec3 next = (1.0 - p.t) * mesh.position(p.from) + p.t * mesh.position(p.to);
        sum += norm(next - last);
        last = next;
    }
    return sum + norm(mesh.position(domain.vertices[edge.b]) - last);
}

} // namespace

LayoutQuality measure_layout(const QuadDomain& domain, const std::vector<QuadChart>& charts)
{
    const QuadComplex& complex = domain.complex;
    std::vector<double> length, straightness;
    for (const DomainEdge& e : domain.edges) {
        length.push_back(length_of(domain, e));
        const double chord = norm(domain.carrier.mesh.position(domain.vertices[e.b]) -
                                  domain.carrier.mesh.position(domain.vertices[e.a]));
        straightness.push_back(chord > 0.0 ? length.back() / chord : 1.0);
    }
    std::vector<double> stretch, angle, area_ratio, aspect, area;
    for (Index q = 0; q < charts.size(); ++q) {
        const ChartMeasures m = measure_chart(charts[q]);
        stretch.push_back(m.stretch);
        angle.push_back(m.angle);
        area_ratio.push_back(m.area_ratio);
        area.push_back(m.area);
        double side[2] = {0.0, 0.0};
        for (Index s = 0; s < 4; ++s)
            side[s % 2] += length[complex.edge(4 * q + s)];
        const auto [shorter, longer] = std::minmax(side[0], side[1]);
        aspect.push_back(shorter > 0.0 ? longer / shorter : 1.0);
    }
    double mean = 0.0;
    for (const double a : area)
        mean += a / static_cast<double>(area.size());
    for (double& a : area)
        a = mean > 0.0 ? a / mean : 1.0;
    return {spread_of(stretch), spread_of(angle), spread_of(area_ratio),
            spread_of(aspect),  spread_of(area),  spread_of(straightness)};
}

} // namespace bot2nurbs
