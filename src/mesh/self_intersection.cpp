// SPDX-License-Identifier: MIT
#include "mesh/self_intersection.h"

#include "core/parallel.h"
#include "core/predicates.h"
#include "mesh/box_tree.h"

#include <algorithm>

namespace bot2nurbs {

namespace {

// Leaves of the box tree a parallel task looks at (about 200 faces), and tasks between two looks at
// the totals. Fixed, so that the place where a search is cut short does not depend on the threads.
constexpr Index leaves_per_task = 64;
constexpr Index tasks_per_round = 8;

// Candidate pairs (boxes that meet) after which a search is cut short: a mesh has about 8 a face;
// only a hopeless soup has 500.
constexpr std::uint64_t candidates_per_face = 500;
constexpr std::uint64_t least_candidates = 4000000;
// A task alone stops here: about 4000 a face.
constexpr std::uint64_t task_candidates = 1024000;

constexpr int stack_size = 128;
constexpr std::size_t chunk_faces = 16384;

using Triangle = std::array<Vec3, 3>;

struct Item {
    Box3 box;
    Triangle corners;
    Index face;
};

bool meet(const Box3& a, const Vec3& min, const Vec3& max)
{
    return min.x <= a.max.x && max.x >= a.min.x && min.y <= a.max.y && max.y >= a.min.y &&
           min.z <= a.max.z && max.z >= a.min.z;
}

//! Sorts and keeps the first `count`.
void keep_first(std::vector<std::array<Index, 2>>& pairs, Index count)
{
    if (pairs.size() > count) {
        std::nth_element(pairs.begin(), pairs.begin() + count, pairs.end());
        pairs.resize(count);
    }
    std::sort(pairs.begin(), pairs.end());
}

//! The sides of the plane of s on which the corners of t lie, 0 at once for shared corners.
std::array<int, 3> sides(const Triangle& t, const Triangle& s)
{
    std::array<int, 3> side{};
    for (int i = 0; i < 3; ++i)
        side[i] =
            t[i] == s[0] || t[i] == s[1] || t[i] == s[2] ? 0 : orient3d(s[0], s[1], s[2], t[i]);
    return side;
}

bool straddles(const std::array<int, 3>& side)
{
    return std::max({side[0], side[1], side[2]}) > 0 && std::min({side[0], side[1], side[2]}) < 0;
}

//! The triangle turned so that corner 0 lies alone on one side of the other's plane and the other
//! two on the opposite side or in the plane, which the first component of the pair says: 1 or -1.
std::pair<int, Triangle> lone_corner_first(const Triangle& t, const std::array<int, 3>& side)
{
    for (const int sign : {1, -1})
        for (int i = 0; i < 3; ++i) {
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            if (side[i] == sign && side[j] != sign && side[k] != sign)
                return {sign, Triangle{t[i], t[j], t[k]}};
        }
    return {0, t};
}

Vec2 drop(const Vec3& p, int axis)
{
    return axis == 0 ? Vec2{p.y, p.z} : (axis == 1 ? Vec2{p.z, p.x} : Vec2{p.x, p.y});
}

//! Overlap of triangles in one plane: none of the six sides separates them.
bool coplanar_overlap(const Triangle& t, const Triangle& s)
{
    for (int axis = 0; axis < 3; ++axis) {
        std::array<Vec2, 3> a, b;
        for (int i = 0; i < 3; ++i) {
            a[i] = drop(t[i], axis);
            b[i] = drop(s[i], axis);
        }
        const int turn_a = orient2d(a[0], a[1], a[2]), turn_b = orient2d(b[0], b[1], b[2]);
        if (turn_a == 0 || turn_b == 0)
            continue; // seen edge-on along this axis, or without area
        if (turn_a < 0)
            std::swap(a[1], a[2]);
        if (turn_b < 0)
            std::swap(b[1], b[2]);
        const auto separates = [](const std::array<Vec2, 3>& p, const std::array<Vec2, 3>& q) {
            for (int i = 0; i < 3; ++i) {
                const Vec2 &from = p[i], &to = p[(i + 1) % 3];
                if (orient2d(from, to, q[0]) <= 0 && orient2d(from, to, q[1]) <= 0 &&
                    orient2d(from, to, q[2]) <= 0)
                    return true;
            }
            return false;
        };
        return !separates(a, b) && !separates(b, a);
    }
    return false;
}

bool has_area(const Triangle& t)
{
    for (int axis = 0; axis < 3; ++axis)
        if (orient2d(drop(t[0], axis), drop(t[1], axis), drop(t[2], axis)) != 0)
            return true;
    return false;
}

bool same_corners(const Triangle& t, const Triangle& s)
{
    const auto has = [&s](const Vec3& p) { return p == s[0] || p == s[1] || p == s[2]; };
    return has(t[0]) && has(t[1]) && has(t[2]);
}

} // namespace

// After Guigue and Devillers, "Fast and robust triangle-triangle overlap test using orientation
// predicates" (2003), with strict inequalities: inner points only. Both triangles meet the line of
// their planes in an interval; the intervals are compared end by end with one predicate each.
bool triangles_cross(const Triangle& t, const Triangle& s)
{
    const std::array<int, 3> side_t = sides(t, s);
    const bool coplanar = side_t[0] == 0 && side_t[1] == 0 && side_t[2] == 0;
    if (!coplanar && !straddles(side_t))
        return false;
    if (coplanar)
        return has_area(t) && has_area(s) && coplanar_overlap(t, s);
    const std::array<int, 3> side_s = sides(s, t);
    if (!straddles(side_s))
        return false;
    auto [sign_t, p] = lone_corner_first(t, side_t);
    auto [sign_s, q] = lone_corner_first(s, side_s);
    // The test below wants both lone corners on the positive side; turning a triangle round
    // exchanges the sides of its plane.
    if (sign_t < 0)
        std::swap(q[1], q[2]);
    if (sign_s < 0)
        std::swap(p[1], p[2]);
    return orient3d(p[0], p[1], q[0], q[1]) < 0 && orient3d(p[0], p[2], q[2], q[0]) < 0;
}

SelfIntersections find_self_intersections(const std::vector<Vec3>& positions,
                                          const std::vector<std::array<Index, 3>>& triangles,
                                          Index kept_pairs, Context& context)
{
    const Index faces = static_cast<Index>(triangles.size());
    std::vector<Box3> boxes(faces);
    for_each_chunk(context, faces, chunk_faces, [&](std::size_t begin, std::size_t end) {
        for (std::size_t f = begin; f < end; ++f)
            for (const Index v : triangles[f])
                boxes[f].add(positions[v]);
    });
    const BoxTree tree(boxes, &context);
    if (context.cancelled())
        return {};
    const std::vector<BoxTree::Node>& nodes = tree.nodes();
    std::vector<Index> leaves; // In the order of items.
    for (Index n = 0; n < nodes.size(); ++n)
        if (nodes[n].count > 0)
            leaves.push_back(n);
    std::sort(leaves.begin(), leaves.end(),
              [&](Index a, Index b) { return nodes[a].first < nodes[b].first; });
    // Boxes and corners in the order of the leaves: what is compared lies close in memory.
    std::vector<Item> items(faces);
    for_each_chunk(context, faces, chunk_faces, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Index f = tree.items()[i];
            const auto& t = triangles[f];
            items[i] = {boxes[f], {positions[t[0]], positions[t[1]], positions[t[2]]}, f};
        }
    });
    boxes = {};
    struct Task {
        std::uint64_t count = 0, candidates = 0;
        bool complete = true;
        std::vector<std::array<Index, 2>> pairs;
    };
    // All pairs of an item of one of the leaves and a later item.
    const auto search = [&](Index first, Index last, Task& task) {
        const auto compare = [&](const Item& a, const Item& b) {
            if (!meet(a.box, b.box.min, b.box.max))
                return;
            ++task.candidates;
            const Item &s = a.face < b.face ? a : b, &t = a.face < b.face ? b : a;
            if (!triangles_cross(s.corners, t.corners) || same_corners(s.corners, t.corners))
                return;
            ++task.count;
            task.pairs.push_back({s.face, t.face});
            if (task.pairs.size() > 2 * std::size_t{kept_pairs})
                keep_first(task.pairs, kept_pairs);
        };
        for (Index l = first; l < last; ++l) {
            if (task.candidates > task_candidates) {
                task.complete = false;
                break;
            }
            const BoxTree::Node& leaf = nodes[leaves[l]];
            const Box3 box{leaf.min, leaf.max};
            const Index end = leaf.first + leaf.count;
            for (Index i = leaf.first; i < end; ++i)
                for (Index j = i + 1; j < end; ++j)
                    compare(items[i], items[j]);
            Index stack[stack_size];
            int depth = 0;
            stack[depth++] = 0;
            while (depth > 0) {
                const BoxTree::Node& node = nodes[stack[--depth]];
                if (!meet(box, node.min, node.max))
                    continue;
                if (node.count == 0) {
                    stack[depth++] = node.first;
                    stack[depth++] = node.first + 1;
                    continue;
                }
                if (node.first < end)
                    continue;
                for (Index i = leaf.first; i < end; ++i)
                    if (meet(items[i].box, node.min, node.max))
                        for (Index j = node.first; j < node.first + node.count; ++j)
                            compare(items[i], items[j]);
            }
        }
        keep_first(task.pairs, kept_pairs);
    };

    SelfIntersections result;
    const std::uint64_t limit = std::max(least_candidates, candidates_per_face * faces);
    std::uint64_t candidates = 0;
    const Index leaf_count = static_cast<Index>(leaves.size());
    const Index tasks = (leaf_count + leaves_per_task - 1) / leaves_per_task;
    for (Index first = 0; first < tasks; first += tasks_per_round) {
        if (context.cancelled() || candidates > limit) {
            result.complete = false;
            break;
        }
        const Index last = std::min(tasks, first + tasks_per_round);
        std::vector<Task> round(last - first);
        for_each_chunk(context, round.size(), 1, [&](std::size_t i, std::size_t) {
            const Index task = first + static_cast<Index>(i);
            search(task * leaves_per_task, std::min(leaf_count, (task + 1) * leaves_per_task),
                   round[i]);
        });
        if (context.cancelled())
            result.complete = false;
        for (const Task& task : round) {
            result.count += task.count;
            candidates += task.candidates;
            result.complete = result.complete && task.complete;
            result.pairs.insert(result.pairs.end(), task.pairs.begin(), task.pairs.end());
        }
        if (result.pairs.size() > 2 * std::size_t{kept_pairs})
            keep_first(result.pairs, kept_pairs);
    }
    keep_first(result.pairs, kept_pairs);
    return result;
}

} // namespace bot2nurbs
