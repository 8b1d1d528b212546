// SPDX-License-Identifier: MIT
#include "layout/match_curves.h"

#include "bot2nurbs/closest_point.h"
#include "layout/quad_boundary.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace bot2nurbs {

namespace {

// A vertex this near to a crease, over the mean length of its edges, may be put on it, and one this
// near to the end of one, or to a corner, there.
constexpr double line_reach = 0.15;
constexpr double node_reach = 0.3;
// An edge follows a crease that between its ends is at most so many times as long as they are apart
// and keeps within this share of that distance: thirds of a circle do (1.21 and 0.29).
constexpr double most_detour = 1.5;
constexpr double most_bulge = 0.35;

// Vertices of the quads that belong where lines end or turn, and the vertex of the mesh there.
using Nodes = std::map<Index, Index>;

// The boundary line of each loop: the nearest pair first, then the nearest of those left.
std::vector<Index> lines_of_loops(const ManifoldMesh& mesh, const std::vector<CurveLine>& lines,
                                  const PlacedQuads& quads,
                                  const std::vector<std::vector<Index>>& loops)
{
    std::vector<std::tuple<double, Index, Index>> pairs;
    for (Index l = 0; l < loops.size(); ++l)
        for (Index k = 0; k < lines.size(); ++k) {
            if (!lines[k].boundary)
                continue;
            double sum = 0.0;
            for (const Index h : loops[l]) {
                const Vec3 p = quads.positions[quads.complex.from(h)];
                sum += norm(lines[k].at(mesh, lines[k].closest(mesh, p)) - p);
            }
            pairs.emplace_back(sum / static_cast<double>(loops[l].size()), l, k);
        }
    std::sort(pairs.begin(), pairs.end());
    std::vector<Index> line_of(loops.size(), invalid_index);
    std::vector<char> taken(lines.size(), 0);
    for (const auto& [distance, l, k] : pairs)
        if (line_of[l] == invalid_index && !taken[k]) {
            line_of[l] = k;
            taken[k] = 1;
        }
    return line_of;
}

Nodes find_nodes(const ManifoldMesh& mesh, const std::vector<CurveLine>& lines,
                 const std::vector<char>& is_corner, const PlacedQuads& quads)
{
    std::vector<Index> at; // Mesh vertices.
    for (const CurveLine& line : lines) {
        // Where a closed line starts is no node unless others end there.
        if (!line.closed())
            at.insert(at.end(), {line.vertices.front(), line.vertices.back()});
        for (const Index v : line.vertices)
            if (v < is_corner.size() && is_corner[v])
                at.push_back(v);
    }
    std::sort(at.begin(), at.end());
    at.erase(std::unique(at.begin(), at.end()), at.end());
    std::vector<std::tuple<double, Index, Index>> pairs;
    for (const Index m : at)
        for (Index v = 0; v < quads.complex.vertex_count(); ++v) {
            const double d = norm(quads.positions[v] - mesh.position(m));
            if (d <= node_reach * quads.size[v] &&
                is_boundary_vertex(quads.complex, v) == mesh.is_boundary_vertex(m))
                pairs.emplace_back(d, m, v);
        }
    std::sort(pairs.begin(), pairs.end());
    Nodes nodes;
    std::vector<Index> used; // Of the mesh.
    for (const auto& [d, m, v] : pairs)
        if (std::find(used.begin(), used.end(), m) == used.end() && nodes.emplace(v, m).second)
            used.push_back(m);
    return nodes;
}

// Numbers of a longest strictly increasing subsequence, by weight.
std::vector<std::size_t> increasing(const std::vector<double>& values,
                                    const std::vector<double>& weight)
{
    const std::size_t n = values.size();
    std::vector<double> best(n);
    std::vector<std::size_t> before(n, n);
    std::size_t last = n;
    for (std::size_t i = 0; i < n; ++i) {
        best[i] = weight[i];
        for (std::size_t j = 0; j < i; ++j)
            if (values[j] < values[i] && best[j] + weight[i] > best[i]) {
                best[i] = best[j] + weight[i];
                before[i] = j;
            }
        if (last == n || best[i] > best[last])
            last = i;
    }
    std::vector<std::size_t> result;
    for (std::size_t i = last; i != n; i = before[i])
        result.push_back(i);
    std::reverse(result.begin(), result.end());
    return result;
}

class Matcher {
public:
    Matcher(const ManifoldMesh& mesh, std::vector<CurveLine> lines,
            const std::vector<char>& is_corner, const PlacedQuads& quads)
        : mesh_(mesh), quads_(quads), node_of_(find_nodes(mesh, lines, is_corner, quads))
    {
        match_.lines = std::move(lines);
        match_.sites.resize(match_.lines.size());
    }

    CurveMatch run()
    {
        const auto loops = boundary_loops(quads_.complex);
        const std::vector<Index> line_of = lines_of_loops(mesh_, match_.lines, quads_, loops);
        for (std::size_t l = 0; l < loops.size(); ++l)
            place_loop(loops[l], line_of[l]);
        drop_nodes_missed();
        follow_creases();
        return std::move(match_);
    }

private:
    const CurveLine& line(Index l) const { return match_.lines[l]; }

