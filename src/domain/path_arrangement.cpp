// SPDX-License-Identifier: MIT
#include "domain/path_arrangement.h"

#include <algorithm>
#include <string>
#include <tuple>

namespace bot2nurbs {

namespace {

std::string number(std::size_t i)
{
    return std::to_string(i);
}

} // namespace

PathArrangement::PathArrangement(const QuadDomain& domain, DefectList& defects)
    : domain_(domain), mesh_(domain.carrier.mesh)
{
    const std::size_t before = defects.count();
    const Index edges = static_cast<Index>(domain.edges.size());
    nodes_.resize(edges);
    for (Index e = 0; e < edges; ++e) {
        first_step_.push_back(static_cast<Index>(steps_.size()));
        if (read_nodes(e, defects))
            read_steps(e, defects);
    }
    first_step_.push_back(static_cast<Index>(steps_.size()));
    if (defects.count() != before)
        return;
    rank_crossings(defects);
    check_vertices_and_runs(defects);
    if (defects.count() != before)
        return;
    set_positions();
    sort_chords(defects);
}

int PathArrangement::compare(const Node& a, const Node& b)
{
    if (a.reversed == b.reversed) {
        const int order = a.t < b.t ? -1 : (a.t > b.t ? 1 : 0);
        return a.reversed ? -order : order;
    }
    // t against 1 - t': rounding is monotone, so the rounded sum decides unless it is 1; then the
    // rounding error of the sum, which is exact (two-sum), does.
    const double sum = a.t + b.t;
    const double part = sum - a.t;
    const double error = (a.t - (sum - part)) + (b.t - part);
    const double excess = sum != 1.0 ? sum - 1.0 : error;
    const int order = excess < 0.0 ? -1 : (excess > 0.0 ? 1 : 0);
    return a.reversed ? -order : order;
}

bool PathArrangement::read_nodes(Index e, DefectList& defects)
{
    const DomainEdge& edge = domain_.edges[e];
    std::vector<Node>& nodes = nodes_[e];
    nodes.reserve(edge.path.size() + 2);
    nodes.emplace_back();
    nodes.back().vertex = domain_.vertices[edge.a];
    for (std::size_t i = 0; i < edge.path.size(); ++i) {
        const PathPoint& p = edge.path[i];
        Node node;
        if (p.is_vertex()) {
            node.vertex = p.from;
        } else {
            Index h = mesh_.find_halfedge(p.from, p.to);
            node.reversed = h == invalid_index;
            if (node.reversed)
                h = mesh_.find_halfedge(p.to, p.from);
            if (h == invalid_index || !(p.t > 0.0 && p.t < 1.0)) {
                defects.add("path_point",
                            "point " + number(i) + " of the path of edge " + number(e) +
                                (h == invalid_index ? " is on no carrier edge"
                                                    : " is not inside its carrier edge"),
                            e);
                return false;
            }
            node.halfedge = mesh_.edge(h);
            node.reversed = node.reversed != (node.halfedge != h);
            node.t = p.t;
        }
        nodes.push_back(node);
    }
    nodes.emplace_back();
    nodes.back().vertex = domain_.vertices[edge.b];
    return true;
}

//! Whether a point is on the border of a face.
bool PathArrangement::touches(const Node& node, Index face) const
{
    if (!node.is_vertex())
        return ManifoldMesh::face(node.halfedge) == face ||
               (mesh_.twin(node.halfedge) != invalid_index &&
                ManifoldMesh::face(mesh_.twin(node.halfedge)) == face);
    const auto& t = mesh_.triangle(face);
    return t[0] == node.vertex || t[1] == node.vertex || t[2] == node.vertex;
}

//! The stretch between two points, or false when they are not on one face or only on one edge.
bool PathArrangement::make_step(const Node& a, const Node& b, Step& step) const
{
    if (a.is_vertex() && b.is_vertex()) {
        step.halfedge = mesh_.find_halfedge(a.vertex, b.vertex);
        step.reversed = step.halfedge == invalid_index;
        if (step.reversed)
            step.halfedge = mesh_.find_halfedge(b.vertex, a.vertex);
        return step.halfedge != invalid_index;
    }
    const Node& crossing = a.is_vertex() ? b : a;
    const Node& other = a.is_vertex() ? a : b;
    if (other.is_vertex() ? mesh_.from(crossing.halfedge) == other.vertex ||
                                mesh_.to(crossing.halfedge) == other.vertex
                          : crossing.halfedge == other.halfedge)
        return false;
    for (const Index h : {crossing.halfedge, mesh_.twin(crossing.halfedge)})
        if (h != invalid_index && touches(other, ManifoldMesh::face(h))) {
            step.face = ManifoldMesh::face(h);
            return true;
        }
    return false;
}

bool PathArrangement::read_steps(Index e, DefectList& defects)
{
    const std::vector<Node>& nodes = nodes_[e];
    for (std::size_t i = 1; i < nodes.size(); ++i) {
        Step step;
        step.edge = e;
        if (!make_step(nodes[i - 1], nodes[i], step)) {
            defects.add("path_step",
                        "the path of edge " + number(e) + " jumps: its points " + number(i - 1) +
                            " and " + number(i) + " (ends counted) are not on one carrier face, " +
                            "or on one edge of it",
                        e);
            return false;
        }
        const bool crosses = !nodes[i - 1].is_vertex();
        if (crosses && steps_.back().face == step.face) {
            defects.add("path_step",
                        "the path of edge " + number(e) + " turns back at its point " +
                            number(i - 1) + " instead of crossing the carrier edge",
                        e);
            return false;
        }
        steps_.push_back(step);
    }
    return true;
}

//! Orders the crossings of every carrier edge.
void PathArrangement::rank_crossings(DefectList& defects)
{
    std::vector<Node*> crossings;
    std::vector<Index> owner;
    std::vector<std::size_t> order;
    for (Index e = 0; e < nodes_.size(); ++e)
        for (Node& node : nodes_[e])
            if (!node.is_vertex()) {
                order.push_back(order.size());
                crossings.push_back(&node);
                owner.push_back(e);
            }
    std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
        const Node &a = *crossings[i], &b = *crossings[j];
        if (a.halfedge != b.halfedge)
            return a.halfedge < b.halfedge;
        const int c = compare(a, b);
        return c != 0 ? c < 0 : i < j;
    });
    crossings_.assign(mesh_.halfedge_count(), 0);
    for (std::size_t i = 0; i < order.size(); ++i) {
        Node& node = *crossings[order[i]];
        node.rank = crossings_[node.halfedge]++;
        if (node.rank > 0 && compare(*crossings[order[i - 1]], node) == 0)
            defects.add("path_crossing",
                        "the paths of edges " + number(owner[order[i - 1]]) + " and " +
                            number(owner[order[i]]) + " cross carrier edge " +
                            number(mesh_.from(node.halfedge)) + "-" +
                            number(mesh_.to(node.halfedge)) + " at the same point",
                        owner[order[i]]);
    }
}

