// SPDX-License-Identifier: MIT
#include "bot2nurbs/closest_point.h"

#include "core/parallel.h"
#include "mesh/box_tree.h"
#include "mesh/closest_on_triangle.h"

#include <algorithm>

namespace bot2nurbs {

namespace {

// Boxes up to this much farther than the best point are still entered: rounding of the two
// distances must not hide an equally close triangle.
constexpr double prune_slack = 1.0 + 1e-12;

// Bound of the stack of open nodes: 28 levels by area, then halving of at most 2^32 items.
constexpr int stack_size = 64;
constexpr std::size_t chunk_triangles = 16384;

struct Triangle : TriangleCorners {
    Index face = invalid_index;
};

//! Makes the triangle's closest point the hit if it is closer than `best`, or as close and its face
//! comes first.
void offer(const Vec3& p, const Triangle& t, double& best, ClosestPoint::Hit& hit)
{
    const std::array<double, 3> bary = closest_on_triangle(p, t);
    const Vec3 q = t.at(bary);
    const double d = norm_squared(q - p);
    if (d < best || (d == best && t.face < hit.where.face)) {
        best = d;
        hit.where = {t.face, bary};
        hit.position = q;
    }
}

double box_distance_squared(const BoxTree::Node& box, const Vec3& p)
{
    const double x = std::max(0.0, std::max(box.min.x - p.x, p.x - box.max.x));
    const double y = std::max(0.0, std::max(box.min.y - p.y, p.y - box.max.y));
    const double z = std::max(0.0, std::max(box.min.z - p.z, p.z - box.max.z));
    return x * x + y * y + z * z;
}

} // namespace

struct ClosestPoint::Tree {
    BoxTree boxes;
    std::vector<Triangle> triangles; //!< In the order of boxes.items().
};

ClosestPoint::ClosestPoint(const ManifoldMesh& mesh, const Context* context)
    : ClosestPoint(mesh.positions(), mesh.triangles(), context)
{
}

ClosestPoint::ClosestPoint(const std::vector<Vec3>& positions,
                           const std::vector<std::array<Index, 3>>& triangles,
                           const Context* context)
{
    Context alone;
    alone.threads = 1;
    const Context& how = context ? *context : alone;
    std::vector<Box3> boxes(triangles.size());
    for_each_chunk(how, triangles.size(), chunk_triangles, [&](std::size_t begin, std::size_t end) {
        for (std::size_t f = begin; f < end; ++f)
            for (const Index v : triangles[f])
                boxes[f].add(positions[v]);
    });
    auto tree = std::make_shared<Tree>();
    tree->boxes = BoxTree(boxes, context);
    const std::vector<Index>& items = tree->boxes.items();
    tree->triangles.resize(items.size());
    for_each_chunk(how, items.size(), chunk_triangles, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const auto& t = triangles[items[i]];
            tree->triangles[i] = {{positions[t[0]], positions[t[1]], positions[t[2]]}, items[i]};
        }
    });
    tree_ = std::move(tree);
}

ClosestPoint::Hit ClosestPoint::query(const Vec3& p) const
{
    return query(p, INFINITY);
}

ClosestPoint::Hit ClosestPoint::query(const Vec3& p, double distance_limit) const
{
    return search(p, distance_limit, [](const Triangle&) { return true; });
}

ClosestPoint::Hit ClosestPoint::query_facing(const Vec3& p, const Vec3& direction) const
{
    return search(p, INFINITY, [&direction](const Triangle& t) {
        return dot(cross(t.b - t.a, t.c - t.a), direction) > 0.0;
    });
}

template <class Accept> ClosestPoint::Hit ClosestPoint::search(const Vec3& p, double distance_limit,
                                                               const Accept& accept) const
{
    Hit hit;
    hit.distance = INFINITY;
    const auto& nodes = tree_->boxes.nodes();
    double best = distance_limit * distance_limit;
    if (nodes.empty() || !(distance_limit >= 0.0))
        return hit;
    struct Open {
        Index node;
        double distance;
    };
    Open stack[stack_size];
    int depth = 0;
    stack[depth++] = {0, box_distance_squared(nodes[0], p)};
    while (depth > 0) {
        const Open open = stack[--depth];
        if (open.distance > best * prune_slack)
            continue;
        const BoxTree::Node& node = nodes[open.node];
        if (node.count == 0) {
            Open near{node.first, box_distance_squared(nodes[node.first], p)};
            Open far{node.first + 1, box_distance_squared(nodes[node.first + 1], p)};
            if (far.distance < near.distance)
                std::swap(near, far);
            if (far.distance <= best * prune_slack)
                stack[depth++] = far;
            if (near.distance <= best * prune_slack)
                stack[depth++] = near;
            continue;
        }
        for (Index i = node.first; i < node.first + node.count; ++i)
            if (accept(tree_->triangles[i]))
                offer(p, tree_->triangles[i], best, hit);
    }
    if (hit.where.face != invalid_index)
        hit.distance = std::sqrt(best);
    return hit;
}

std::vector<Index> ClosestPoint::faces_near(const Vec3& p, double distance) const
{
    std::vector<Index> faces, open;
    const auto& nodes = tree_->boxes.nodes();
    const double limit = distance * distance * prune_slack;
    if (!nodes.empty())
        open.push_back(0);
    while (!open.empty()) {
        const BoxTree::Node& node = nodes[open.back()];
        open.pop_back();
        if (!(box_distance_squared(node, p) <= limit))
            continue;
        if (node.count == 0) {
            open.push_back(node.first);
            open.push_back(node.first + 1);
        }
        for (Index i = node.first; i < node.first + node.count; ++i)
            faces.push_back(tree_->triangles[i].face);
    }
    return faces;
}

} // namespace bot2nurbs
