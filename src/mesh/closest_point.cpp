// SPDX-License-Identifier: MIT
#include "bot2nurbs/closest_point.h"

#include "mesh/box_tree.h"

#include <algorithm>

namespace bot2nurbs {

namespace {

// Sine of an angle below which a triangle counts as thin. The case distinction by barycentric
// signs loses about eps / sine^2 of the triangle's size, so here at most 1e-8; thin triangles are
// compared side by side instead, which loses nothing.
constexpr double thin_sine = 1e-4;

// Boxes up to this much farther than the best point are still entered: rounding of the two
// distances must not hide an equally close triangle.
constexpr double prune_slack = 1.0 + 1e-12;

// Bound of the stack of open nodes: 28 levels by area, then halving of at most 2^32 items.
constexpr int stack_size = 64;

struct Corners {
    Vec3 a, b, c;
    Index face;
    bool thin;
};

double segment_parameter(const Vec3& p, const Vec3& a, const Vec3& b)
{
    const Vec3 d = b - a;
    const double length2 = norm_squared(d);
    const double t = dot(p - a, d);
    if (!(length2 > 0.0) || t <= 0.0)
        return 0.0;
    return t >= length2 ? 1.0 : t / length2;
}

//! Closest point by the signs of the barycentric coordinates (Ericson, Real-Time Collision
//! Detection, 5.1.5).
std::array<double, 3> closest_on_triangle(const Vec3& p, const Corners& t)
{
    const Vec3 ab = t.b - t.a, ac = t.c - t.a, ap = p - t.a;
    const double d1 = dot(ab, ap), d2 = dot(ac, ap);
    if (d1 <= 0.0 && d2 <= 0.0)
        return {1.0, 0.0, 0.0};
    const Vec3 bp = p - t.b;
    const double d3 = dot(ab, bp), d4 = dot(ac, bp);
    if (d3 >= 0.0 && d4 <= d3)
        return {0.0, 1.0, 0.0};
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
        const double s = d1 / (d1 - d3);
        return {1.0 - s, s, 0.0};
    }
    const Vec3 cp = p - t.c;
    const double d5 = dot(ab, cp), d6 = dot(ac, cp);
    if (d6 >= 0.0 && d5 <= d6)
        return {0.0, 0.0, 1.0};
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
        const double s = d2 / (d2 - d6);
        return {1.0 - s, 0.0, s};
    }
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
        const double s = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return {0.0, 1.0 - s, s};
    }
    const double scale = 1.0 / (va + vb + vc);
    const double v = vb * scale, w = vc * scale;
    return {1.0 - v - w, v, w};
}

Vec3 combine(const Corners& t, const std::array<double, 3>& bary)
{
    // One corner or one side: no rounding from corners that do not take part.
    if (bary[0] == 1.0)
        return t.a;
    if (bary[1] == 1.0)
        return t.b;
    if (bary[2] == 1.0)
        return t.c;
    return bary[0] * t.a + bary[1] * t.b + bary[2] * t.c;
}

//! As closest_on_triangle, for triangles that are nearly or exactly a segment or a point.
std::array<double, 3> closest_on_thin_triangle(const Vec3& p, const Corners& t)
{
    const double s = segment_parameter(p, t.a, t.b);
    const double q = segment_parameter(p, t.b, t.c);
    const double r = segment_parameter(p, t.c, t.a);
    const std::array<double, 3> sides[3] = {
        {1.0 - s, s, 0.0}, {0.0, 1.0 - q, q}, {r, 0.0, 1.0 - r}};
    std::array<double, 3> best = sides[0];
    double least = norm_squared(combine(t, best) - p);
    const auto offer = [&](const std::array<double, 3>& bary) {
        const double d = norm_squared(combine(t, bary) - p);
        if (d < least) {
            least = d;
            best = bary;
        }
    };
    offer(sides[1]);
    offer(sides[2]);
    const std::array<double, 3> inside = closest_on_triangle(p, t);
    if (inside[0] >= 0.0 && inside[1] >= 0.0 && inside[2] >= 0.0) // false for NaN
        offer(inside);
    return best;
}

//! Makes the triangle's closest point the hit if it is closer than `best`, or as close and its face
//! comes first.
void offer(const Vec3& p, const Corners& t, double& best, ClosestPoint::Hit& hit)
{
    const std::array<double, 3> bary =
        t.thin ? closest_on_thin_triangle(p, t) : closest_on_triangle(p, t);
    const Vec3 q = combine(t, bary);
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
    std::vector<Corners> triangles; //!< In the order of boxes.items().
};

ClosestPoint::ClosestPoint(const ManifoldMesh& mesh)
    : ClosestPoint(mesh.positions(), mesh.triangles())
{
}

ClosestPoint::ClosestPoint(const std::vector<Vec3>& positions,
                           const std::vector<std::array<Index, 3>>& triangles)
{
    std::vector<Box3> boxes(triangles.size());
    for (std::size_t f = 0; f < triangles.size(); ++f)
        for (const Index v : triangles[f])
            boxes[f].add(positions[v]);
    auto tree = std::make_shared<Tree>();
    tree->boxes = BoxTree(boxes);
    tree->triangles.reserve(triangles.size());
    for (const Index f : tree->boxes.items()) {
        const auto& t = triangles[f];
        Corners c{positions[t[0]], positions[t[1]], positions[t[2]], f, false};
        const double longest =
            std::max({norm_squared(c.b - c.a), norm_squared(c.c - c.b), norm_squared(c.a - c.c)});
        c.thin = !(norm(cross(c.b - c.a, c.c - c.a)) > thin_sine * longest);
        tree->triangles.push_back(c);
    }
    tree_ = std::move(tree);
}

ClosestPoint::Hit ClosestPoint::query(const Vec3& p) const
{
    return query(p, INFINITY);
}

ClosestPoint::Hit ClosestPoint::query(const Vec3& p, double distance_limit) const
{
    return search(p, distance_limit, [](const Corners&) { return true; });
}

ClosestPoint::Hit ClosestPoint::query_facing(const Vec3& p, const Vec3& direction) const
{
    return search(p, INFINITY, [&direction](const Corners& t) {
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

} // namespace bot2nurbs
