// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/result.h"

#include <array>
#include <utility>
#include <vector>

namespace bot2nurbs {

//! How the triangles of a soup hang together, whatever their defects. Halfedge 3 f + k runs from
//! corner k of triangle f to corner k + 1; the same number names corner k.
//!
//! Two triangles are neighbours across an edge that has exactly these two. Everything else follows
//! from this relation: the triangles around a vertex form one or more fans of neighbours, and
//! neighbours form components. Cutting the soup along its other edges and giving each fan a vertex
//! of its own thus makes every component a manifold.
class SoupTopology {
public:
    //! \pre indices are below vertex_count, no triangle repeats a vertex. Cost O(F log F).
    SoupTopology(Index vertex_count, const std::vector<std::array<Index, 3>>& triangles);

    Index edge_count() const { return static_cast<Index>(edge_first_.size() - 1); }
    Index edge_of(Index h) const { return edge_[h]; }
    //! Triangles at an edge.
    Index face_count(Index e) const { return edge_first_[e + 1] - edge_first_[e]; }
    //! The halfedges of an edge, ascending: [first, second).
    std::pair<const Index*, const Index*> halfedges(Index e) const
    {
        return {edge_halfedges_.data() + edge_first_[e],
                edge_halfedges_.data() + edge_first_[e + 1]};
    }
    //! The halfedge of the neighbour across, or invalid_index.
    Index mate(Index h) const { return mate_[h]; }
    //! True when h and its mate run the same way: one of the two triangles is the wrong way round.
    bool mates_disagree(Index h) const { return from(h) == from(mate_[h]); }
    Index from(Index h) const { return triangles_[h / 3][h % 3]; }
    static Index next(Index h) { return h % 3 == 2 ? h - 2 : h + 1; }

    //! Makes two halfedges of one edge mates. Call update() after the last change.
    void join(Index h, Index g)
    {
        mate_[h] = g;
        mate_[g] = h;
    }
    //! Finds fans, components and orientation anew.
    void update();

    Index fan_count() const { return fan_count_; }
    //! The fan that a corner belongs to. Numbered in the order of their first corners.
    Index fan(Index corner) const { return fan_[corner]; }
    //! Fans at each vertex; more than one makes it non-manifold.
    std::vector<Index> fans_per_vertex(Index vertex_count) const;

    Index component_count() const { return component_count_; }
    //! The component of a triangle. Numbered in the order of their first triangles.
    Index component(Index f) const { return component_[f]; }
    //! True when turning this triangle (and all others of its component that say so) makes all
    //! neighbours agree. False for the first triangle of each component.
    bool turn(Index f) const { return turn_[f] != 0; }
    //! Per component: a halfedge across which no choice of turns agrees, or invalid_index.
    const std::vector<Index>& twist() const { return twist_; }

    //! A closed chain of halfedges without mates.
    struct Loop {
        Index component = invalid_index;
        std::vector<Index> vertices;
        bool has_hole = false; //!< Some edge of it has a single triangle.
    };
    //! All loops, each starting at its smallest halfedge.
    std::vector<Loop> loops() const;

private:
    const std::vector<std::array<Index, 3>>& triangles_;
    std::vector<Index> edge_, edge_first_, edge_halfedges_;
    std::vector<Index> mate_;
    std::vector<Index> fan_, component_;
    std::vector<char> turn_;
    std::vector<Index> twist_;
    Index fan_count_ = 0, component_count_ = 0;
};

} // namespace bot2nurbs
