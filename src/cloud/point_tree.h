// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "bot2nurbs/vec.h"

#include <memory>
#include <vector>

namespace bot2nurbs {

//! The nearest of a fixed set of points, through a kd-tree. Queries cost O(log n) and may run on
//! many threads at once; their answers depend on the points alone.
class PointTree {
public:
    struct Neighbor {
        Index point = invalid_index;
        double distance2 = 0.0; //!< Squared.
    };

    //! Cost O(n log n). `points` must outlive the tree. Errors: cancelled. \pre coordinates are
    //! finite
    static Result<PointTree> build(const std::vector<Vec3>& points, Context& context);

    //! The `count` nearest points, or all if there are fewer, by distance, then number; which of
    //! several equally far ones come last is up to the tree. A point of the set finds itself.
    void nearest(const Vec3& p, std::size_t count, std::vector<Neighbor>& found) const;
    //! All points closer than `radius`, nearest first.
    void within(const Vec3& p, double radius, std::vector<Neighbor>& found) const;
    Neighbor nearest(const Vec3& p) const;
    std::size_t size() const;
    //! All points, in an order in which neighbours are near: queries in it find most of what they
    //! read in the cache.
    const std::vector<Index>& order() const;

private:
    struct Tree;
    std::shared_ptr<const Tree> tree_;
};

//! The k nearest neighbours of every point among the others, nearest first: those of point i are at
//! i * k. Fewer points than k + 1: all others.
struct NeighborGraph {
    std::size_t k = 0;
    std::vector<PointTree::Neighbor> neighbors;

    const PointTree::Neighbor* of(std::size_t i) const { return &neighbors[i * k]; }
    double radius(std::size_t i) const; //!< Distance to the farthest of the k.
};

//! Errors: cancelled. \pre at least two points, those of the tree
Result<NeighborGraph> find_neighbors(const PointTree& tree, const std::vector<Vec3>& points,
                                     std::size_t k, Context& context);

} // namespace bot2nurbs
