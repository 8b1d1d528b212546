// SPDX-License-Identifier: MIT
#include "domain/carrier_editor.h"

#include "maps/crossings.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace bot2nurbs {

namespace {

// An edge is halved at least this far from its ends, so that pieces keep a shape, and at least this
// share of a gap between crossings from these.
constexpr double least_half = 0.25;
constexpr double gap_margin = 0.25;

} // namespace

CarrierEditor::CarrierEditor(const ManifoldMesh& source, const CarrierMesh& carrier,
                             const std::vector<SurfacePath>& paths)
    : source_(source), carrier_(carrier), positions_(carrier.mesh.positions()),
      triangles_(carrier.mesh.triangles())
{
    const ManifoldMesh& mesh = carrier_.mesh;
    for (Index h = 0; h < mesh.halfedge_count(); ++h)
        twin_.push_back(mesh.twin(h));
    for (Index v = 0; v < mesh.vertex_count(); ++v)
        halfedge_at_.push_back(mesh.halfedge_at(v));
    edge_of_.resize(mesh.halfedge_count());
    for (Index h = 0; h < mesh.halfedge_count(); ++h) {
        if (mesh.edge(h) != h) {
            edge_of_[h] = edge_of_[mesh.edge(h)];
            continue;
        }
        edge_of_[h] = static_cast<Index>(edges_.size());
        edges_.push_back({mesh.from(h), {}, invalid_index});
    }
    for (const SurfacePath& path : paths) {
        const auto add = [this](Index vertex, Index halfedge, double t) {
            const Index n = static_cast<Index>(nodes_.size());
            nodes_.push_back({vertex, halfedge, t, n - 1, n + 1});
            if (halfedge != invalid_index)
                edges_[edge_of_[halfedge]].crossings.push_back(n);
        };
        const Index first = static_cast<Index>(nodes_.size());
        first_.push_back(first);
        add(path.a, invalid_index, 0.0);
        for (const PathNode& n : path.nodes)
            add(n.vertex, n.halfedge, n.t);
        add(path.b, invalid_index, 0.0);
        nodes_[first].previous = nodes_.back().next = invalid_index;
        for (Index n = first; n + 1 < nodes_.size(); ++n)
            if (nodes_[n].is_vertex() && nodes_[n + 1].is_vertex())
                edges_[edge_of_[find_halfedge(nodes_[n].vertex, nodes_[n + 1].vertex)]].run = n;
    }
    for (Edge& edge : edges_)
        std::sort(edge.crossings.begin(), edge.crossings.end(),
                  [this](Index a, Index b) { return nodes_[a].t < nodes_[b].t; });
}

Index CarrierEditor::longest_side(Index face) const
{
    Index best = 3 * face;
    for (Index h = 3 * face + 1; h < 3 * face + 3; ++h)
        if (length(h) > length(best))
            best = h;
    return best;
}

Vec3 CarrierEditor::position(Index n) const
{
    const Node& node = nodes_[n];
    if (node.is_vertex())
        return positions_[node.vertex];
    const double t = parameter(node.halfedge, node);
    return (1.0 - t) * positions_[from(node.halfedge)] + t * positions_[to(node.halfedge)];
}

Index CarrierEditor::halfedge_to_halve(Index n) const
{
    const Node& a = nodes_[n];
    const Node& b = nodes_[a.next];
    if (!a.is_vertex())
        return longest_side(twin_[a.halfedge] / 3);
    return b.is_vertex() ? find_halfedge(a.vertex, b.vertex) : longest_side(b.halfedge / 3);
}

Index CarrierEditor::find_halfedge(Index a, Index b) const
{
    const Index first = halfedge_at_[a];
    Index h = first;
    do {
        if (to(h) == b)
            return h;
        // The last side of an open fan has no halfedge from a in this direction.
        if (from(prev(h)) == b)
            return prev(h);
        h = twin_[prev(h)];
    } while (h != first && h != invalid_index);
    for (h = twin_[first]; h != invalid_index && next(h) != first; h = twin_[h]) {
        h = next(h);
        if (to(h) == b)
            return h;
    }
    assert(false);
    return invalid_index;
}

