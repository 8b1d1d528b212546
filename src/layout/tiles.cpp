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
      label_(mesh.vertex_count(), invalid_index), distance_(mesh.vertex_count(), infinity)
{
    for (Index f = 0; f < mesh.face_count(); ++f) {
        const double third = norm(mesh.area_vector(f)) / 6.0;
        for (const Index v : mesh.triangle(f))
            area_[v] += third;
    }
}

void Tiles::propagate(const std::vector<Index>& seeds)
{
    using Entry = std::tuple<double, Index, Index>; // Distance, label, vertex: ties in this order.
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (const Index s : seeds)
        queue.emplace(0.0, label_[s], s);
    const auto improve = [&](Index u, double d, Index label) {
        if (d < distance_[u]) {
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
            improve(p, d + vp, label);
            improve(q, d + vq, label);
            const double pq = scale * norm(mesh_.position(p) - mesh_.position(q));
            // Never nearer than the vertex just done: rounding on needles must not start it again.
            if (label_[q] == label && distance_[q] <= d && vq > 0.0)
                improve(p, std::max(d, unfolded_distance(vq, vp, pq, d, distance_[q])), label);
            if (label_[p] == label && distance_[p] <= d && vp > 0.0)
                improve(q, std::max(d, unfolded_distance(vp, vq, pq, d, distance_[p])), label);
            h = mesh_.twin(mesh_.prev(h));
        } while (h != first);
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
    for (const Index s : sites) {
        label_[s] = static_cast<Index>(sites_.size());
        distance_[s] = 0.0;
        sites_.push_back(s);
    }
    propagate(sites);
}

void Tiles::add_farthest(Index count)
{
    while (sites_.size() < count) {
        Index farthest = 0;
        for (Index v = 1; v < mesh_.vertex_count(); ++v)
            if (distance_[v] > distance_[farthest])
                farthest = v;
        if (distance_[farthest] <= 0.0)
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
        const double d = norm_squared(mesh_.position(v) - centroid[i]);
        if (d < best_distance[i]) {
            best_distance[i] = d;
            best[i] = v;
        }
    }
    grow(best);
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

std::vector<Index> Tiles::violations() const
{
    std::vector<Index> offset, members, result;
    list_members(offset, members);
    const auto farther = [this](Index a, Index b) {
        // Of two candidates the one farther from its site; sites lose (by what they are, not by
        // their distance, which a vertex at the end of an edge without length shares), ties to the
        // smaller index.
        if (b == invalid_index || sites_[label_[b]] == b)
            return a;
        if (a == invalid_index || sites_[label_[a]] == a)
            return b;
        return distance_[b] > distance_[a] || (distance_[b] == distance_[a] && b < a) ? b : a;
    };
    std::vector<Index> runs, run_candidate;
    for (Index i = 0; i < sites_.size(); ++i) {
        Index farthest = invalid_index, around = invalid_index, start = invalid_index;
        // Twice the Euler characteristic of the members' own complex, whose neighbourhood the tile
        // is.
        std::int64_t euler6 = 0;
        for (Index m = offset[i]; m < offset[i + 1]; ++m) {
            const Index v = members[m];
            farthest = farther(farthest, v);
            euler6 += 6;
            const Index first = mesh_.halfedge_at(v);
            Index h = first;
            do {
                const Index p = mesh_.to(h), q = mesh_.from(mesh_.prev(h));
                if (label_[p] == i) {
                    euler6 -= 3;
                    if (label_[q] == i)
                        euler6 += 2;
                } else if (start == invalid_index) {
                    start = h;
                }
                h = mesh_.twin(mesh_.prev(h));
            } while (h != first);
        }
        if (euler6 != 6 || start == invalid_index) {
            result.push_back(farthest);
            continue;
        }
        // Once around the tile: runs of neighbours, each with its farthest vertex on either side.
        runs.clear();
        run_candidate.clear();
        Index h = start;
        do {
            const Index u = mesh_.from(h), w = mesh_.to(h);
            if (runs.empty() || runs.back() != label_[w]) {
                runs.push_back(label_[w]);
                run_candidate.push_back(invalid_index);
            }
            run_candidate.back() = farther(farther(run_candidate.back(), u), w);
            around = farther(farther(around, u), w);
            const Index third = mesh_.from(mesh_.prev(h));
            h = label_[third] == i ? mesh_.twin(mesh_.next(h)) : mesh_.twin(mesh_.prev(h));
        } while (h != start);
        if (runs.size() > 1 && runs.front() == runs.back()) {
            run_candidate.front() = farther(run_candidate.front(), run_candidate.back());
            runs.pop_back();
            run_candidate.pop_back();
        }
        if (runs.size() < 3) {
            result.push_back(farther(farthest, around));
            continue;
        }
        std::vector<std::pair<Index, std::size_t>> order;
        for (std::size_t r = 0; r < runs.size(); ++r)
            order.emplace_back(runs[r], r);
        std::sort(order.begin(), order.end());
        Index candidate = invalid_index;
        for (std::size_t r = 0; r + 1 < order.size(); ++r)
            if (order[r].first == order[r + 1].first) {
                candidate = farther(candidate, run_candidate[order[r].second]);
                candidate = farther(candidate, run_candidate[order[r + 1].second]);
            }
        if (candidate != invalid_index)
            result.push_back(candidate);
    }
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
}

} // namespace bot2nurbs
