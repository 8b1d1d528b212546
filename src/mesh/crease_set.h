// SPDX-License-Identifier: MIT
#pragma once

#include "mesh/edge_angles.h"

#include <vector>

namespace bot2nurbs {

//! The edges of creases while they are chosen.
class CreaseSet {
public:
    CreaseSet(const ManifoldMesh& mesh, const EdgeAngles& angles);

    //! Takes the edges with both angles of at least `strong` and a spread of at most `most_spread`;
    //! then goes on from every free end over the sharpest edge ahead, as long as its sides meet at
    //! `weak` or more.
    void grow(double strong, double weak, double most_spread);
    //! Opens regions of a few faces and hardly any area, which a jagged or bevelled crease makes,
    //! towards the neighbour they meet at the smallest angle.
    void open_slivers();
    //! Removes branches with a free end that are shorter than this or have very few edges, shortest
    //! first, and whatever that frees.
    void prune(double least_length);

    bool contains(Index halfedge) const { return in_[halfedge] != 0; }
    Index degree(Index vertex) const { return degree_[vertex]; }
    //! A vertex where a crease ends inside the surface.
    bool is_free_end(Index vertex) const
    {
        return degree_[vertex] == 1 && !mesh_.is_boundary_vertex(vertex);
    }
    Index other_end(Index h, Index v) const
    {
        return mesh_.from(h) == v ? mesh_.to(h) : mesh_.from(h);
    }
    //! Calls act(halfedge) for every edge at a vertex; the halfedge may start or end there.
    template <class Act> void for_each_edge_at(Index v, const Act& act) const
    {
        Index h = mesh_.halfedge_at(v);
        const Index first = h;
        do {
            act(h);
            const Index last = ManifoldMesh::prev(h);
            h = mesh_.twin(last);
            if (h == invalid_index)
                act(last);
        } while (h != first && h != invalid_index);
    }
    //! The edges as chains between nodes, or closed (first vertex repeated).
    std::vector<std::vector<Index>> chains() const;

private:
    void set(Index h, char value, int change);
    void add(Index h) { set(h, 1, 1); }
    void remove(Index h) { set(h, 0, -1); }
    bool is_node(Index v) const { return degree_[v] != 2 || mesh_.is_boundary_vertex(v); }
    Index next_edge(Index v, Index from) const;
    std::vector<Index> branch_from(Index free_end) const;
    Index far_end(Index v, Index h) const;
    double length_of(const std::vector<Index>& edges) const;

    const ManifoldMesh& mesh_;
    const EdgeAngles& angles_;
    std::vector<char> in_;      // Per halfedge, both of an edge.
    std::vector<Index> degree_; // Per vertex: its edges in the set.
};

} // namespace bot2nurbs