Index CarrierEditor::halve(Index h)
{
    const Edge& edge = edges_[edge_of_[h]];
    // Of the gaps between crossings that reach into the middle of the edge the widest one.
    double low = 0.0, best = 0.5, width = 0.0;
    for (std::size_t i = 0; i <= edge.crossings.size(); ++i) {
        const double high = i < edge.crossings.size() ? nodes_[edge.crossings[i]].t : 1.0;
        const double inner_low = std::max(low, least_half);
        const double inner_high = std::min(high, 1.0 - least_half);
        if (inner_high > inner_low && high - low > width) {
            width = high - low;
            best = std::clamp(0.5, low + gap_margin * width, high - gap_margin * width);
        }
        low = high;
    }
    return split(h, best, invalid_index);
}

Index CarrierEditor::make_vertex(Index n)
{
    return nodes_[n].is_vertex() ? nodes_[n].vertex : split(nodes_[n].halfedge, nodes_[n].t, n);
}

double CarrierEditor::parameter(Index h, const Node& node) const
{
    return edges_[edge_of_[h]].start == from(h) ? node.t : 1.0 - node.t;
}

// Finds the steps on the face of h that an edge from the split to the opposite corner cuts.
CarrierEditor::Side CarrierEditor::plan_side(Index h, const Split& split) const
{
    // The border of the face from the new vertex on, in a frame where h runs along the first axis.
    struct Place {
        Index node, vertex;
        Vec2 at;
    };
    const Vec2 a{0.0, 0.0}, b{1.0, 0.0}, c{0.0, 1.0};
    const bool along = edges_[edge_of_[h]].start == from(h);
    std::vector<Place> ring{{invalid_index, invalid_index, {along ? split.t : 1.0 - split.t, 0.0}}};
    // Crossings first .. last - 1 of an edge, in the direction of its halfedge g.
    const auto add = [&](Index g, const Vec2& p, const Vec2& q, std::size_t first,
                         std::size_t last) {
        const Edge& edge = edges_[edge_of_[g]];
        const bool forward = edge.start == from(g);
        for (std::size_t i = first; i < last; ++i) {
            const Index n = edge.crossings[forward ? i : first + last - 1 - i];
            const double s = parameter(g, nodes_[n]);
            ring.push_back({n, invalid_index, (1.0 - s) * p + s * q});
        }
    };
    const auto count = [&](Index g) { return edges_[edge_of_[g]].crossings.size(); };
    const auto ahead = [&](bool yes) {
        if (yes)
            add(h, a, b, split.after, count(h));
        else
            add(h, a, b, 0, split.before);
    };
    ahead(along);
    ring.push_back({invalid_index, to(h), b});
    add(next(h), b, c, 0, count(next(h)));
    const Index opposite = static_cast<Index>(ring.size());
    ring.push_back({invalid_index, to(next(h)), c});
    add(prev(h), c, a, 0, count(prev(h)));
    ring.push_back({invalid_index, from(h), a});
    ahead(!along);

    Side side;
    side.halfedge = h;
    const Index face = h / 3;
    // The end in this face of the step that a crossing starts or ends there.
    const auto partner = [&](const Node& node) {
        return node.halfedge / 3 == face ? node.previous : node.next;
    };
    const auto place_of = [&ring](Index n, const Node& node) {
        for (Index i = 1; i < ring.size(); ++i)
            if (node.is_vertex() ? ring[i].vertex == node.vertex : ring[i].node == n)
                return i;
        assert(false); // The two ends of a step share a face.
        return Index{0};
    };
    if (split.crossing != invalid_index) {
        const Index n = partner(nodes_[split.crossing]);
        if (nodes_[n].is_vertex() && nodes_[n].vertex == ring[opposite].vertex)
            side.run = nodes_[split.crossing].previous == n ? n : split.crossing;
    }
    for (Index i = 1; i < ring.size(); ++i) {
        if (ring[i].node == invalid_index)
            continue;
        const Node& node = nodes_[ring[i].node];
        const Index other = partner(node);
        if (other == split.crossing)
            continue;
        const Index j = place_of(other, nodes_[other]);
        const Index low = std::min(i, j), high = std::max(i, j);
        if ((ring[j].node != invalid_index && j < i) || low >= opposite || high <= opposite)
            continue;
        const bool starts = node.next == other;
        const Vec2 step = ring[j].at - ring[i].at;
        const double near = std::fabs(cross(step, ring[0].at - ring[i].at));
        const double far = std::fabs(cross(step, c - ring[i].at));
        side.cuts.push_back({starts ? ring[i].node : other, low, high, (low == i) == starts,
                             near + far > 0.0 ? near / (near + far) : 0.5});
    }
    std::sort(side.cuts.begin(), side.cuts.end(), [](const Cut& p, const Cut& q) {
        return p.right != q.right ? p.right < q.right : p.left > q.left;
    });
    return side;
}