//! No carrier vertex or edge serves two paths.
void PathArrangement::check_vertices_and_runs(DefectList& defects) const
{
    std::vector<char> is_end(mesh_.vertex_count(), 0);
    for (const Index v : domain_.vertices)
        is_end[v] = 1;
    std::vector<Index> used(mesh_.vertex_count(), invalid_index);
    for (Index e = 0; e < nodes_.size(); ++e)
        for (std::size_t i = 1; i + 1 < nodes_[e].size(); ++i) {
            const Index v = nodes_[e][i].vertex;
            if (v == invalid_index)
                continue;
            if (is_end[v])
                defects.add("path_crossing",
                            "the path of edge " + number(e) + " runs through a domain vertex " +
                                "(carrier vertex " + number(v) + ')',
                            e);
            else if (used[v] != invalid_index)
                defects.add("path_crossing",
                            "the paths of edges " + number(used[v]) + " and " + number(e) +
                                " meet at carrier vertex " + number(v),
                            e);
            used[v] = e;
        }
    std::vector<Index> run(mesh_.halfedge_count(), invalid_index);
    for (const Step& step : steps_) {
        if (step.face != invalid_index)
            continue;
        const Index h = mesh_.edge(step.halfedge);
        if (run[h] != invalid_index || crossings_[h] > 0)
            defects.add("path_crossing",
                        "the path of edge " + number(step.edge) + " runs along carrier edge " +
                            number(mesh_.from(h)) + "-" + number(mesh_.to(h)) +
                            ", which another path uses too",
                        step.edge);
        run[h] = step.edge;
    }
}