    // Where along a line a vertex of the mesh is, if it is on it.
    std::optional<double> arc_at(Index l, Index mesh_vertex) const
    {
        const auto& v = line(l).vertices;
        const auto found = std::find(v.begin(), v.end(), mesh_vertex);
        if (found == v.end())
            return std::nullopt;
        return line(l).arc[static_cast<std::size_t>(found - v.begin())];
    }

    void place_loop(const std::vector<Index>& loop, Index l)
    {
        const std::size_t n = loop.size();
        const double length = line(l).length();
        std::vector<double> s(n), weight(n, 1.0), distance(n);
        std::size_t anchor = 0;
        for (std::size_t i = 0; i < n; ++i) {
            const Index v = quads_.complex.from(loop[i]);
            const auto node = node_of_.find(v);
            const std::optional<double> pinned =
                node == node_of_.end() ? std::nullopt : arc_at(l, node->second);
            s[i] = pinned ? *pinned : line(l).closest(mesh_, quads_.positions[v]);
            if (s[i] >= length)
                s[i] -= length; // The end of a closed line is its start.
            if (pinned)
                weight[i] = static_cast<double>(n);
            distance[i] = norm(line(l).at(mesh_, s[i]) - quads_.positions[v]) / quads_.size[v];
            if (weight[i] != weight[anchor] ? weight[i] > weight[anchor]
                                            : distance[i] < distance[anchor])
                anchor = i;
        }
        // From the anchor on, once around.
        std::vector<double> value(n), share(n);
        for (std::size_t i = 0; i < n; ++i) {
            const std::size_t k = (anchor + i) % n;
            value[i] = s[k] - s[anchor];
            if (value[i] < 0.0)
                value[i] += length;
            share[i] = weight[k];
        }
        share[0] = static_cast<double>(n * n); // Its value, 0, is the least.
        std::vector<std::size_t> kept = increasing(value, share);
        kept.push_back(n);
        value.push_back(length);
        // Ascending from the start of the line, which lies behind `first`.
        std::vector<double> place(n);
        std::size_t first = 0;
        for (std::size_t j = 0; j + 1 < kept.size(); ++j) {
            const std::size_t a = kept[j], b = kept[j + 1];
            place[a] = s[(anchor + a) % n];
            for (std::size_t i = a + 1; i < b; ++i) {
                place[i] =
                    s[anchor] + value[a] +
                    (value[b] - value[a]) * static_cast<double>(i - a) / static_cast<double>(b - a);
                if (place[i] >= length)
                    place[i] -= length;
            }
        }
        for (std::size_t i = 1; i < n; ++i)
            if (place[i] < place[i - 1])
                first = i;
        for (std::size_t i = 0; i < n; ++i) {
            const std::size_t k = (first + i) % n;
            const Index h = loop[(anchor + k) % n];
            add_site(l, quads_.complex.from(h), place[k]);
            match_.edges.push_back({quads_.complex.edge(h), l, static_cast<Index>(i), false});
        }
    }

    void add_site(Index l, Index v, double s)
    {
        const auto node = node_of_.find(v);
        const bool there = node != node_of_.end() && arc_at(l, node->second) == s;
        match_.sites[l].push_back({v, s, there ? node->second : invalid_index});
    }

    // Vertices of a boundary that could not be where lines end, for the order of the others: no
    // crease can end at them.
    void drop_nodes_missed()
    {
        for (const std::vector<CurveSite>& sites : match_.sites)
            for (const CurveSite& site : sites)
                if (site.node == invalid_index)
                    node_of_.erase(site.vertex);
    }

    // Places of a vertex on creases.
    std::vector<std::pair<Index, double>> places(Index v, const ClosestPoint& closest,
                                                 const std::vector<std::pair<Index, Index>>& steps)
    {
        std::vector<std::pair<Index, double>> result;
        const auto node = node_of_.find(v);
        if (node != node_of_.end()) {
            for (Index l = 0; l < match_.lines.size(); ++l)
                if (!line(l).boundary)
                    if (const auto s = arc_at(l, node->second))
                        result.emplace_back(l, *s);
            return result;
        }
        if (is_boundary_vertex(quads_.complex, v))
            return result;
        const ClosestPoint::Hit hit =
            closest.query(quads_.positions[v], line_reach * quads_.size[v]);
        if (hit.where.face == invalid_index)
            return result;
        const auto [l, i] = steps[hit.where.face];
        const double t = hit.where.bary[1] + hit.where.bary[2];
        result.emplace_back(l, (1.0 - t) * line(l).arc[i] + t * line(l).arc[i + 1]);
        return result;
    }

