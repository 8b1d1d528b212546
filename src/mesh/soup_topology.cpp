// SPDX-License-Identifier: MIT
#include "mesh/soup_topology.h"

#include <algorithm>

namespace bot2nurbs {

namespace {

Index root(std::vector<Index>& parent, Index i)
{
    while (parent[i] != i) {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    return i;
}

//! Joins two sets; the smaller root stays, so that roots do not depend on the order of joining.
void unite(std::vector<Index>& parent, Index i, Index j)
{
    i = root(parent, i);
    j = root(parent, j);
    parent[std::max(i, j)] = std::min(i, j);
}

} // namespace

SoupTopology::SoupTopology(Index vertex_count, const std::vector<std::array<Index, 3>>& triangles)
    : triangles_(triangles)
{
    const Index halfedges = static_cast<Index>(3 * triangles.size());
    // Halfedges by their smaller vertex, then by the larger one.
    std::vector<Index> first(std::size_t{vertex_count} + 1, 0);
    const auto low = [&](Index h) { return std::min(from(h), from(next(h))); };
    const auto high = [&](Index h) { return std::max(from(h), from(next(h))); };
    for (Index h = 0; h < halfedges; ++h)
        ++first[low(h) + 1];
    for (Index v = 0; v < vertex_count; ++v)
        first[v + 1] += first[v];
    std::vector<std::pair<Index, Index>> sorted(halfedges); // (larger vertex, halfedge)
    {
        std::vector<Index> slot(first.begin(), first.end() - 1);
        for (Index h = 0; h < halfedges; ++h)
            sorted[slot[low(h)]++] = {high(h), h};
    }
    edge_.resize(halfedges);
    edge_halfedges_.resize(halfedges);
    edge_first_.reserve(halfedges / 2 + 1);
    for (Index v = 0; v < vertex_count; ++v) {
        std::sort(sorted.begin() + first[v], sorted.begin() + first[v + 1]);
        for (Index i = first[v]; i < first[v + 1]; ++i) {
            if (i == first[v] || sorted[i].first != sorted[i - 1].first)
                edge_first_.push_back(i);
            edge_[sorted[i].second] = static_cast<Index>(edge_first_.size() - 1);
            edge_halfedges_[i] = sorted[i].second;
        }
    }
    edge_first_.push_back(halfedges);
    mate_.assign(halfedges, invalid_index);
    for (Index e = 0; e < edge_count(); ++e)
        if (face_count(e) == 2)
            join(edge_halfedges_[edge_first_[e]], edge_halfedges_[edge_first_[e] + 1]);
    update();
}

void SoupTopology::update()
{
    const Index halfedges = static_cast<Index>(mate_.size());
    const Index faces = halfedges / 3;
    std::vector<Index> parent(halfedges);
    for (Index h = 0; h < halfedges; ++h)
        parent[h] = h;
    for (Index h = 0; h < halfedges; ++h) {
        const Index g = mate_[h];
        if (g == invalid_index || g < h)
            continue;
        const bool disagree = mates_disagree(h);
        unite(parent, h, disagree ? g : next(g));
        unite(parent, next(h), disagree ? next(g) : g);
    }
    fan_.resize(halfedges);
    fan_count_ = 0;
    for (Index h = 0; h < halfedges; ++h) {
        const Index r = root(parent, h);
        fan_[h] = r == h ? fan_count_++ : fan_[r]; // r <= h
    }

    component_.assign(faces, invalid_index);
    turn_.assign(faces, 0);
    twist_.clear();
    component_count_ = 0;
    std::vector<Index> open;
    for (Index start = 0; start < faces; ++start) {
        if (component_[start] != invalid_index)
            continue;
        component_[start] = component_count_;
        twist_.push_back(invalid_index);
        open.push_back(start);
        while (!open.empty()) {
            const Index f = open.back();
            open.pop_back();
            for (Index h = 3 * f; h < 3 * f + 3; ++h) {
                const Index g = mate_[h];
                if (g == invalid_index)
                    continue;
                const char wanted = static_cast<char>(turn_[f] ^ (mates_disagree(h) ? 1 : 0));
                if (component_[g / 3] == invalid_index) {
                    component_[g / 3] = component_count_;
                    turn_[g / 3] = wanted;
                    open.push_back(g / 3);
                } else if (turn_[g / 3] != wanted) {
                    Index& twist = twist_[component_count_];
                    twist = std::min(twist, std::min(h, g));
                }
            }
        }
        ++component_count_;
    }
}

std::vector<Index> SoupTopology::fans_per_vertex(Index vertex_count) const
{
    std::vector<Index> fans(vertex_count, 0);
    Index seen = 0; // fans are numbered in the order of their first corners
    for (Index h = 0; h < fan_.size(); ++h)
        if (fan_[h] == seen) {
            ++fans[from(h)];
            ++seen;
        }
    return fans;
}

std::vector<SoupTopology::Loop> SoupTopology::loops() const
{
    // A fan that is not a full turn has two ends: two halfedges without mates touch it.
    std::vector<std::array<Index, 2>> ends(fan_count_, {invalid_index, invalid_index});
    const Index halfedges = static_cast<Index>(mate_.size());
    for (Index h = 0; h < halfedges; ++h)
        if (mate_[h] == invalid_index)
            for (const Index corner : {h, next(h)}) {
                auto& e = ends[fan_[corner]];
                (e[0] == invalid_index ? e[0] : e[1]) = h;
            }
    std::vector<char> seen(halfedges, 0);
    std::vector<Loop> loops;
    for (Index start = 0; start < halfedges; ++start) {
        if (mate_[start] != invalid_index || seen[start])
            continue;
        Loop loop;
        loop.component = component_[start / 3];
        // Backwards along the halfedges: the hole is then on the left, seen from outside.
        Index h = start, corner = next(start);
        while (!seen[h]) {
            seen[h] = 1;
            loop.vertices.push_back(from(corner));
            loop.has_hole = loop.has_hole || face_count(edge_[h]) == 1;
            const Index other = corner == h ? next(h) : h; // the far end of this halfedge
            const auto& e = ends[fan_[other]];
            const Index g = e[0] == h ? e[1] : e[0];
            corner = fan_[g] == fan_[other] ? g : next(g);
            h = g;
        }
        loops.push_back(std::move(loop));
    }
    return loops;
}

} // namespace bot2nurbs
