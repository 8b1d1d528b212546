// SPDX-License-Identifier: MIT
#include "cloud/point_tree.h"

#include "core/parallel.h"

#include <algorithm>
#include <cmath>

#include <nanoflann.hpp>

namespace bot2nurbs {

namespace {

constexpr std::size_t points_per_leaf = 10;
//! Coordinates read between two looks at the context while the tree is built: about a millisecond.
constexpr std::size_t reads_per_poll = std::size_t{1} << 18;
constexpr std::size_t points_per_chunk = 512;

//! Thrown from within nanoflann, which has no other way out, and caught by build().
struct Cancelled {};

//! The points as nanoflann wants to see them.
struct Points {
    const std::vector<Vec3>& positions;
    const Context* building = nullptr; //!< Null once the tree is built.
    mutable std::size_t reads = 0;     //!< Only counted while building.

    std::size_t kdtree_get_point_count() const { return positions.size(); }
    double kdtree_get_pt(std::size_t i, std::size_t axis) const
    {
        if (building != nullptr && ++reads % reads_per_poll == 0 && building->cancelled())
            throw Cancelled{};
        return positions[i][static_cast<int>(axis)];
    }
    template <class Box> bool kdtree_get_bbox(Box&) const { return false; }
};

using Index3 =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Points, double, Index>,
                                        Points, 3, Index>;

//! Collects neighbours in the caller's array, nearest first, as nanoflann's result sets do.
class NearestSet {
public:
    using DistanceType = double;

    NearestSet(std::vector<PointTree::Neighbor>& found, std::size_t capacity, double limit2)
        : found_(found), capacity_(capacity), limit2_(limit2)
    {
        found_.clear();
    }
    bool full() const { return found_.size() == capacity_; }
    double worstDist() const
    {
        return full() && !found_.empty() ? found_.back().distance2 : limit2_;
    }                                            // NOLINT
    bool addPoint(double distance2, Index point) // NOLINT
    {
        if (!(distance2 < limit2_))
            return true;
        const PointTree::Neighbor neighbor{point, distance2};
        if (full()) {
            if (found_.empty() || !before(neighbor, found_.back()))
                return true;
            found_.pop_back();
        }
        found_.insert(std::upper_bound(found_.begin(), found_.end(), neighbor, before), neighbor);
        return true;
    }

private:
    static bool before(const PointTree::Neighbor& a, const PointTree::Neighbor& b)
    {
        return a.distance2 != b.distance2 ? a.distance2 < b.distance2 : a.point < b.point;
    }

    std::vector<PointTree::Neighbor>& found_;
    std::size_t capacity_;
    double limit2_;
};

} // namespace

struct PointTree::Tree {
    Points points;
    Index3 index;

    Tree(const std::vector<Vec3>& positions, const Context& context)
        : points{positions, &context},
          index(3, points, nanoflann::KDTreeSingleIndexAdaptorParams(points_per_leaf))
    {
        points.building = nullptr;
    }
    void search(const Vec3& p, NearestSet& set) const
    {
        const double query[3] = {p.x, p.y, p.z};
        index.findNeighbors(set, query, nanoflann::SearchParams());
    }
};

Result<PointTree> PointTree::build(const std::vector<Vec3>& points, Context& context)
{
    if (context.cancelled())
        return Context::cancelled_error("search tree");
    PointTree result;
    try {
        result.tree_ = std::make_shared<const Tree>(points, context);
    } catch (const Cancelled&) {
        return Context::cancelled_error("search tree");
    }
    return result;
}

void PointTree::nearest(const Vec3& p, std::size_t count, std::vector<Neighbor>& found) const
{
    NearestSet set(found, std::min(count, size()), INFINITY);
    tree_->search(p, set);
}

void PointTree::within(const Vec3& p, double radius, std::vector<Neighbor>& found) const
{
    NearestSet set(found, size(), radius * radius);
    tree_->search(p, set);
}

PointTree::Neighbor PointTree::nearest(const Vec3& p) const
{
    std::vector<Neighbor> found;
    nearest(p, 1, found);
    return found.front();
}

std::size_t PointTree::size() const
{
    return tree_->points.positions.size();
}

const std::vector<Index>& PointTree::order() const
{
    return tree_->index.vAcc; // public in nanoflann 1.4, of Debian 12
}

double NeighborGraph::radius(std::size_t i) const
{
    return std::sqrt(of(i)[k - 1].distance2);
}

Result<NeighborGraph> find_neighbors(const PointTree& tree, const std::vector<Vec3>& points,
                                     std::size_t k, Context& context)
{
    NeighborGraph graph;
    graph.k = std::min(k, points.size() - 1);
    graph.neighbors.resize(points.size() * graph.k);
    if (!for_each_chunk(
            context, points.size(), points_per_chunk, [&](std::size_t begin, std::size_t end) {
                std::vector<PointTree::Neighbor> found;
                for (std::size_t place = begin; place < end; ++place) {
                    const std::size_t i = tree.order()[place];
                    tree.nearest(points[i], graph.k + 1, found);
                    // The point itself need not be the first of several at one place.
                    auto own =
                        std::find_if(found.begin(), found.end(),
                                     [i](const PointTree::Neighbor& n) { return n.point == i; });
                    if (own == found.end())
                        --own;
                    found.erase(own);
                    std::copy(found.begin(), found.end(),
                              graph.neighbors.begin() + static_cast<std::ptrdiff_t>(i * graph.k));
                }
            }))
        return Context::cancelled_error("neighbours");
    return graph;
}

} // namespace bot2nurbs
