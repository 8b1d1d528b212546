// SPDX-License-Identifier: MIT
#include "cloud/surface_coverage.h"

#include "cloud/point_tree.h"
#include "core/disjoint_sets.h"
#include "core/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

namespace bot2nurbs {

namespace {

//! A place farther than this from all points lies in a hole: points scattered evenly leave a disk
//! of so many spacings' radius empty with a chance of 2.5e-7.
constexpr double hole_spacings = 2.2;
//! A hole reaches out to where the points begin. Beside a hole a place so far from them is beyond
//! the last ones, with a chance of 1e-3 to be wrong, and then by one gap between points.
constexpr double rim_spacings = 1.5;
//! Distance that noise explains, in standard deviations.
constexpr double noise_deviations = 3.0;
//! How near to the end of its edge a cut may come, as a share of the edge: triangles stay fat.
constexpr double least_share = 0.1;
//! Clouds of which one has a wider gap than chance_gap(), and fixed-point steps to find it: each
//! divides the error by more than ten.
constexpr double clouds_a_gap = 100.0;
constexpr int gap_iterations = 16;
constexpr std::size_t places_per_chunk = 512;

//! Per vertex the number of its component, in order of first vertices, and how many there are.
Index number_components(const TriangleSoup& mesh, std::vector<Index>& component)
{
    DisjointSets sets(mesh.positions.size());
    for (const auto& t : mesh.triangles) {
        sets.join(t[0], t[1]);
        sets.join(t[0], t[2]);
    }
    component.resize(mesh.positions.size());
    Index count = 0;
    for (Index v = 0; v < component.size(); ++v) {
        const Index root = sets.find(v);
        component[v] = root == v ? count++ : component[root]; // the root is the smallest member
    }
    return count;
}

double triangle_area(const TriangleSoup& mesh, const std::array<Index, 3>& t)
{
    const Vec3& a = mesh.positions[t[0]];
    return 0.5 * norm(cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a));
}

//! Keeps the triangles and the vertices they use.
TriangleSoup compacted(const std::vector<Vec3>& positions,
                       const std::vector<std::array<Index, 3>>& triangles)
{
    TriangleSoup result;
    std::vector<Index> number(positions.size(), invalid_index);
    std::vector<char> used(positions.size(), 0);
    for (const auto& t : triangles)
        for (const Index v : t)
            used[v] = 1;
    for (Index v = 0; v < positions.size(); ++v)
        if (used[v]) {
            number[v] = static_cast<Index>(result.positions.size());
            result.positions.push_back(positions[v]);
        }
    for (const auto& t : triangles) {
        result.source_face.push_back(static_cast<Index>(result.triangles.size()));
        result.triangles.push_back({number[t[0]], number[t[1]], number[t[2]]});
    }
    return result;
}

} // namespace

Result<SurfaceCoverage> measure_coverage(const TriangleSoup& mesh, const std::vector<Vec3>& points,
                                         const SurfaceEstimate& estimate, Context& context)
{
    std::vector<Vec3> kept;
    std::vector<Index> number;
    for (Index i = 0; i < points.size(); ++i)
        if (!estimate.outlier[i]) {
            kept.push_back(points[i]);
            number.push_back(i);
        }
    const Result<PointTree> tree = PointTree::build(kept, context);
    const Result<PointTree> vertices = PointTree::build(mesh.positions, context);
    if (!tree || !vertices)
        return Context::cancelled_error("reconstruction");

    SurfaceCoverage coverage;
    const std::size_t n = mesh.positions.size();
    coverage.spacings.resize(n);
    coverage.distance.resize(n);
    coverage.vertex_area.assign(n, 0.0);
    const Index components = number_components(mesh, coverage.component);
    for_each_chunk(context, n, places_per_chunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
            const PointTree::Neighbor nearest = tree->nearest(mesh.positions[v]);
            const double spacing = estimate.spacing[number[nearest.point]];
            coverage.distance[v] = std::sqrt(nearest.distance2);
            const double away = coverage.distance[v] - noise_deviations * estimate.noise;
            coverage.spacings[v] = away > 0.0 && spacing > 0.0 ? away / spacing : 0.0;
        }
    });
    std::vector<Index> nearest_component(kept.size());
    if (!for_each_chunk(
            context, kept.size(), places_per_chunk, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i)
                    nearest_component[i] = coverage.component[vertices->nearest(kept[i]).point];
            }))
        return Context::cancelled_error("reconstruction");
    coverage.points.assign(components, 0);
    coverage.area.assign(components, 0.0);
    coverage.uncovered.assign(components, 0.0);
    for (const Index c : nearest_component)
        ++coverage.points[c];
    for (const auto& t : mesh.triangles) {
        const double third = triangle_area(mesh, t) / 3.0;
        for (const Index v : t) {
            coverage.vertex_area[v] += third;
            coverage.area[coverage.component[v]] += third;
            if (coverage.spacings[v] > hole_spacings)
                coverage.uncovered[coverage.component[v]] += third;
        }
    }
    return coverage;
}

