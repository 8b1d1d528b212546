// SPDX-License-Identifier: MIT
#include "layout/curve_line.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace bot2nurbs {

CurveLine::CurveLine(const ManifoldMesh& mesh, std::vector<Index> chain, bool is_boundary)
    : vertices(std::move(chain)), boundary(is_boundary)
{
    arc.push_back(0.0);
    for (std::size_t i = 1; i < vertices.size(); ++i)
        arc.push_back(arc.back() +
                      norm(mesh.position(vertices[i]) - mesh.position(vertices[i - 1])));
}

Vec3 CurveLine::at(const ManifoldMesh& mesh, double s) const
{
    if (closed()) {
        s = std::fmod(s, length());
        if (s < 0.0)
            s += length();
    }
    s = std::clamp(s, 0.0, length());
    auto next = std::upper_bound(arc.begin(), arc.end(), s);
    if (next == arc.end())
        --next;
    const std::size_t i = static_cast<std::size_t>(next - arc.begin());
    const double step = arc[i] - arc[i - 1];
    const double t = step > 0.0 ? (s - arc[i - 1]) / step : 0.0;
    return (1.0 - t) * mesh.position(vertices[i - 1]) + t * mesh.position(vertices[i]);
}

double CurveLine::closest(const ManifoldMesh& mesh, const Vec3& p) const
{
    double best = 0.0, least = INFINITY;
    for (std::size_t i = 1; i < vertices.size(); ++i) {
        const Vec3 a = mesh.position(vertices[i - 1]), d = mesh.position(vertices[i]) - a;
        const double square = norm_squared(d);
        const double t = square > 0.0 ? std::clamp(dot(p - a, d) / square, 0.0, 1.0) : 0.0;
        const double distance = norm_squared(a + t * d - p);
        if (distance < least) {
            least = distance;
            best = (1.0 - t) * arc[i - 1] + t * arc[i];
        }
    }
    return best;
}

std::vector<std::vector<Index>> lines_on_carrier(const std::vector<CurveLine>& lines,
                                                 const ManifoldMesh& source,
                                                 const CarrierMesh& carrier)
{
    // Carrier vertices inside source edges, each with its weight at the edge's larger end.
    std::map<std::pair<Index, Index>, std::vector<std::pair<double, Index>>> inside;
    for (const CurveLine& line : lines)
        for (std::size_t i = 0; i + 1 < line.vertices.size(); ++i)
            inside[std::minmax(line.vertices[i], line.vertices[i + 1])];
    for (Index v = source.vertex_count(); v < carrier.mesh.vertex_count(); ++v) {
        const SourcePoint& p = carrier.vertex_source[v];
        for (int k = 0; k < 3; ++k) {
            if (p.bary[k] != 0.0)
                continue;
            Index low = source.triangle(p.face)[(k + 1) % 3];
            Index high = source.triangle(p.face)[(k + 2) % 3];
            double weight = p.bary[(k + 2) % 3];
            if (low > high) {
                std::swap(low, high);
                weight = p.bary[(k + 1) % 3];
            }
            const auto edge = inside.find({low, high});
            if (edge != inside.end())
                edge->second.emplace_back(weight, v);
        }
    }
    for (auto& edge : inside)
        std::sort(edge.second.begin(), edge.second.end());
    std::vector<std::vector<Index>> chains(lines.size());
    for (std::size_t l = 0; l < lines.size(); ++l) {
        const std::vector<Index>& line = lines[l].vertices;
        chains[l].push_back(line.front());
        for (std::size_t i = 0; i + 1 < line.size(); ++i) {
            const auto& between = inside[std::minmax(line[i], line[i + 1])];
            if (line[i] < line[i + 1])
                for (auto v = between.begin(); v != between.end(); ++v)
                    chains[l].push_back(v->second);
            else
                for (auto v = between.rbegin(); v != between.rend(); ++v)
                    chains[l].push_back(v->second);
            chains[l].push_back(line[i + 1]);
        }
    }
    return chains;
}

} // namespace bot2nurbs