    void follow_creases()
    {
        // Segments as triangles without area.
        std::vector<std::array<Index, 3>> segments;
        std::vector<std::pair<Index, Index>> steps; // Line and place in it.
        for (Index l = 0; l < match_.lines.size(); ++l)
            for (Index i = 0; !line(l).boundary && i + 1 < line(l).vertices.size(); ++i) {
                const Index b = line(l).vertices[i + 1];
                segments.push_back({line(l).vertices[i], b, b});
                steps.emplace_back(l, i);
            }
        if (segments.empty())
            return;
        const ClosestPoint closest(mesh_.positions(), segments);
        const QuadComplex& complex = quads_.complex;
        std::vector<std::vector<std::pair<Index, double>>> at(complex.vertex_count());
        for (Index v = 0; v < complex.vertex_count(); ++v)
            at[v] = places(v, closest, steps);
        std::vector<std::vector<Candidate>> candidates(match_.lines.size());
        for (Index e = 0; e < complex.edge_count(); ++e) {
            if (complex.is_boundary_edge(e))
                continue;
            const Index h = complex.halfedge_of_edge(e);
            for (const auto& [l, from] : at[complex.from(h)])
                for (const auto& [k, to] : at[complex.to(h)])
                    if (l == k)
                        if (const auto c = candidate(e, l, from, to))
                            candidates[l].push_back(*c);
        }
        for (Index l = 0; l < match_.lines.size(); ++l)
            take(l, std::move(candidates[l]));
    }

    // A stretch of a line that an edge may follow: `begin` in [0, length), `end` after it.
    struct Candidate {
        Index edge;
        double begin, end;
        bool reversed;
        friend bool operator<(const Candidate& a, const Candidate& b)
        {
            const double la = a.end - a.begin, lb = b.end - b.begin;
            return la != lb ? la < lb : a.edge < b.edge;
        }
    };

    std::optional<Candidate> candidate(Index e, Index l, double from, double to) const
    {
        const double length = line(l).length();
        Candidate c{e, std::min(from, to), std::max(from, to), to < from};
        if (line(l).closed() && c.end - c.begin > 0.5 * length) {
            // The other way around is shorter.
            std::tie(c.begin, c.end) = std::pair(c.end, c.begin + length);
            c.reversed = !c.reversed;
        }
        if (c.begin >= length) {
            c.begin -= length;
            c.end -= length;
        }
        const Vec3 a = line(l).at(mesh_, c.begin), b = line(l).at(mesh_, c.end);
        const double apart = norm(b - a), way = c.end - c.begin;
        if (!(apart > 0.0) || way > most_detour * apart)
            return std::nullopt;
        for (std::size_t i = 0; i < line(l).arc.size(); ++i)
            for (const double s : {line(l).arc[i], line(l).arc[i] + length}) {
                if (s <= c.begin || s >= c.end)
                    continue;
                const Vec3 p = mesh_.position(line(l).vertices[i]) - a;
                const double t = std::clamp(dot(p, b - a) / (apart * apart), 0.0, 1.0);
                if (norm(p - t * (b - a)) > most_bulge * apart)
                    return std::nullopt;
            }
        return c;
    }

    // Takes the shortest candidates first, each that overlaps none taken before.
    void take(Index l, std::vector<Candidate> candidates)
    {
        const double length = line(l).length();
        std::sort(candidates.begin(), candidates.end());
        std::vector<Candidate> taken;
        for (const Candidate& c : candidates) {
            const auto overlaps = [&](const Candidate& t) {
                for (const double shift : {-length, 0.0, length})
                    if (c.begin + shift < t.end && t.begin < c.end + shift)
                        return true;
                return false;
            };
            if (std::none_of(taken.begin(), taken.end(), overlaps))
                taken.push_back(c);
        }
        std::sort(taken.begin(), taken.end(),
                  [](const Candidate& a, const Candidate& b) { return a.begin < b.begin; });
        std::vector<CurveSite>& sites = match_.sites[l];
        const QuadComplex& complex = quads_.complex;
        for (const Candidate& c : taken) {
            const Index h = complex.halfedge_of_edge(c.edge);
            const Index a = c.reversed ? complex.to(h) : complex.from(h);
            const Index b = c.reversed ? complex.from(h) : complex.to(h);
            if (sites.empty() || sites.back().vertex != a)
                add_site(l, a, c.begin);
            match_.edges.push_back({c.edge, l, static_cast<Index>(sites.size() - 1), c.reversed});
            const bool around = line(l).closed() && sites.front().vertex == b;
            if (!around)
                add_site(l, b, c.end < length || !line(l).closed() ? c.end : c.end - length);
        }
        // An edge over the start of a closed line that nothing follows there ends at a site that
        // belongs in front.
        if (sites.size() > 1 && sites.back().s < sites[sites.size() - 2].s) {
            sites.insert(sites.begin(), sites.back());
            sites.pop_back();
            for (CurveEdge& e : match_.edges)
                if (e.line == l)
                    ++e.first_site;
        }
    }

    const ManifoldMesh& mesh_;
    const PlacedQuads& quads_;
    Nodes node_of_;
    CurveMatch match_;
};

} // namespace

CurveMatch match_curves(const ManifoldMesh& mesh, std::vector<CurveLine> lines,
                        const std::vector<char>& is_corner, const PlacedQuads& quads)
{
    return Matcher(mesh, std::move(lines), is_corner, quads).run();
}

} // namespace bot2nurbs