TriangleSoup without_components(const TriangleSoup& mesh, const std::vector<Index>& component,
                                const std::vector<char>& drop)
{
    std::vector<std::array<Index, 3>> kept;
    for (const auto& t : mesh.triangles)
        if (!drop[component[t[0]]])
            kept.push_back(t);
    return compacted(mesh.positions, kept);
}

SurfaceHoles find_holes(const TriangleSoup& mesh, const SurfaceCoverage& coverage)
{
    DisjointSets sets(mesh.positions.size());
    const auto bare = [&](Index v) { return coverage.spacings[v] > rim_spacings; };
    for (const auto& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k)
            if (bare(t[k]) && bare(t[(k + 1) % 3]))
                sets.join(t[k], t[(k + 1) % 3]);
    // Of the bare places those are holes that reach far enough from the points.
    std::vector<char> hole(mesh.positions.size(), 0);
    for (Index v = 0; v < mesh.positions.size(); ++v)
        if (coverage.spacings[v] > hole_spacings)
            hole[sets.find(v)] = 1;
    SurfaceHoles result;
    result.of_vertex.assign(mesh.positions.size(), invalid_index);
    for (Index v = 0; v < mesh.positions.size(); ++v) {
        const Index root = sets.find(v); // the smallest member
        if (hole[root] == 0)
            continue;
        if (root == v) {
            result.of_vertex[v] = static_cast<Index>(result.holes.size());
            result.holes.emplace_back();
        }
        result.of_vertex[v] = result.of_vertex[root];
        CloudHole& found = result.holes[result.of_vertex[v]];
        found.area += coverage.vertex_area[v];
        if (2.0 * coverage.distance[v] > found.size) {
            found.size = 2.0 * coverage.distance[v];
            found.place = mesh.positions[v];
        }
        found.spacings = std::max(found.spacings, 2.0 * coverage.spacings[v]);
    }
    return result;
}

double chance_gap(std::size_t points)
{
    constexpr double pi = 3.14159265358979323846;
    const double start = std::log(2.0 * double(points) * clouds_a_gap);
    double x = start;
    for (int i = 0; i < gap_iterations; ++i)
        x = start + std::log1p(x);
    return 2.0 * std::sqrt(x / pi);
}

TriangleSoup cut_out(const TriangleSoup& mesh, const SurfaceCoverage& coverage,
                     const SurfaceHoles& holes, const std::vector<char>& cut)
{
    const auto away = [&](Index v) {
        return holes.of_vertex[v] != invalid_index && cut[holes.of_vertex[v]] != 0;
    };
    std::vector<Vec3> positions = mesh.positions;
    std::vector<std::array<Index, 3>> triangles;
    std::map<std::array<Index, 2>, Index> cuts; // per edge across the line: its new vertex
    const auto vertex_between = [&](Index in, Index out) {
        const auto [at, added] = cuts.try_emplace({std::min(in, out), std::max(in, out)},
                                                  static_cast<Index>(positions.size()));
        if (added) {
            const double a = coverage.spacings[in], b = coverage.spacings[out];
            const double t =
                std::clamp((rim_spacings - a) / (b - a), least_share, 1.0 - least_share);
            positions.push_back((1.0 - t) * mesh.positions[in] + t * mesh.positions[out]);
        }
        return at->second;
    };
    for (const auto& t : mesh.triangles) {
        const int gone = int(away(t[0])) + int(away(t[1])) + int(away(t[2]));
        if (gone == 0) {
            triangles.push_back(t);
            continue;
        }
        if (gone == 3)
            continue;
        // Turned so that the corner that is alone comes first.
        std::size_t k = 0;
        while (away(t[k]) != (gone == 1))
            ++k;
        const Index a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3];
        if (gone == 1) {
            const Index ab = vertex_between(b, a), ac = vertex_between(c, a);
            triangles.push_back({ab, b, c});
            triangles.push_back({ab, c, ac});
        } else {
            triangles.push_back({a, vertex_between(a, b), vertex_between(a, c)});
        }
    }
    return compacted(positions, triangles);
}

Index count_components(const TriangleSoup& mesh)
{
    std::vector<Index> component;
    return number_components(mesh, component);
}

int genus_of(const TriangleSoup& mesh)
{
    std::vector<Index> component;
    const Index components = number_components(mesh, component);
    // Edges with one triangle, by their ends; a boundary vertex has two.
    std::set<std::array<Index, 2>> once;
    for (const auto& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const Index a = t[k], b = t[(k + 1) % 3];
            if (once.erase({b, a}) == 0)
                once.insert({a, b});
        }
    DisjointSets loops(mesh.positions.size());
    long count = 0;
    for (const auto& [a, b] : once)
        if (loops.find(a) == loops.find(b))
            ++count; // this edge closes a loop
        else
            loops.join(a, b);
    const long corners = 3 * static_cast<long>(mesh.triangles.size());
    const long edges = (corners + static_cast<long>(once.size())) / 2;
    const long euler = static_cast<long>(mesh.positions.size()) - edges +
                       static_cast<long>(mesh.triangles.size()) + count;
    return static_cast<int>(components) - static_cast<int>(euler / 2);
}

} // namespace bot2nurbs
