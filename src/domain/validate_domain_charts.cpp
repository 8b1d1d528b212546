// SPDX-License-Identifier: MIT
#include "domain/validate_domain_rules.h"

#include "core/predicates.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace bot2nurbs {

namespace {

//! Distance, as a share of the source's box, up to which two computed places are the same: charts
//! compute a place in space by a few products and sums, so they agree to some 1e-15.
constexpr double same_place = 1e-10;
//! How far the triangles' areas may be from filling the unit square. A chart that wraps the square
//! twice is off by 1; rounding by 1e-16 times the number of triangles.
constexpr double area_slack = 1e-9;

std::string number(std::size_t i)
{
    return std::to_string(i);
}

//! A place on a side of a chart: how far along, from corner s, and where.
struct SidePoint {
    double at;
    Vec3 position;
};

//! The side of the unit square on which both points lie, or 4.
int common_side(const Vec2& a, const Vec2& b)
{
    if (a.y == 0.0 && b.y == 0.0)
        return 0;
    if (a.x == 1.0 && b.x == 1.0)
        return 1;
    if (a.y == 1.0 && b.y == 1.0)
        return 2;
    if (a.x == 0.0 && b.x == 0.0)
        return 3;
    return 4;
}

double along_side(int side, const Vec2& uv)
{
    switch (side) {
    case 0: return uv.x;
    case 1: return uv.y;
    case 2: return 1.0 - uv.x;
    default: return 1.0 - uv.y;
    }
}

//! The border of a chart by side, each sorted; empty when the border does not follow the square.
using Sides = std::array<std::vector<SidePoint>, 4>;

bool read_sides(const QuadChart& chart, Sides& sides)
{
    // Directed edges without a twin are the border.
    std::vector<std::pair<Index, Index>> edges;
    for (const auto& t : chart.triangles)
        for (int k = 0; k < 3; ++k)
            edges.emplace_back(t[k], t[(k + 1) % 3]);
    std::sort(edges.begin(), edges.end());
    std::array<std::vector<Index>, 4> on_side;
    for (const auto& [a, b] : edges) {
        if (std::binary_search(edges.begin(), edges.end(), std::make_pair(b, a)))
            continue;
        const int side = common_side(chart.vertices[a].uv, chart.vertices[b].uv);
        if (side == 4)
            return false;
        on_side[side].push_back(a);
        on_side[side].push_back(b);
    }
    for (int side = 0; side < 4; ++side) {
        auto& list = on_side[side];
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
        for (const Index v : list)
            sides[side].push_back(
                {along_side(side, chart.vertices[v].uv), chart.vertices[v].position});
        std::stable_sort(sides[side].begin(), sides[side].end(),
                         [](const SidePoint& a, const SidePoint& b) { return a.at < b.at; });
        if (sides[side].empty() || sides[side].front().at != 0.0 || sides[side].back().at != 1.0)
            return false;
    }
    return true;
}

//! Largest distance of the points of one side from the other side, which runs the other way.
double side_distance(const std::vector<SidePoint>& points, const std::vector<SidePoint>& other)
{
    double worst = 0.0;
    for (const SidePoint& p : points) {
        const double at = 1.0 - p.at;
        auto high = std::lower_bound(other.begin(), other.end(), at,
                                     [](const SidePoint& q, double x) { return q.at < x; });
        if (high == other.end())
            --high;
        const auto low = high == other.begin() ? high : high - 1;
        const double width = high->at - low->at;
        const double t = width > 0.0 ? (at - low->at) / width : 0.0;
        worst = std::max(worst, norm((1.0 - t) * low->position + t * high->position - p.position));
    }
    return worst;
}

//! Ratio of the singular values of the affine map of a triangle; infinite when it has no area.
double stretch(const QuadChart& chart, const std::array<Index, 3>& t)
{
    const Vec2 &a = chart.vertices[t[0]].uv, &b = chart.vertices[t[1]].uv,
               &c = chart.vertices[t[2]].uv;
    const Vec3 p = chart.vertices[t[1]].position - chart.vertices[t[0]].position;
    const Vec3 q = chart.vertices[t[2]].position - chart.vertices[t[0]].position;
    const double d = cross(b - a, c - a);
    const Vec3 du = ((c.y - a.y) * p - (b.y - a.y) * q) / d;
    const Vec3 dv = ((b.x - a.x) * q - (c.x - a.x) * p) / d;
    const double half = 0.5 * (norm_squared(du) + norm_squared(dv));
    const double area = norm(cross(du, dv));
    if (!(area > 0.0))
        return std::numeric_limits<double>::infinity();
    // Eigenvalues of the metric are half +- sqrt(half^2 - area^2), of product area^2.
    return (half + std::sqrt(std::max(0.0, half * half - area * area))) / area;
}

//! Sums up the distortion of one chart whose triangles all have area in parameters.
void measure(const QuadChart& chart, Index quad, ChartStatistics& statistics, double& mean_sum)
{
    double area = 0.0, weighted = 0.0;
    double low = std::numeric_limits<double>::infinity(), high = 0.0;
    for (const auto& t : chart.triangles) {
        const Vec3& p = chart.vertices[t[0]].position;
        const double part =
            0.5 * norm(cross(chart.vertices[t[1]].position - p, chart.vertices[t[2]].position - p));
        const Vec2& a = chart.vertices[t[0]].uv;
        const double jacobian =
            2.0 * part / cross(chart.vertices[t[1]].uv - a, chart.vertices[t[2]].uv - a);
        area += part;
        low = std::min(low, jacobian);
        high = std::max(high, jacobian);
        if (part > 0.0)
            weighted += part * stretch(chart, t);
    }
    const double mean = area > 0.0 ? weighted / area : 1.0;
    mean_sum += mean;
    if (quad == 0 || mean > statistics.max_stretch) {
        statistics.max_stretch = mean;
        statistics.worst_quad = quad;
    }
    const auto lower = [quad](double& into, double x) { into = quad == 0 ? x : std::min(into, x); };
    lower(statistics.min_jacobian, area > 0.0 ? low / area : 0.0);
    lower(statistics.min_area, area);
    statistics.max_jacobian = std::max(statistics.max_jacobian, area > 0.0 ? high / area : 0.0);
    statistics.max_area = std::max(statistics.max_area, area);
}

void check_chart_source(const ManifoldMesh& source, const QuadChart& chart, Index quad,
                        double tolerance, DefectList& defects)
{
    for (std::size_t t = 0; t < chart.triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const auto& bary = chart.bary[t][k];
            const bool inside = bary[0] >= 0.0 && bary[1] >= 0.0 && bary[2] >= 0.0;
            const Vec3 place = source.at({chart.source_face[t], bary});
            if (inside && norm(place - chart.vertices[chart.triangles[t][k]].position) <= tolerance)
                continue;
            defects.add("chart_source",
                        "triangle " + number(t) + " of the chart of quad " + number(quad) +
                            " does not lie where its places on source face " +
                            number(chart.source_face[t]) + " are",
                        quad);
            return;
        }
}

//! Whether all triangles are positively oriented, decided exactly.
bool check_chart_fold(const QuadChart& chart, Index quad, DefectList& defects)
{
    for (std::size_t t = 0; t < chart.triangles.size(); ++t) {
        const auto& v = chart.triangles[t];
        if (orient2d(chart.vertices[v[0]].uv, chart.vertices[v[1]].uv, chart.vertices[v[2]].uv) > 0)
            continue;
        defects.add("chart_fold",
                    "triangle " + number(t) + " of the chart of quad " + number(quad) +
                        " has no area in parameters or is turned over",
                    quad);
        return false;
    }
    return true;
}

} // namespace

