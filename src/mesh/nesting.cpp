// SPDX-License-Identifier: MIT
#include "mesh/nesting.h"

#include "core/predicates.h"
#include "mesh/box_tree.h"

#include <optional>

namespace bot2nurbs {

namespace {

constexpr int stack_size = 128;

//! Counts how often a closed mesh winds round a point, exactly.
class WindingNumber {
public:
    explicit WindingNumber(const ManifoldMesh& mesh) : mesh_(mesh)
    {
        std::vector<Box3> boxes(mesh.face_count());
        for (Index f = 0; f < mesh.face_count(); ++f)
            for (const Index v : mesh.triangle(f))
                boxes[f].add(mesh.position(v));
        tree_ = BoxTree(boxes);
    }

    //! Nothing when p lies on the surface. Follows the ray from p along +x and adds the sides from
    //! which it pierces faces.
    std::optional<int> at(const Vec3& p) const
    {
        int winding = 0;
        Index stack[stack_size];
        int depth = 0;
        stack[depth++] = 0;
        while (depth > 0) {
            const BoxTree::Node& node = tree_.nodes()[stack[--depth]];
            if (node.max.x < p.x || node.min.y > p.y || node.max.y < p.y || node.min.z > p.z ||
                node.max.z < p.z)
                continue;
            if (node.count == 0) {
                stack[depth++] = node.first;
                stack[depth++] = node.first + 1;
                continue;
            }
            for (Index i = node.first; i < node.first + node.count; ++i) {
                const auto& t = mesh_.triangle(tree_.items()[i]);
                const Vec3 &a = mesh_.position(t[0]), &b = mesh_.position(t[1]),
                           &c = mesh_.position(t[2]);
                const int turn = turn_around(a, b, c, p);
                if (turn == 0)
                    continue;
                const int side = orient3d(a, b, c, p);
                if (side == 0)
                    return std::nullopt;
                // Seen along x from afar the face turns `turn`; p lies before it when it is on
                // the side that sees the face turn the other way.
                if (side == turn)
                    winding += turn;
            }
        }
        return winding;
    }

private:
    //! How the triangle winds round p as seen along the x axis: 1, -1 or 0. A point on a side
    //! counts to one of its two triangles by a rule that depends on the side alone.
    static int turn_around(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p)
    {
        return step(a, b, p) + step(b, c, p) + step(c, a, p);
    }
    //! 1 or -1 when the side ab, seen along x, crosses the half-line from p towards +y upward or
    //! downward.
    static int step(const Vec3& a, const Vec3& b, const Vec3& p)
    {
        if ((a.z > p.z) == (b.z > p.z))
            return 0;
        const bool up = b.z > a.z;
        const Vec3 &low = up ? a : b, &high = up ? b : a;
        if (orient2d({low.y, low.z}, {high.y, high.z}, {p.y, p.z}) <= 0)
            return 0; // p lies on the side or to its right
        return up ? 1 : -1;
    }

    const ManifoldMesh& mesh_;
    BoxTree tree_;
};

bool contains(const Box3& outer, const Box3& inner)
{
    return outer.min.x <= inner.min.x && outer.min.y <= inner.min.y && outer.min.z <= inner.min.z &&
           outer.max.x >= inner.max.x && outer.max.y >= inner.max.y && outer.max.z >= inner.max.z;
}

//! For every box the others inside it, ascending.
std::vector<std::vector<Index>> boxes_inside(const std::vector<Box3>& boxes)
{
    const BoxTree tree(boxes);
    std::vector<std::vector<Index>> inner(boxes.size());
    for (Index i = 0; i < boxes.size(); ++i) {
        Index stack[stack_size];
        int depth = 0;
        stack[depth++] = 0;
        while (depth > 0) {
            const BoxTree::Node& node = tree.nodes()[stack[--depth]];
            if (!contains(Box3{node.min, node.max}, boxes[i]))
                continue;
            if (node.count == 0) {
                stack[depth++] = node.first;
                stack[depth++] = node.first + 1;
                continue;
            }
            for (Index k = node.first; k < node.first + node.count; ++k) {
                const Index j = tree.items()[k];
                if (j != i && contains(boxes[j], boxes[i]))
                    inner[j].push_back(i);
            }
        }
    }
    return inner;
}

} // namespace

Nesting find_nesting(const std::vector<const ManifoldMesh*>& meshes)
{
    const Index n = static_cast<Index>(meshes.size());
    std::vector<Box3> boxes(n);
    for (Index i = 0; i < n; ++i)
        boxes[i] = meshes[i]->box();
    const std::vector<std::vector<Index>> inner = boxes_inside(boxes);
    std::vector<std::vector<Index>> around(n);
    for (Index j = 0; j < n; ++j) {
        if (!meshes[j]->closed() || inner[j].empty())
            continue;
        const WindingNumber winding(*meshes[j]);
        for (const Index i : inner[j]) {
            if (!meshes[i]->closed())
                continue;
            for (const Vec3& p : meshes[i]->positions()) {
                const std::optional<int> w = winding.at(p);
                if (!w)
                    continue;
                if (*w != 0)
                    around[i].push_back(j);
                break;
            }
        }
    }
    Nesting nesting;
    nesting.depth.resize(n);
    nesting.parent.assign(n, invalid_index);
    for (Index i = 0; i < n; ++i)
        nesting.depth[i] = static_cast<Index>(around[i].size());
    for (Index i = 0; i < n; ++i)
        for (const Index j : around[i])
            if (nesting.parent[i] == invalid_index ||
                nesting.depth[j] > nesting.depth[nesting.parent[i]])
                nesting.parent[i] = j;
    return nesting;
}

} // namespace bot2nurbs