//! Where on the border of a face a point of it is.
std::array<Index, 2> PathArrangement::position(const Node& node, Index face) const
{
    if (node.is_vertex()) {
        const auto& t = mesh_.triangle(face);
        return {t[0] == node.vertex ? 0u : (t[1] == node.vertex ? 2u : 4u), 0};
    }
    if (ManifoldMesh::face(node.halfedge) == face)
        return {2 * (node.halfedge % 3) + 1, node.rank};
    const Index twin = mesh_.twin(node.halfedge);
    return {2 * (twin % 3) + 1, crossings_[node.halfedge] - 1 - node.rank};
}

void PathArrangement::set_positions()
{
    for (Index e = 0; e < nodes_.size(); ++e)
        for (Index s = first_step_[e]; s < first_step_[e + 1]; ++s) {
            Step& step = steps_[s];
            if (step.face == invalid_index)
                continue;
            const std::size_t i = s - first_step_[e];
            step.from = position(nodes_[e][i], step.face);
            step.to = position(nodes_[e][i + 1], step.face);
        }
}

//! Chords in the order in which a sweep of the border opens them: by start, of one start the one
//! that reaches farthest first.
bool PathArrangement::chord_before(const Chord& a, const Chord& b)
{
    if (a.low != b.low)
        return a.low < b.low;
    return a.high != b.high ? a.high > b.high : a.step < b.step;
}

void PathArrangement::sort_chords(DefectList& defects)
{
    first_chord_.assign(mesh_.face_count() + 1, 0);
    for (const Step& step : steps_)
        if (step.face != invalid_index)
            ++first_chord_[step.face + 1];
    for (Index f = 0; f < mesh_.face_count(); ++f)
        first_chord_[f + 1] += first_chord_[f];
    chords_.resize(first_chord_.back());
    std::vector<Index> next(first_chord_.begin(), first_chord_.end() - 1);
    for (Index s = 0; s < steps_.size(); ++s) {
        const Step& step = steps_[s];
        if (step.face != invalid_index)
            chords_[next[step.face]++] = {std::min(step.from, step.to),
                                          std::max(step.from, step.to), s};
    }
    std::vector<const Chord*> open;
    for (Index f = 0; f < mesh_.face_count(); ++f) {
        std::sort(chords_.begin() + first_chord_[f], chords_.begin() + first_chord_[f + 1],
                  chord_before);
        open.clear();
        for (Index c = first_chord_[f]; c < first_chord_[f + 1]; ++c) {
            const Chord& chord = chords_[c];
            while (!open.empty() && open.back()->high <= chord.low)
                open.pop_back();
            // Chords that are open enclose each other, the innermost last: a new one must end
            // before it.
            if (!open.empty() && open.back()->high < chord.high)
                defects.add("path_crossing",
                            "the paths of edges " + number(steps_[open.back()->step].edge) +
                                " and " + number(steps_[chord.step].edge) +
                                " cross inside carrier face " + number(f),
                            steps_[chord.step].edge);
            open.push_back(&chord);
        }
    }
}

