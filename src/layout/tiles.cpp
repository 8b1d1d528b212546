// SPDX-License-Identifier: MIT
#include "layout/tiles.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <tuple>

namespace bot2nurbs {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Distance at the third corner of a triangle, straight from the source that has distances dv and dw
// to the two others, unfolded into the triangle's plane; infinite when the line misses the edge vw.
// Edge lengths: vw, uv, uw.
double unfolded_distance(double vw, double uv, double uw, double dv, double dw)
{
    const double sx = (dv * dv - dw * dw + vw * vw) / (2.0 * vw);
    const double sy_squared = dv * dv - sx * sx;
    const double ux = (uv * uv - uw * uw + vw * vw) / (2.0 * vw);
    const double uy_squared = uv * uv - ux * ux;
    if (!(sy_squared >= 0.0) || !(uy_squared > 0.0))
        return infinity;
    const double sy = std::sqrt(sy_squared), uy = std::sqrt(uy_squared);
    // Where the line from the source (below the edge) to u (above) crosses the edge's line.
    const double x = (sx * uy + ux * sy) / (sy + uy);
    if (!(x >= 0.0 && x <= vw))
        return infinity;
    return std::hypot(ux - sx, uy + sy);
}

} // namespace

Tiles::Tiles(const ManifoldMesh& mesh, std::vector<double> density)
    : mesh_(mesh), density_(std::move(density)), area_(mesh.vertex_count(), 0.0),
      on_boundary_(mesh.vertex_count(), 0), label_(mesh.vertex_count(), invalid_index),
      distance_(mesh.vertex_count(), infinity)
{
    for (Index v = 0; v < mesh.vertex_count(); ++v)
        on_boundary_[v] = mesh.is_boundary_vertex(v);
    fixed_ = on_boundary_;
    for (Index f = 0; f < mesh.face_count(); ++f) {
        const double third = norm(mesh.area_vector(f)) / 6.0;
        for (const Index v : mesh.triangle(f))
            area_[v] += third;
    }
}

void Tiles::propagate(const std::vector<Index>& seeds, bool along_boundary)
{
    using Entry = std::tuple<double, Index, Index>; // Distance, label, vertex: ties in this order.
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (const Index s : seeds)
        queue.emplace(distance_[s], label_[s], s);
    const auto improve = [&](Index u, double d, Index label) {
        if (d < distance_[u] && static_cast<bool>(on_boundary_[u]) == along_boundary) {
            distance_[u] = d;
            label_[u] = label;
            queue.emplace(d, label, u);
        }
    };
    while (!queue.empty()) {
        const auto [d, label, v] = queue.top();
        queue.pop();
        if (d > distance_[v] || label != label_[v])
            continue;
        const Index first = mesh_.halfedge_at(v);
        Index h = first;
        do {
            const Index p = mesh_.to(h), q = mesh_.from(mesh_.prev(h));
            const double scale = (density_[v] + density_[p] + density_[q]) / 3.0;
            const double vp = scale * norm(mesh_.position(p) - mesh_.position(v));
            const double vq = scale * norm(mesh_.position(q) - mesh_.position(v));
            if (along_boundary) {
                if (mesh_.twin(h) == invalid_index)
                    improve(p, d + vp, label);
                if (mesh_.twin(mesh_.prev(h)) == invalid_index)
                    improve(q, d + vq, label);
            } else {
                improve(p, d + vp, label);
                improve(q, d + vq, label);
                // Never nearer than the vertex just done: rounding on needles must not start it
                // again. So only one that is still farther can come nearer.
                const auto across = [&](Index u, double vu, Index w, double vw) {
                    if (label_[w] != label || distance_[w] > d || distance_[u] <= d || vw <= 0.0)
                        return;
                    const double uw = scale * norm(mesh_.position(p) - mesh_.position(q));
                    improve(u, std::max(d, unfolded_distance(vw, vu, uw, d, distance_[w])), label);
                };
                across(p, vp, q, vq);
                across(q, vq, p, vp);
            }
            h = mesh_.twin(mesh_.prev(h));
        } while (h != first && h != invalid_index);
    }
}