Index CarrierEditor::split(Index h, double t, Index crossing)
{
    const Index vertex = static_cast<Index>(positions_.size());
    const Index twin = twin_[h];
    const std::vector<Index>& crossings = edges_[edge_of_[h]].crossings;
    Split split{t, 0, 0, crossing};
    while (split.before < crossings.size() && crossings[split.before] != crossing &&
           nodes_[crossings[split.before]].t < t)
        ++split.before;
    split.after = split.before + (crossing != invalid_index ? 1 : 0);
    // All is found before anything is changed.
    Side side = plan_side(h, split), across;
    if (twin != invalid_index)
        across = plan_side(twin, split);

    const Index face = carrier_.face_source[h / 3];
    const bool along = edges_[edge_of_[h]].start == from(h);
    const auto wa = carrier_.weights(source_, along ? from(h) : to(h), face);
    const auto wb = carrier_.weights(source_, along ? to(h) : from(h), face);
    SourcePoint place{face, {}};
    for (int k = 0; k < 3; ++k)
        place.bary[k] = (1.0 - t) * wa[k] + t * wb[k];
    carrier_.vertex_source.push_back(place);
    positions_.push_back(source_.at(place));
    carrier_.refined = true;

    // The record keeps the half at its start; the other half gets a new one.
    split_edge(edge_of_[h], split, vertex);
    const Index at_start = edge_of_[h], at_end = static_cast<Index>(edges_.size() - 1);
    const Index here = along ? at_start : at_end, there = along ? at_end : at_start;
    split_side(side, vertex);
    edge_of_[h] = here;
    edge_of_[3 * side.added] = there;
    rename(edges_[there], h, 3 * side.added);
    if (twin != invalid_index) {
        split_side(across, vertex);
        edge_of_[twin] = there;
        edge_of_[3 * across.added] = here;
        rename(edges_[here], twin, 3 * across.added);
        join(h, 3 * across.added);
        join(twin, 3 * side.added);
    }
    halfedge_at_.push_back(3 * side.added);
    add_cuts(side, vertex);
    if (twin != invalid_index)
        add_cuts(across, vertex);
    return vertex;
}

void CarrierEditor::split_edge(Index edge, const Split& split, Index vertex)
{
    Edge& first = edges_[edge];
    Edge second;
    second.start = vertex;
    if (split.crossing != invalid_index) {
        nodes_[split.crossing].vertex = vertex;
        nodes_[split.crossing].halfedge = invalid_index;
    }
    for (std::size_t i = split.after; i < first.crossings.size(); ++i) {
        Node& node = nodes_[first.crossings[i]];
        node.t = (node.t - split.t) / (1.0 - split.t);
        second.crossings.push_back(first.crossings[i]);
    }
    first.crossings.resize(split.before);
    for (const Index n : first.crossings)
        nodes_[n].t /= split.t;
    space(first);
    space(second);
    if (first.run != invalid_index) {
        const Index n = first.run, added = static_cast<Index>(nodes_.size());
        nodes_.push_back({vertex, invalid_index, 0.0, invalid_index, invalid_index});
        insert_after(n, added);
        const bool forward = nodes_[n].vertex == first.start;
        first.run = forward ? n : added;
        second.run = forward ? added : n;
    }
    edges_.push_back(std::move(second));
}

