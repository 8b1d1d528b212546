// SPDX-License-Identifier: MIT
#include "maps/path_web.h"

#include <algorithm>
#include <tuple>

namespace bot2nurbs {

namespace {

// A new crossing keeps this share of its stretch from both ends.
constexpr double insertion_margin = 0.1;
// Stretches shorter than this share of their edge make all crossings of the edge move.
constexpr double least_stretch = 1e-6;
// Crossings of finished paths are this share of an edge apart, where there is room.
constexpr double crossing_gap = 0.02;

} // namespace

PathWeb::PathWeb(const ManifoldMesh& mesh, const std::vector<Index>& sites)
    : mesh_(mesh), site_of_(mesh.vertex_count(), invalid_index), ends_(sites.size()),
      first_on_(mesh.halfedge_count(), invalid_index),
      last_on_(mesh.halfedge_count(), invalid_index), closed_(mesh.halfedge_count(), 0),
      on_curve_(mesh.vertex_count(), 0)
{
    for (Index i = 0; i < sites.size(); ++i)
        site_of_[sites[i]] = i;
    for (Index h = 0; h < mesh.halfedge_count(); ++h)
        closed_[h] = mesh.twin(h) == invalid_index;
}

Index PathWeb::rank(Index corner) const
{
    Index r = 0;
    for (Index h = mesh_.halfedge_at(mesh_.from(corner)); h != corner; ++r)
        h = mesh_.twin(ManifoldMesh::prev(h));
    return r;
}

Index PathWeb::last_in(Index corner) const
{
    const Index site = site_of_[mesh_.from(corner)];
    Index found = invalid_index;
    if (site != invalid_index)
        for (const Index e : ends_[site])
            if (end_[e].corner == corner && !end_[e].is_along())
                found = e;
    return found;
}

Index PathWeb::first_in(Index corner) const
{
    const Index site = site_of_[mesh_.from(corner)];
    if (site != invalid_index)
        for (const Index e : ends_[site])
            if (end_[e].corner == corner && !end_[e].is_along())
                return e;
    return invalid_index;
}

Index PathWeb::before_in(Index corner, Index end) const
{
    Index found = invalid_index;
    for (const Index e : ends_[site_of_[mesh_.from(corner)]]) {
        if (e == end)
            return found;
        if (end_[e].corner == corner && !end_[e].is_along())
            found = e;
    }
    return invalid_index;
}

Index PathWeb::after_in(Index corner, Index end) const
{
    const std::vector<Index>& list = ends_[site_of_[mesh_.from(corner)]];
    const auto found = std::find(list.begin(), list.end(), end) + 1;
    return found != list.end() && end_[*found].corner == corner && !end_[*found].is_along()
               ? *found
               : invalid_index;
}

Index PathWeb::following(Index h, Index crossing) const
{
    const Index e = mesh_.edge(h);
    if (crossing == invalid_index)
        return h == e ? first_on_[e] : last_on_[e];
    return h == e ? crossings_[crossing].high : crossings_[crossing].low;
}

Index PathWeb::in_face(Index crossing, Index face) const
{
    const Index h = crossings_[crossing].halfedge;
    return ManifoldMesh::face(h) == face ? h : mesh_.twin(h);
}

PathWeb::Wedge PathWeb::next_wedge(Stretch& s) const
{
    const Index c = following(s.halfedge, s.start);
    if (c == invalid_index) {
        const Index corner = ManifoldMesh::next(s.halfedge);
        return {corner, last_in(corner)};
    }
    const Crossing& crossing = crossings_[c];
    const Index face = ManifoldMesh::face(s.halfedge);
    const bool leaves = ManifoldMesh::face(crossing.halfedge) == face;
    const Index other = leaves ? crossing.before : crossing.after;
    if (other != invalid_index) {
        s = {in_face(other, face), other};
        return {};
    }
    const Index end = end_of(crossing.path, !leaves);
    return {end_[end].corner, before_in(end_[end].corner, end)};
}

PathWeb::Stretch PathWeb::border_start(const Wedge& wedge) const
{
    if (wedge.after == invalid_index)
        return {wedge.halfedge, invalid_index};
    return {ManifoldMesh::next(wedge.halfedge), end_[wedge.after].crossing};
}

PathWeb::Stretch PathWeb::across(const Stretch& s) const
{
    return {mesh_.twin(s.halfedge), following(s.halfedge, s.start)};
}

Index PathWeb::number(const Stretch& s) const
{
    const Index e = mesh_.edge(s.halfedge);
    const Index low = s.halfedge == e ? s.start : following(s.halfedge, s.start);
    return low == invalid_index ? e : mesh_.halfedge_count() + low;
}

std::pair<double, double> PathWeb::range(const Stretch& s) const
{
    Index low = s.start, high = following(s.halfedge, s.start);
    if (s.halfedge != mesh_.edge(s.halfedge))
        std::swap(low, high);
    return {low == invalid_index ? 0.0 : crossings_[low].t,
            high == invalid_index ? 1.0 : crossings_[high].t};
}

PathWeb::Sector PathWeb::sector(Index site, Index after) const
{
    const Index first = after == invalid_index ? mesh_.halfedge_at(site) : end_[after].corner;
    Wedge wedge{first, invalid_index};
    if (after != invalid_index && !end_[after].is_along())
        wedge.after = after;
    Sector sector;
    for (;;) {
        sector.wedges.push_back(wedge);
        const Index h = wedge.halfedge;
        if ((wedge.after == invalid_index ? first_in(h) : after_in(h, wedge.after)) !=
            invalid_index)
            break;
        const Index back = ManifoldMesh::prev(h);
        if (is_closed(back))
            break;
        wedge = {mesh_.twin(back), invalid_index};
        sector.halfedges.push_back(wedge.halfedge);
        if (after == invalid_index && wedge.halfedge == first)
            break;
    }
    return sector;
}

Index PathWeb::sector_of(const Wedge& wedge) const
{
    if (wedge.after != invalid_index)
        return wedge.after;
    const std::vector<Index>& list = ends_[site_of_[mesh_.from(wedge.halfedge)]];
    if (list.empty())
        return invalid_index;
    const Index r = rank(wedge.halfedge);
    Index found = list.back();
    for (const Index e : list) {
        if (end_[e].rank > r || (end_[e].rank == r && !end_[e].is_along()))
            break;
        found = e;
    }
    return found;
}

PathWeb::Wedge PathWeb::left_of(Index path) const
{
    const Index end = end_of(path, false);
    return {end_[end].corner, end_[end].is_along() ? invalid_index : end};
}

PathWeb::Wedge PathWeb::right_of(Index path) const
{
    const Index end = end_of(path, false), corner = end_[end].corner;
    if (!end_[end].is_along())
        return {corner, before_in(corner, end)};
    const Index right = ManifoldMesh::next(mesh_.twin(corner));
    return {right, last_in(right)};
}

void PathWeb::add_end(Index end, Index vertex, const Wedge& wedge, Index crossing)
{
    const Index r = rank(wedge.halfedge);
    std::vector<Index>& list = ends_[site_of_[vertex]];
    auto place = list.begin();
    if (wedge.after != invalid_index)
        place = std::find(list.begin(), list.end(), wedge.after) + 1;
    else
        while (place != list.end() &&
               (end_[*place].rank < r || (end_[*place].rank == r && end_[*place].is_along())))
            ++place;
    list.insert(place, end);
    end_[end] = {wedge.halfedge, crossing, r};
}

void PathWeb::add_end_along(Index end, Index vertex, Index other)
{
    End made;
    made.corner = mesh_.find_halfedge(vertex, other);
    if (made.corner != invalid_index)
        made.rank = rank(made.corner);
    else // The last edge of a boundary vertex has no face to its left.
        made.rank = rank(ManifoldMesh::next(mesh_.find_halfedge(other, vertex))) + 1;
    std::vector<Index>& list = ends_[site_of_[vertex]];
    auto place = list.begin();
    while (place != list.end() && end_[*place].rank < made.rank)
        ++place;
    list.insert(place, end);
    end_[end] = made;
}

void PathWeb::drop_end(Index end, Index vertex)
{
    std::vector<Index>& list = ends_[site_of_[vertex]];
    list.erase(std::find(list.begin(), list.end(), end));
}

void PathWeb::space_evenly(Index edge)
{
    std::size_t count = 0, i = 0;
    for (Index c = first_on_[edge]; c != invalid_index; c = crossings_[c].high)
        ++count;
    for (Index c = first_on_[edge]; c != invalid_index; c = crossings_[c].high)
        crossings_[c].t = static_cast<double>(++i) / static_cast<double>(count + 1);
}

Index PathWeb::insert_crossing(const Stretch& s, double t, Index path)
{
    const Index e = mesh_.edge(s.halfedge), c = static_cast<Index>(crossings_.size());
    auto [low_t, high_t] = range(s);
    if (high_t - low_t < least_stretch) {
        space_evenly(e);
        std::tie(low_t, high_t) = range(s);
    }
    const double margin = insertion_margin * (high_t - low_t);
    Crossing made;
    made.halfedge = s.halfedge;
    made.path = path;
    made.t = std::clamp(t, low_t + margin, high_t - margin);
    made.low = s.start;
    made.high = following(s.halfedge, s.start);
    if (s.halfedge != e)
        std::swap(made.low, made.high);
    crossings_.push_back(made);
    (made.low == invalid_index ? first_on_[e] : crossings_[made.low].high) = c;
    (made.high == invalid_index ? last_on_[e] : crossings_[made.high].low) = c;
    return c;
}

void PathWeb::set_closed(const Path& path, bool closed)
{
    Index from = path.a;
    for (std::size_t i = 0; i <= path.inner.size(); ++i) {
        const Index to = i < path.inner.size() ? path.inner[i] : path.b;
        Index h = mesh_.find_halfedge(from, to);
        if (h == invalid_index)
            h = mesh_.find_halfedge(to, from);
        closed_[mesh_.edge(h)] = closed;
        from = to;
    }
    for (const Index v : path.inner)
        on_curve_[v] = closed;
}

void PathWeb::add_curve(const std::vector<Index>& vertices)
{
    const Index p = path_count();
    const std::size_t n = vertices.size();
    Path path;
    path.a = vertices.front();
    path.b = vertices.back();
    path.inner.assign(vertices.begin() + 1, vertices.end() - 1);
    set_closed(path, true);
    paths_.push_back(std::move(path));
    end_.resize(end_.size() + 2);
    add_end_along(end_of(p, false), vertices[0], vertices[1]);
    add_end_along(end_of(p, true), vertices[n - 1], vertices[n - 2]);
}

void PathWeb::add(const Route& route)
{
    if (!route.along.empty()) {
        add_curve(route.along);
        return;
    }
    const Index p = path_count();
    paths_.push_back({route.a, route.b, invalid_index, invalid_index, {}});
    end_.resize(end_.size() + 2);
    Index last = invalid_index;
    for (std::size_t i = 0; i < route.stretches.size(); ++i) {
        const Index c = insert_crossing(route.stretches[i], route.t[i], p);
        crossings_[c].before = last;
        (last == invalid_index ? paths_[p].first : crossings_[last].after) = c;
        last = c;
    }
    paths_[p].last = last;
    add_end(end_of(p, false), route.a, route.from, paths_[p].first);
    add_end(end_of(p, true), route.b, route.to, last);
}

void PathWeb::remove_last()
{
    const Index p = path_count() - 1;
    const Path& path = paths_.back();
    if (path.first == invalid_index)
        set_closed(path, false);
    while (!crossings_.empty() && crossings_.back().path == p) {
        const Crossing& c = crossings_.back();
        const Index e = mesh_.edge(c.halfedge);
        (c.low == invalid_index ? first_on_[e] : crossings_[c.low].high) = c.high;
        (c.high == invalid_index ? last_on_[e] : crossings_[c.high].low) = c.low;
        crossings_.pop_back();
    }
    drop_end(end_of(p, false), path.a);
    drop_end(end_of(p, true), path.b);
    end_.resize(end_.size() - 2);
    paths_.pop_back();
}

std::vector<SurfacePath> PathWeb::paths() const
{
    std::vector<double> t(crossings_.size());
    for (Index e = 0; e < first_on_.size(); ++e) {
        double count = 0.0;
        for (Index c = first_on_[e]; c != invalid_index; c = crossings_[c].high)
            ++count;
        const double gap = std::min(crossing_gap, 0.5 / (count + 1.0));
        double bound = gap;
        for (Index c = first_on_[e]; c != invalid_index; c = crossings_[c].high) {
            t[c] = std::max(crossings_[c].t, bound);
            bound = t[c] + gap;
        }
        bound = 1.0 - gap;
        for (Index c = last_on_[e]; c != invalid_index; c = crossings_[c].low) {
            t[c] = std::min(t[c], bound);
            bound = t[c] - gap;
        }
    }
    std::vector<SurfacePath> result;
    result.reserve(paths_.size());
    for (const Path& p : paths_) {
        SurfacePath path;
        path.a = p.a;
        path.b = p.b;
        for (const Index v : p.inner)
            path.nodes.push_back({invalid_index, v, 0.0});
        for (Index c = p.first; c != invalid_index; c = crossings_[c].after)
            path.nodes.push_back({crossings_[c].halfedge, invalid_index, t[c]});
        result.push_back(std::move(path));
    }
    return result;
}

} // namespace bot2nurbs
