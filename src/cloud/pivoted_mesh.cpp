// SPDX-License-Identifier: MIT
#include "cloud/pivoted_mesh.h"

#include "cloud/halfedge_key.h"
#include "cloud/loop_triangles.h"
#include "core/disjoint_sets.h"

#include <unordered_map>
#include <unordered_set>

namespace bot2nurbs {

namespace {

constexpr std::size_t most_loop_edges = 200;

std::unordered_set<std::uint64_t> halfedges_of(const TriangleSoup& mesh)
{
    std::unordered_set<std::uint64_t> halfedges;
    for (const auto& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k)
            halfedges.insert(halfedge_key(t[k], t[(k + 1) % 3]));
    return halfedges;
}

//! The boundary loops, each in the order in which triangles that fill it run around: against that
//! of the triangles beside it.
std::vector<std::vector<Index>> find_loops(const TriangleSoup& mesh,
                                           const std::unordered_set<std::uint64_t>& halfedges)
{
    std::vector<Index> next(mesh.positions.size(), invalid_index);
    for (const auto& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k)
            if (halfedges.count(halfedge_key(t[(k + 1) % 3], t[k])) == 0)
                next[t[(k + 1) % 3]] = t[k];
    std::vector<std::vector<Index>> loops;
    for (Index v = 0; v < next.size(); ++v) {
        if (next[v] == invalid_index)
            continue;
        std::vector<Index>& loop = loops.emplace_back();
        for (Index at = v; next[at] != invalid_index;) {
            loop.push_back(at);
            const Index to = next[at];
            next[at] = invalid_index;
            at = to;
        }
    }
    return loops;
}

CloudHole measure(const TriangleSoup& mesh, const std::vector<Index>& loop)
{
    Box3 box;
    double length = 0.0;
    Vec3 sum;
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const Vec3& p = mesh.positions[loop[i]];
        box.add(p);
        sum += p;
        length += norm(mesh.positions[loop[(i + 1) % loop.size()]] - p);
    }
    CloudHole hole;
    hole.place = (1.0 / double(loop.size())) * sum;
    hole.size = box.diagonal();
    hole.spacings = length > 0.0 ? hole.size * double(loop.size()) / length : 0.0;
    return hole;
}

} // namespace

TriangleSoup mesh_of_fans(const std::vector<Vec3>& points,
                          const std::vector<std::array<Index, 3>>& triangles)
{
    // Corners of triangles on both sides of an edge belong to one fan.
    DisjointSets fans(3 * triangles.size());
    std::unordered_map<std::uint64_t, std::size_t> corner_of; // per halfedge, of its start
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k)
            corner_of.emplace(halfedge_key(triangles[t][k], triangles[t][(k + 1) % 3]), 3 * t + k);
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t next = (k + 1) % 3;
            const auto twin = corner_of.find(halfedge_key(triangles[t][next], triangles[t][k]));
            if (twin == corner_of.end())
                continue;
            const std::size_t other = twin->second, triangle = other / 3;
            fans.join(static_cast<Index>(3 * t + next), static_cast<Index>(other));
            fans.join(static_cast<Index>(3 * t + k),
                      static_cast<Index>(3 * triangle + (other % 3 + 1) % 3));
        }
    TriangleSoup mesh;
    std::vector<Index> number(3 * triangles.size(), invalid_index);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        std::array<Index, 3> corners{};
        for (std::size_t k = 0; k < 3; ++k) {
            const Index fan = fans.find(static_cast<Index>(3 * t + k));
            if (number[fan] == invalid_index) {
                number[fan] = static_cast<Index>(mesh.positions.size());
                mesh.positions.push_back(points[triangles[t][k]]);
            }
            corners[k] = number[fan];
        }
        mesh.source_face.push_back(static_cast<Index>(t));
        mesh.triangles.push_back(corners);
    }
    return mesh;
}

std::vector<CloudHole> fill_loops(TriangleSoup& mesh,
                                  const std::function<bool(const CloudHole&)>& may_fill)
{
    std::unordered_set<std::uint64_t> halfedges = halfedges_of(mesh);
    std::vector<CloudHole> holes;
    LoopTriangles triangulate;
    for (const std::vector<Index>& loop : find_loops(mesh, halfedges)) {
        CloudHole& hole = holes.emplace_back(measure(mesh, loop));
        if (loop.size() > most_loop_edges || !may_fill(hole))
            continue;
        std::vector<Vec3> polygon;
        for (const Index v : loop)
            polygon.push_back(mesh.positions[v]);
        const auto there = [&](int i, int j) {
            const Index a = loop[static_cast<std::size_t>(i)],
                        b = loop[static_cast<std::size_t>(j)];
            return halfedges.count(halfedge_key(a, b)) + halfedges.count(halfedge_key(b, a)) > 0;
        };
        for (const auto& corners : triangulate.find(polygon, there)) {
            std::array<Index, 3> t{};
            for (std::size_t k = 0; k < 3; ++k)
                t[k] = loop[static_cast<std::size_t>(corners[k])];
            for (std::size_t k = 0; k < 3; ++k)
                halfedges.insert(halfedge_key(t[k], t[(k + 1) % 3]));
            hole.area += 0.5 * norm(cross(mesh.positions[t[1]] - mesh.positions[t[0]],
                                          mesh.positions[t[2]] - mesh.positions[t[0]]));
            mesh.source_face.push_back(static_cast<Index>(mesh.triangles.size()));
            mesh.triangles.push_back(t);
            hole.filled = true;
        }
    }
    return holes;
}

} // namespace bot2nurbs