void Tiles::grow(std::vector<Index> sites)
{
    sites_.clear();
    std::fill(label_.begin(), label_.end(), invalid_index);
    std::fill(distance_.begin(), distance_.end(), infinity);
    add(sites);
}

void Tiles::add(const std::vector<Index>& sites)
{
    std::vector<Index> seeds(sites), on_boundary;
    for (const Index s : sites) {
        label_[s] = static_cast<Index>(sites_.size());
        distance_[s] = 0.0;
        sites_.push_back(s);
        if (on_boundary_[s])
            on_boundary.push_back(s);
    }
    if (!on_boundary.empty()) {
        const std::vector<Index> before = label_;
        propagate(on_boundary, true);
        for (Index v = 0; v < label_.size(); ++v)
            if (label_[v] != before[v])
                seeds.push_back(v);
    }
    propagate(seeds, false);
}

void Tiles::add_farthest(Index count)
{
    while (sites_.size() < count) {
        Index farthest = invalid_index;
        for (Index v = 0; v < mesh_.vertex_count(); ++v)
            if (!on_boundary_[v] &&
                (farthest == invalid_index || distance_[v] > distance_[farthest]))
                farthest = v;
        if (farthest == invalid_index || distance_[farthest] <= 0.0)
            return;
        add({farthest});
    }
}

void Tiles::relax()
{
    std::vector<Vec3> centroid(sites_.size());
    std::vector<double> weight(sites_.size(), 0.0);
    for (Index v = 0; v < mesh_.vertex_count(); ++v) {
        // Density of the scaled metric: tiles balance scaled area.
        const double w = area_[v] * density_[v] * density_[v];
        centroid[label_[v]] += w * mesh_.position(v);
        weight[label_[v]] += w;
    }
    std::vector<Index> best(sites_);
    std::vector<double> best_distance(sites_.size(), infinity);
    for (std::size_t i = 0; i < sites_.size(); ++i)
        centroid[i] = weight[i] > 0.0 ? centroid[i] / weight[i] : mesh_.position(sites_[i]);
    for (Index v = 0; v < mesh_.vertex_count(); ++v) {
        const Index i = label_[v];
        if (fixed_[sites_[i]])
            continue;
        const double d = norm_squared(mesh_.position(v) - centroid[i]);
        if (d < best_distance[i]) {
            best_distance[i] = d;
            best[i] = v;
        }
    }
    grow(best);
}

void Tiles::fix(const std::vector<Index>& vertices)
{
    for (const Index v : vertices)
        fixed_[v] = 1;
}

Index Tiles::between(Index site_a, Index site_b) const
{
    const Index a = label_[site_a], b = label_[site_b];
    Index best = invalid_index;
    for (Index h = 0; h < mesh_.halfedge_count(); ++h) {
        const Index v = mesh_.from(h), w = mesh_.to(h);
        if ((label_[v] == a && label_[w] == b) || (label_[v] == b && label_[w] == a))
            best = farther(farther(best, v), w);
    }
    return best != invalid_index && sites_[label_[best]] == best ? invalid_index : best;
}

void Tiles::list_members(std::vector<Index>& offset, std::vector<Index>& members) const
{
    offset.assign(sites_.size() + 1, 0);
    for (const Index l : label_)
        ++offset[l + 1];
    for (std::size_t i = 0; i < sites_.size(); ++i)
        offset[i + 1] += offset[i];
    members.resize(label_.size());
    std::vector<Index> at(offset.begin(), offset.end() - 1);
    for (Index v = 0; v < label_.size(); ++v)
        members[at[label_[v]]++] = v;
}

// Of two candidates the one farther from its site; sites lose (by what they are, not by their
// distance, which a vertex at the end of an edge without length shares), ties to the smaller index.
Index Tiles::farther(Index a, Index b) const
{
    if (b == invalid_index || sites_[label_[b]] == b)
        return a;
    if (a == invalid_index || sites_[label_[a]] == a)
        return b;
    return distance_[b] > distance_[a] || (distance_[b] == distance_[a] && b < a) ? b : a;
}

