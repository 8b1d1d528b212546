// SPDX-License-Identifier: MIT
#include "bot2nurbs/quad_complex.h"

#include <algorithm>
#include <string>

namespace bot2nurbs {

namespace {

Error invalid(std::string message, Index element)
{
    return {ErrorCode::invalid_domain, std::move(message), element};
}

//! A halfedge keyed by its undirected edge, for pairing by sorting.
struct KeyedHalfedge {
    Index low, high, halfedge;

    bool operator<(const KeyedHalfedge& o) const
    {
        if (low != o.low)
            return low < o.low;
        if (high != o.high)
            return high < o.high;
        return halfedge < o.halfedge;
    }
    bool same_edge(const KeyedHalfedge& o) const { return low == o.low && high == o.high; }
};

std::string edge_name(Index a, Index b)
{
    return std::to_string(a) + "-" + std::to_string(b);
}

} // namespace

Result<QuadComplex> QuadComplex::build(Index vertex_count, std::vector<std::array<Index, 4>> quads,
                                       std::vector<std::pair<Index, Index>> creases,
                                       std::vector<Index> corners)
{
    if (quads.empty())
        return invalid("a domain needs at least one quad", invalid_index);
    QuadComplex k;
    k.vertex_count_ = vertex_count;
    k.quads_ = std::move(quads);
    const Index halfedges = k.halfedge_count();

    k.valence_.assign(vertex_count, 0);
    for (Index q = 0; q < k.quad_count(); ++q) {
        const auto& c = k.quads_[q];
        for (int i = 0; i < 4; ++i) {
            if (c[i] >= vertex_count) {
                return invalid("quad " + std::to_string(q) + " uses vertex " +
                                   std::to_string(c[i]) + ", but there are only " +
                                   std::to_string(vertex_count) + " vertices",
                               q);
            }
            for (int j = 0; j < i; ++j) {
                if (c[i] == c[j]) {
                    return invalid("quad " + std::to_string(q) + " uses vertex " +
                                       std::to_string(c[i]) + " twice",
                                   q);
                }
            }
            ++k.valence_[c[i]];
        }
    }

    std::vector<KeyedHalfedge> keyed(halfedges);
    for (Index h = 0; h < halfedges; ++h) {
        const Index a = k.from(h), b = k.to(h);
        keyed[h] = {std::min(a, b), std::max(a, b), h};
    }
    std::sort(keyed.begin(), keyed.end());
    k.twin_.assign(halfedges, invalid_index);
    for (std::size_t i = 0; i < keyed.size();) {
        std::size_t j = i + 1;
        while (j < keyed.size() && keyed[j].same_edge(keyed[i]))
            ++j;
        const std::string edge = edge_name(keyed[i].low, keyed[i].high);
        if (j - i > 2) {
            return invalid("edge " + edge + " has " + std::to_string(j - i) + " quads",
                           quad_of(keyed[i + 2].halfedge));
        }
        if (j - i == 2) {
            const Index h = keyed[i].halfedge, g = keyed[i + 1].halfedge;
            if (k.from(h) == k.from(g)) {
                return invalid("quads " + std::to_string(quad_of(h)) + " and " +
                                   std::to_string(quad_of(g)) + " run along edge " + edge +
                                   " in the same direction",
                               quad_of(g));
            }
            k.twin_[h] = g;
            k.twin_[g] = h;
        }
        i = j;
    }

    k.edge_of_.resize(halfedges);
    for (Index h = 0; h < halfedges; ++h) {
        const Index g = k.twin_[h];
        if (g < h) {
            k.edge_of_[h] = k.edge_of_[g];
        } else {
            k.edge_of_[h] = k.edge_count();
            k.edges_.push_back(h);
            if (g == invalid_index)
                ++k.boundary_edges_;
        }
    }

    k.vertex_halfedge_.assign(vertex_count, invalid_index);
    for (Index h = 0; h < halfedges; ++h) {
        Index& at = k.vertex_halfedge_[k.from(h)];
        if (at == invalid_index || (k.twin_[h] == invalid_index && k.twin_[at] != invalid_index)) {
            at = h;
        }
    }
    for (Index v = 0; v < vertex_count; ++v) {
        const Index first = k.vertex_halfedge_[v];
        if (first == invalid_index) {
            return invalid("vertex " + std::to_string(v) + " is not used by any quad", v);
        }
        Index reached = 0, h = first;
        do {
            ++reached;
            h = k.rotate_ccw(h);
        } while (h != invalid_index && h != first);
        if (reached != k.valence_[v]) {
            return invalid("the quads at vertex " + std::to_string(v) + " form more than one fan",
                           quad_of(first));
        }
    }

    // `keyed` is sorted, so the edge of a vertex pair is found by bisection.
    k.crease_.assign(k.edge_count(), 0);
    for (const auto& [a, b] : creases) {
        const KeyedHalfedge wanted{std::min(a, b), std::max(a, b), 0};
        const auto it = std::lower_bound(keyed.begin(), keyed.end(), wanted);
        if (it == keyed.end() || !it->same_edge(wanted)) {
            return invalid("crease " + edge_name(a, b) + " is not an edge of the domain",
                           invalid_index);
        }
        k.crease_[k.edge_of_[it->halfedge]] = 1;
    }
    k.corner_.assign(vertex_count, 0);
    for (Index v : corners) {
        if (v >= vertex_count) {
            return invalid("corner " + std::to_string(v) + " is not a vertex of the domain", v);
        }
        k.corner_[v] = 1;
    }
    return k;
}

Index QuadComplex::extraordinary_count() const
{
    Index count = 0;
    for (Index v = 0; v < vertex_count_; ++v) {
        const bool boundary = twin_[vertex_halfedge_[v]] == invalid_index;
        count += valence_[v] != (boundary ? 2u : 4u);
    }
    return count;
}

Index QuadComplex::max_valence() const
{
    return valence_.empty() ? 0 : *std::max_element(valence_.begin(), valence_.end());
}

} // namespace bot2nurbs
