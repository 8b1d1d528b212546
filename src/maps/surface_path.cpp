// SPDX-License-Identifier: MIT
#include "maps/surface_path.h"

#include <algorithm>

namespace bot2nurbs {

namespace {

// The copies of mesh edges that a stretch of a path without vertices crosses in the universal cover
// of the faces it runs over: a tree, in which the stretch is a walk and its reduction the way from
// the first place to the last.
class CrossingTree {
public:
    explicit CrossingTree(const ManifoldMesh& mesh) : mesh_(mesh) {}

    void cross(const PathNode& n)
    {
        if (here_ != root && mesh_.twin(places_[here_].way.halfedge) == n.halfedge) {
            places_[here_].way.t = std::min(places_[here_].way.t, n.t);
            here_ = places_[here_].parent;
            return;
        }
        Index next = places_[here_].first_child;
        while (next != invalid_index && places_[next].way.halfedge != n.halfedge)
            next = places_[next].sibling;
        if (next == invalid_index) {
            next = static_cast<Index>(places_.size());
            places_.push_back({n, here_, invalid_index, places_[here_].first_child});
            places_[here_].first_child = next;
        } else {
            places_[next].way.t = std::min(places_[next].way.t, n.t);
        }
        here_ = next;
    }

    // Adds the crossings that are left, and begins anew.
    void flush(std::vector<PathNode>& nodes)
    {
        const std::size_t begin = nodes.size();
        for (; here_ != root; here_ = places_[here_].parent)
            nodes.push_back(places_[here_].way);
        std::reverse(nodes.begin() + static_cast<std::ptrdiff_t>(begin), nodes.end());
        places_.resize(1);
        places_[root].first_child = invalid_index;
    }

private:
    static constexpr Index root = 0;
    struct Place {
        PathNode way; // The crossing that leads here from the parent.
        Index parent = invalid_index, first_child = invalid_index, sibling = invalid_index;
    };
    const ManifoldMesh& mesh_;
    std::vector<Place> places_{1};
    Index here_ = root;
};

} // namespace

// A copy of an edge that is left may have been crossed forth, back and forth again. Which crossing
// stands for all must not depend on the direction of travel, or two paths side by side would change
// places. The one nearest to the start of the edge never does: were it the other way round for two
// paths, the edge would lead from its start to one of them across none, though the other one parts
// them.
void reduce(const ManifoldMesh& mesh, SurfacePath& path)
{
    std::vector<PathNode> kept;
    kept.reserve(path.nodes.size());
    CrossingTree tree(mesh);
    for (const PathNode& n : path.nodes) {
        if (n.is_vertex()) {
            tree.flush(kept);
            kept.push_back(n);
        } else {
            tree.cross(n);
        }
    }
    tree.flush(kept);
    const auto touches = [&mesh](const PathNode& n, Index v) {
        return !n.is_vertex() && (mesh.from(n.halfedge) == v || mesh.to(n.halfedge) == v);
    };
    std::size_t first = 0, last = kept.size();
    while (first < last && touches(kept[first], path.a))
        ++first;
    while (last > first && touches(kept[last - 1], path.b))
        --last;
    path.nodes.assign(kept.begin() + static_cast<std::ptrdiff_t>(first),
                      kept.begin() + static_cast<std::ptrdiff_t>(last));
}

double length(const ManifoldMesh& mesh, const SurfacePath& path)
{
    Vec3 last = mesh.position(path.a);
    double sum = 0.0;
    for (const PathNode& n : path.nodes) {
        const Vec3 p =
            n.is_vertex() ? mesh.position(n.vertex) : edge_point(mesh, mesh.edge(n.halfedge), n.t);
        sum += norm(p - last);
        last = p;
    }
    return sum + norm(mesh.position(path.b) - last);
}

} // namespace bot2nurbs
