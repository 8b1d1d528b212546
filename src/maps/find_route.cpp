// SPDX-License-Identifier: MIT
#include "maps/find_route.h"

#include <algorithm>
#include <cmath>
#include <queue>

namespace bot2nurbs {

namespace {

// A crossing keeps this share of its stretch from both ends: a path that hugs a vertex or another
// path is no shorter for it.
constexpr double stretch_margin = 0.05;

// Place on a stretch that is nearest to the guide plane.
double place_on(const ManifoldMesh& mesh, Index edge, std::pair<double, double> range,
                const GuidePlane& guide)
{
    const double from = dot(guide.normal, mesh.position(mesh.from(edge)) - guide.point);
    const double to = dot(guide.normal, mesh.position(mesh.to(edge)) - guide.point);
    const double width = range.second - range.first;
    const double low = range.first + stretch_margin * width;
    const double high = range.second - stretch_margin * width;
    const double t = from == to ? 0.5 * (low + high) : from / (from - to);
    return std::clamp(t, low, high);
}

struct Open {
    double bound, length;
    Index number; // Of a stretch; invalid: the way ends behind `before`.
    Index before, wedge;

    bool operator<(const Open& o) const // The queue's top is its largest.
    {
        return bound != o.bound ? bound > o.bound : number > o.number;
    }
};

} // namespace

std::optional<PathWeb::Route> RouteFinder::find(Index a, const PathWeb::Sector& at_a, Index b,
                                                const PathWeb::Sector& at_b,
                                                const GuidePlane& guide)
{
    const ManifoldMesh& mesh = web_.mesh();
    const Vec3 start = mesh.position(a), goal = mesh.position(b);
    PathWeb::Route route;
    route.a = a;
    route.b = b;
    // An edge from a to b that nothing crosses is the shortest way within its two faces.
    double best = INFINITY;
    for (const Index h : at_a.halfedges)
        if (mesh.to(h) == b && web_.is_free(h) &&
            std::find(at_b.halfedges.begin(), at_b.halfedges.end(), mesh.twin(h)) !=
                at_b.halfedges.end()) {
            route.along = h;
            best = norm(goal - start);
        }

    ++stamp_;
    visits_.resize(web_.stretch_count());
    std::priority_queue<Open> queue;
    const auto offer = [&](const PathWeb::Stretch& s, const Vec3& place, double length,
                           Index before, const PathWeb::Wedge& from) {
        const Index number = web_.number(s), edge = mesh.edge(s.halfedge);
        Visit& v = visits_[number];
        if (v.stamp == stamp_ && v.done)
            return;
        const double t = place_on(mesh, edge, web_.range(s), guide);
        const Vec3 here = edge_point(mesh, edge, t);
        length += norm(here - place);
        if (v.stamp == stamp_ && !(length < v.length))
            return;
        v = {stamp_, false, length, s, here, t, before, from};
        const double bound = length + norm(goal - here);
        if (bound < best)
            queue.push({bound, length, number, invalid_index, invalid_index});
    };
    for (const PathWeb::Wedge& w : at_a.wedges) {
        const Index opposite = ManifoldMesh::next(w.halfedge);
        web_.walk_cell(
            web_.border_start(w),
            [&](const PathWeb::Stretch& s) {
                // Over one of the other sides another wedge starts.
                if (s.halfedge == opposite)
                    offer(s, start, 0.0, invalid_index, w);
            },
            [](const PathWeb::Wedge&) {});
    }
    Index last = invalid_index, target = invalid_index;
    while (!queue.empty()) {
        const Open open = queue.top();
        queue.pop();
        if (open.number == invalid_index) {
            last = open.before;
            target = open.wedge;
            break;
        }
        Visit& v = visits_[open.number];
        if (v.done || open.length > v.length)
            continue;
        v.done = true;
        const Visit here = v;
        const PathWeb::Stretch entered = web_.across(here.stretch);
        const Index apex = ManifoldMesh::prev(entered.halfedge);
        web_.walk_cell(
            entered,
            [&](const PathWeb::Stretch& s) {
                if (!(s == entered))
                    offer(s, here.place, here.length, open.number, here.from);
            },
            [&](const PathWeb::Wedge& w) {
                if (w.halfedge != apex || mesh.from(apex) != b)
                    return;
                const auto found = std::find(at_b.wedges.begin(), at_b.wedges.end(), w);
                if (found == at_b.wedges.end())
                    return;
                const double length = here.length + norm(goal - here.place);
                if (length < best) {
                    best = length;
                    queue.push({length, length, invalid_index, open.number,
                                static_cast<Index>(found - at_b.wedges.begin())});
                }
            });
    }
    if (last == invalid_index) {
        if (route.along == invalid_index)
            return std::nullopt;
        return route;
    }
    route.along = invalid_index;
    route.to = at_b.wedges[target];
    for (Index n = last; n != invalid_index; n = visits_[n].before) {
        route.stretches.push_back(visits_[n].stretch);
        route.t.push_back(visits_[n].t);
        route.from = visits_[n].from;
    }
    std::reverse(route.stretches.begin(), route.stretches.end());
    std::reverse(route.t.begin(), route.t.end());
    return route;
}

} // namespace bot2nurbs