// Face (a, b, c) of halfedge a b becomes (a, vertex, c), the new face is (vertex, b, c).
void CarrierEditor::split_side(Side& side, Index vertex)
{
    const Index h = side.halfedge, face = h / 3, b = to(h), c = from(prev(h)), bc = next(h);
    const Index outer = twin_[bc];
    side.added = face_count();
    const Index g = 3 * side.added;
    triangles_[face][bc % 3] = vertex;
    triangles_.push_back({vertex, b, c});
    carrier_.face_source.push_back(carrier_.face_source[face]);
    twin_.resize(twin_.size() + 3, invalid_index);
    edge_of_.resize(edge_of_.size() + 3, invalid_index);
    edge_of_[g + 1] = edge_of_[bc];
    rename(edges_[edge_of_[bc]], bc, g + 1);
    join(g + 1, outer);
    edge_of_[bc] = edge_of_[g + 2] = static_cast<Index>(edges_.size());
    edges_.push_back({vertex, {}, side.run});
    join(bc, g + 2);
    halfedge_at_[b] = g + 1;
}

// Puts crossings where the new edge cuts paths.
void CarrierEditor::add_cuts(const Side& side, Index vertex)
{
    // From the vertex to the opposite corner by the old face, back by the new one.
    const Index out = next(side.halfedge), back = 3 * side.added + 2;
    Edge& edge = edges_[edge_of_[out]];
    assert(edge.start == vertex);
    (void)vertex;
    for (const Cut& cut : side.cuts) {
        const Index n = static_cast<Index>(nodes_.size());
        nodes_.push_back(
            {invalid_index, cut.from_right ? back : out, cut.t, invalid_index, invalid_index});
        insert_after(cut.node, n);
        edge.crossings.push_back(n);
    }
    space(edge);
}

void CarrierEditor::space(Edge& edge)
{
    std::vector<double> t;
    for (const Index n : edge.crossings)
        t.push_back(nodes_[n].t);
    keep_apart(t, 0.0, 1.0);
    for (std::size_t i = 0; i < t.size(); ++i)
        nodes_[edge.crossings[i]].t = t[i];
}

void CarrierEditor::rename(const Edge& edge, Index from, Index to)
{
    for (const Index n : edge.crossings)
        if (nodes_[n].halfedge == from)
            nodes_[n].halfedge = to;
}

void CarrierEditor::insert_after(Index n, Index added)
{
    const Index after = nodes_[n].next;
    nodes_[added].previous = n;
    nodes_[added].next = after;
    nodes_[n].next = added;
    nodes_[after].previous = added;
}

void CarrierEditor::join(Index g, Index h)
{
    twin_[g] = h;
    if (h != invalid_index)
        twin_[h] = g;
}

CarrierMesh CarrierEditor::carrier() const
{
    CarrierMesh result = carrier_;
    if (result.refined) {
        auto mesh = ManifoldMesh::build(positions_, triangles_);
        result.mesh = std::move(*mesh); // Splitting edges of a manifold leaves a manifold.
    }
    return result;
}

std::vector<SurfacePath> CarrierEditor::paths(const ManifoldMesh& mesh) const
{
    std::vector<SurfacePath> result;
    for (const Index first : first_) {
        SurfacePath path;
        path.a = nodes_[first].vertex;
        Index n = nodes_[first].next;
        for (; nodes_[n].next != invalid_index; n = nodes_[n].next) {
            PathNode node;
            node.vertex = nodes_[n].vertex;
            node.halfedge = nodes_[n].halfedge;
            if (!node.is_vertex()) {
                const double t = parameter(node.halfedge, nodes_[n]);
                node.t = mesh.edge(node.halfedge) == node.halfedge ? t : 1.0 - t;
            }
            path.nodes.push_back(node);
        }
        path.b = nodes_[n].vertex;
        result.push_back(std::move(path));
    }
    return result;
}

} // namespace bot2nurbs
