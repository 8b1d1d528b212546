// SPDX-License-Identifier: MIT
#include "domain/chart_locator.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bot2nurbs {

namespace {

//! Bins a direction: more would cost memory per chart and gain nothing.
constexpr double max_bins = 512.0;
//! A point this far outside a triangle, in barycentric weight, still counts as found in it: far
//! above the rounding of the weights (1e-16 times the aspect of usual triangles), far below any
//! length in a chart.
constexpr double inside_slack = 1e-9;
//! Triangles are entered into bins this much beyond their border, so that the point on a border is
//! found from both sides.
constexpr double bin_slack = 1e-9;

//! Runs use(row, column_low, column_high) over the bins a triangle touches, row by row clipped to
//! the triangle so that long slanted triangles enter few bins.
template <class Use> void for_each_row(const std::array<Vec2, 3>& p, Index bins, const Use& use)
{
    const auto bin = [bins](double x) {
        return static_cast<Index>(std::clamp(x * bins, 0.0, bins - 1.0));
    };
    const double low = std::min({p[0].y, p[1].y, p[2].y}) - bin_slack;
    const double high = std::max({p[0].y, p[1].y, p[2].y}) + bin_slack;
    for (Index row = bin(low); row <= bin(high); ++row) {
        const double bottom = double(row) / bins - bin_slack;
        const double top = double(row + 1) / bins + bin_slack;
        double left = std::numeric_limits<double>::infinity(), right = -left;
        const auto add = [&](double x) {
            left = std::min(left, x);
            right = std::max(right, x);
        };
        for (int k = 0; k < 3; ++k) {
            const Vec2 &a = p[k], &b = p[(k + 1) % 3];
            if (bottom <= a.y && a.y <= top)
                add(a.x);
            for (const double y : {bottom, top})
                if ((a.y < y && y < b.y) || (b.y < y && y < a.y))
                    add(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x));
        }
        // The strips of a rounded border may miss a triangle by a hair: then it enters no bin of
        // this row, and its neighbours do.
        if (left <= right)
            use(row, bin(left - bin_slack), bin(right + bin_slack));
    }
}

std::array<Vec2, 3> corners(const QuadChart& chart, Index t)
{
    const auto& v = chart.triangles[t];
    return {chart.vertices[v[0]].uv, chart.vertices[v[1]].uv, chart.vertices[v[2]].uv};
}

} // namespace

ChartLocator::ChartLocator(const QuadChart& chart) : chart_(chart)
{
    const Index count = static_cast<Index>(chart.triangles.size());
    bins_ = static_cast<Index>(std::clamp(std::ceil(std::sqrt(count / 2.0)), 1.0, max_bins));
    first_.assign(std::size_t{bins_} * bins_ + 1, 0);
    for (Index t = 0; t < count; ++t)
        for_each_row(corners(chart, t), bins_, [&](Index row, Index low, Index high) {
            for (Index column = low; column <= high; ++column)
                ++first_[std::size_t{row} * bins_ + column + 1];
        });
    for (std::size_t b = 1; b < first_.size(); ++b)
        first_[b] += first_[b - 1];
    triangles_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (Index t = 0; t < count; ++t)
        for_each_row(corners(chart, t), bins_, [&](Index row, Index low, Index high) {
            for (Index column = low; column <= high; ++column)
                triangles_[next[std::size_t{row} * bins_ + column]++] = t;
        });
}

ChartLocator::Hit ChartLocator::locate(const Vec2& uv) const
{
    Hit best;
    double depth = -std::numeric_limits<double>::infinity();
    const auto test = [&](Index t) {
        const auto p = corners(chart_, t);
        const double area = cross(p[1] - p[0], p[2] - p[0]);
        if (!(area > 0.0))
            return;
        const std::array<double, 3> w{cross(p[1] - uv, p[2] - uv) / area,
                                      cross(p[2] - uv, p[0] - uv) / area,
                                      cross(p[0] - uv, p[1] - uv) / area};
        const double least = std::min({w[0], w[1], w[2]});
        if (least > depth) {
            depth = least;
            best = {t, w};
        }
    };
    const auto bin = [this](double x) {
        return static_cast<std::size_t>(std::clamp(x * bins_, 0.0, bins_ - 1.0));
    };
    const std::size_t b = bin(uv.y) * bins_ + bin(uv.x);
    for (std::size_t i = first_[b]; i < first_[b + 1]; ++i)
        test(triangles_[i]);
    if (!(depth >= -inside_slack)) {
        for (Index t = 0; t < chart_.triangles.size(); ++t)
            test(t);
    }
    if (best.triangle == invalid_index) { // No triangle has an area: any answer is as good.
        best = {0, {1.0, 0.0, 0.0}};
        return best;
    }
    double sum = 0.0;
    for (double& w : best.weights) {
        w = std::max(w, 0.0);
        sum += w;
    }
    for (double& w : best.weights)
        w /= sum;
    return best;
}

SourcePoint source_point(const QuadChart& chart, const ChartLocator::Hit& hit)
{
    SourcePoint point;
    point.face = chart.source_face[hit.triangle];
    double sum = 0.0;
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k)
            point.bary[i] += hit.weights[k] * chart.bary[hit.triangle][k][i];
        point.bary[i] = std::max(point.bary[i], 0.0);
        sum += point.bary[i];
    }
    for (double& w : point.bary)
        w /= sum;
    return point;
}

} // namespace bot2nurbs
