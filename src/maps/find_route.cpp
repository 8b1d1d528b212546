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

bool RouteFinder::is_open(const std::vector<Index>& chain, const PathWeb::Sector& at_a,
                          const PathWeb::Sector& at_b) const
{
    const ManifoldMesh& mesh = web_.mesh();
    const auto leaves = [&mesh](const PathWeb::Sector& sector, Index to) {
        return std::any_of(sector.halfedges.begin(), sector.halfedges.end(),
                           [&](Index h) { return mesh.to(h) == to; });
    };
    const std::size_t n = chain.size();
    if (n < 2 || !leaves(at_a, chain[1]) || !leaves(at_b, chain[n - 2]))
        return false;
    for (std::size_t i = 0; i + 1 < n; ++i) {
        const Index h = mesh.find_halfedge(chain[i], chain[i + 1]);
        if (h == invalid_index || !web_.is_free(h))
            return false;
        if (i > 0 && (web_.is_site(chain[i]) || web_.on_curve(chain[i])))
            return false;
    }
    return true;
}

std::optional<PathWeb::Route> RouteFinder::find(Index a, const PathWeb::Sector& at_a, Index b,
                                                const PathWeb::Sector& at_b,
                                                const GuidePlane& guide,
                                                const std::vector<Index>& chain)
{
    const ManifoldMesh& mesh = web_.mesh();
    const Vec3 start = mesh.position(a), goal = mesh.position(b);
    PathWeb::Route route;
    route.a = a;
    route.b = b;
    double best = INFINITY;
    if (is_open(chain, at_a, at_b)) {
        route.along = chain;
        best = 0.0;
        for (std::size_t i = 1; i < chain.size(); ++i)
            best += norm(mesh.position(chain[i]) - mesh.position(chain[i - 1]));
    } else if (is_open({a, b}, at_a, at_b)) {
        // The shortest way within the two faces of the edge.
        route.along = {a, b};
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
        if (route.along.empty())
            return std::nullopt;
        return route;
    }
    route.along.clear();
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