Tiles::Outline Tiles::outline(Index tile, const Index* members, const Index* end) const
{
    Outline o;
    // Six times the Euler characteristic of the members' own complex, whose neighbourhood the tile
    // is.
    std::int64_t euler6 = 0;
    Index start = invalid_index;
    for (const Index* m = members; m != end; ++m) {
        const Index v = *m;
        o.farthest_member = farther(o.farthest_member, v);
        euler6 += 6;
        const Index first = mesh_.halfedge_at(v);
        Index h = first;
        do {
            const Index p = mesh_.to(h), q = mesh_.from(mesh_.prev(h));
            if (label_[p] == tile) {
                euler6 -= 3;
                if (label_[q] == tile)
                    euler6 += 2;
            } else if (mesh_.twin(h) == invalid_index) {
                // Where the tile's part of the boundary ends, its cuts begin.
                start = h;
                o.open = true;
            } else if (start == invalid_index) {
                start = h;
            }
            const Index last = mesh_.prev(h);
            h = mesh_.twin(last);
            if (h == invalid_index && label_[q] == tile)
                euler6 -= 3;
        } while (h != first && h != invalid_index);
    }
    o.disk = euler6 == 6 && start != invalid_index;
    if (!o.disk)
        return o;
    // Once around the tile, or from boundary to boundary: runs of neighbours, each with its
    // farthest vertex on either side.
    Index h = start, u = mesh_.from(h), w = mesh_.to(h);
    for (;;) {
        if (o.neighbours.empty() || o.neighbours.back() != label_[w]) {
            o.neighbours.push_back(label_[w]);
            o.farthest.push_back(invalid_index);
        }
        o.farthest.back() = farther(farther(o.farthest.back(), u), w);
        const Index third = mesh_.from(mesh_.prev(h));
        const bool inside = label_[third] == tile;
        (inside ? u : w) = third;
        h = mesh_.twin(inside ? mesh_.next(h) : mesh_.prev(h));
        if (h == invalid_index) {
            if (o.neighbours.back() != label_[w]) {
                o.neighbours.push_back(label_[w]);
                o.farthest.push_back(invalid_index);
            }
            o.farthest.back() = farther(farther(o.farthest.back(), u), w);
            return o;
        }
        if (h == start)
            break;
    }
    if (o.neighbours.size() > 1 && o.neighbours.front() == o.neighbours.back()) {
        o.farthest.front() = farther(o.farthest.front(), o.farthest.back());
        o.neighbours.pop_back();
        o.farthest.pop_back();
    }
    return o;
}

std::vector<Index> Tiles::violations() const
{
    std::vector<Index> offset, members, result;
    list_members(offset, members);
    std::vector<std::pair<Index, std::size_t>> order;
    for (Index i = 0; i < sites_.size(); ++i) {
        const Outline o = outline(i, members.data() + offset[i], members.data() + offset[i + 1]);
        Index candidate = invalid_index;
        if (!o.disk) {
            candidate = o.farthest_member;
        } else if (o.neighbours.size() < (o.open ? 2 : 3)) {
            candidate = o.farthest_member;
            for (const Index v : o.farthest)
                candidate = farther(candidate, v);
        } else {
            order.clear();
            for (std::size_t r = 0; r < o.neighbours.size(); ++r)
                order.emplace_back(o.neighbours[r], r);
            std::sort(order.begin(), order.end());
            for (std::size_t r = 0; r + 1 < order.size(); ++r)
                if (order[r].first == order[r + 1].first) {
                    candidate = farther(candidate, o.farthest[order[r].second]);
                    candidate = farther(candidate, o.farthest[order[r + 1].second]);
                }
        }
        if (candidate != invalid_index)
            result.push_back(candidate);
    }
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
}

} // namespace bot2nurbs
