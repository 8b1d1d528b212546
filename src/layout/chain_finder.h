// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/manifold_mesh.h"

#include <algorithm>
#include <map>
#include <optional>
#include <queue>
#include <utility>
#include <vector>

namespace bot2nurbs {

//! A chain of mesh edges.
struct Chain {
    std::vector<Index> vertices;
    double length = 0.0;
};

//! Shortest chains that meet no marked edge and no taken vertex on the way.
class ChainFinder {
public:
    //! Marks are per halfedge, and kept up to date by mark().
    ChainFinder(const ManifoldMesh& mesh, std::vector<char>& marks, const std::vector<Index>& taken)
        : mesh_(mesh), marks_(marks), taken_(mesh.vertex_count(), 0)
    {
        for (Index h = 0; h < mesh.halfedge_count(); ++h)
            if (marks[h])
                taken_[mesh.from(h)] = taken_[mesh.to(h)] = 1;
        for (const Index v : taken)
            taken_[v] = 1;
    }

    //! To the nearest vertex that is an end, is_end(vertex, distance). `goal` may be reached though
    //! it is taken.
    template <class IsEnd>
    std::optional<Chain> find(Index start, const IsEnd& is_end, Index goal = invalid_index) const
    {
        std::map<Index, std::pair<double, Index>> reached; // Vertex: distance, from where.
        using Entry = std::pair<double, Index>;
        std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
        reached[start] = {0.0, invalid_index};
        queue.emplace(0.0, start);
        while (!queue.empty()) {
            const auto [d, v] = queue.top();
            queue.pop();
            if (d > reached[v].first)
                continue;
            if (v != start && is_end(v, d)) {
                Chain chain{{}, d};
                for (Index u = v; u != invalid_index; u = reached[u].second)
                    chain.vertices.push_back(u);
                std::reverse(chain.vertices.begin(), chain.vertices.end());
                return chain;
            }
            for_each_edge(v, [&, d = d, v = v](Index u, Index along) {
                if ((taken_[u] && u != goal) || marks_[along])
                    return;
                const double there = d + norm(mesh_.position(u) - mesh_.position(v));
                const auto at = reached.find(u);
                if (at == reached.end() || there < at->second.first) {
                    reached[u] = {there, v};
                    queue.emplace(there, u);
                }
            });
        }
        return std::nullopt;
    }

    //! Marks the edges of a chain and takes its vertices.
    void mark(const std::vector<Index>& chain, char mark)
    {
        for (std::size_t i = 1; i < chain.size(); ++i)
            for (const Index h : {mesh_.find_halfedge(chain[i - 1], chain[i]),
                                  mesh_.find_halfedge(chain[i], chain[i - 1])})
                if (h != invalid_index)
                    marks_[h] = mark;
        for (const Index v : chain)
            taken_[v] = 1;
    }

    //! Number of marked edges at a vertex.
    int marks_at(Index v) const
    {
        int count = 0;
        for_each_edge(v, [&](Index, Index along) { count += marks_[along] != 0; });
        return count;
    }

private:
    // Calls act(other end, a halfedge of the edge) for every edge at a vertex.
    template <class Act> void for_each_edge(Index v, const Act& act) const
    {
        const Index first = mesh_.halfedge_at(v);
        Index h = first;
        do {
            act(mesh_.to(h), h);
            const Index last = ManifoldMesh::prev(h);
            h = mesh_.twin(last);
            if (h == invalid_index)
                act(mesh_.from(last), last);
        } while (h != first && h != invalid_index);
    }

    const ManifoldMesh& mesh_;
    std::vector<char>& marks_;
    std::vector<char> taken_; // Per vertex: on a marked edge, or a site.
};

} // namespace bot2nurbs