std::vector<DomainDefect> check_charts(const ManifoldMesh& source, const QuadComplex& complex,
                                       const std::vector<QuadChart>& charts,
                                       ChartStatistics& statistics)
{
    DefectList defects;
    statistics = {};
    const double tolerance = same_place * source.box().diagonal();
    std::vector<Sides> sides(charts.size());
    std::vector<char> good(charts.size(), 0);
    double mean_sum = 0.0;
    for (Index q = 0; q < charts.size(); ++q) {
        const QuadChart& chart = charts[q];
        check_chart_source(source, chart, q, tolerance, defects);
        if (!check_chart_fold(chart, q, defects))
            continue;
        double area = 0.0;
        for (const auto& t : chart.triangles) {
            const Vec2& a = chart.vertices[t[0]].uv;
            area += 0.5 * cross(chart.vertices[t[1]].uv - a, chart.vertices[t[2]].uv - a);
        }
        // Positive triangles whose border goes once around the square cover it once.
        good[q] = read_sides(chart, sides[q]) && std::fabs(area - 1.0) <= area_slack;
        if (!good[q])
            defects.add("chart_side",
                        "the border of the chart of quad " + number(q) +
                            " is not that of the unit square",
                        q);
        measure(chart, q, statistics, mean_sum);
    }
    if (!charts.empty())
        statistics.mean_stretch = mean_sum / double(charts.size());
    for (Index e = 0; e < complex.edge_count(); ++e) {
        const Index h = complex.halfedge_of_edge(e), twin = complex.twin(h);
        if (twin == invalid_index)
            continue;
        const Index q = QuadComplex::quad_of(h), r = QuadComplex::quad_of(twin);
        if (!good[q] || !good[r])
            continue;
        const auto& ours = sides[q][QuadComplex::side_of(h)];
        const auto& theirs = sides[r][QuadComplex::side_of(twin)];
        if (!(std::max(side_distance(ours, theirs), side_distance(theirs, ours)) <= tolerance))
            defects.add("chart_continuity",
                        "the charts of quads " + number(q) + " and " + number(r) +
                            " do not agree along edge " + number(e),
                        e);
    }
    return defects.defects();
}

} // namespace bot2nurbs