void PathArrangement::check_vertex_order(DefectList& defects) const
{
    const QuadComplex& complex = domain_.complex;
    // Where a path leaves vertex v: {2 i} along fan halfedge i, {2 i + 1, rank} across fan face i.
    using Key = std::array<Index, 2>;
    std::vector<Index> fan;
    std::vector<Key> keys;
    for (Index d = 0; d < complex.vertex_count(); ++d) {
        const Index v = domain_.vertices[d];
        fan.clear();
        const Index start = mesh_.halfedge_at(v);
        Index h = start;
        do {
            fan.push_back(h);
            h = mesh_.twin(ManifoldMesh::prev(h));
        } while (h != invalid_index && h != start);
        const bool round = h == start;

        const auto key = [&](Index e, bool at_start) -> Key {
            const Step& step = steps_[at_start ? first_step_[e] : first_step_[e + 1] - 1];
            for (Index i = 0; i < fan.size(); ++i) {
                if (step.face == ManifoldMesh::face(fan[i]))
                    return {2 * i + 1, at_start ? step.to[1] : step.from[1]};
                if (step.face == invalid_index && mesh_.edge(fan[i]) == mesh_.edge(step.halfedge))
                    return {2 * i, 0};
            }
            return {static_cast<Index>(2 * fan.size()), 0}; // The last edge of an open fan.
        };
        keys.clear();
        h = complex.halfedge_at(d);
        const Index first = h;
        for (;;) {
            const Index e = complex.edge(h);
            keys.push_back(key(e, complex.halfedge_of_edge(e) == h));
            const Index turned = complex.rotate_ccw(h);
            if (turned == invalid_index) {
                // The side that ends at d on the boundary; its only halfedge points to d.
                keys.push_back(key(complex.edge(QuadComplex::prev(h)), false));
                break;
            }
            h = turned;
            if (h == first)
                break;
        }
        std::size_t descents = 0;
        for (std::size_t i = 0; i + (round ? 0 : 1) < keys.size(); ++i)
            descents += !(keys[i] < keys[(i + 1) % keys.size()]);
        if (descents > (round ? 1u : 0u))
            defects.add("vertex_order",
                        "the paths at domain vertex " + number(d) +
                            " leave it in another order than its edges",
                        d);
    }
}

void PathArrangement::check_boundary(DefectList& defects) const
{
    const auto on_boundary = [&](Index h) { return mesh_.twin(h) == invalid_index; };
    std::vector<char> covered(mesh_.halfedge_count(), 0);
    for (Index e = 0; e < nodes_.size(); ++e) {
        const bool wanted = domain_.complex.is_boundary_edge(e);
        bool right = true;
        for (Index s = first_step_[e]; s < first_step_[e + 1]; ++s) {
            const Step& step = steps_[s];
            const bool is = step.face == invalid_index && on_boundary(step.halfedge);
            right = right && is == wanted;
            if (is)
                covered[step.halfedge] = 1;
        }
        if (!right)
            defects.add("boundary",
                        wanted ? "boundary edge " + number(e) + " leaves the boundary of the mesh"
                               : "inner edge " + number(e) + " runs along the boundary of the mesh",
                        e);
    }
    for (Index h = 0; h < mesh_.halfedge_count(); ++h)
        if (on_boundary(h) && !covered[h])
            defects.add("boundary",
                        "the mesh ends at carrier edge " + number(mesh_.from(h)) + "-" +
                            number(mesh_.to(h)) + ", but the domain does not",
                        h);
}

void check_paths(const QuadDomain& domain, DefectList& defects)
{
    const std::size_t before = defects.count();
    const PathArrangement arrangement(domain, defects);
    if (defects.count() != before)
        return;
    arrangement.check_vertex_order(defects);
    arrangement.check_boundary(defects);
    if (defects.count() == before)
        arrangement.check_regions(defects);
}

} // namespace bot2nurbs
