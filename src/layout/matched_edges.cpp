// SPDX-License-Identifier: MIT
#include "layout/matched_edges.h"

#include "layout/curves.h"
#include "mesh/boundary_loops.h"

#include <algorithm>
#include <map>
#include <set>

namespace bot2nurbs {

namespace {

// Parts of an edge that cover it whole add up to its length but for rounding.
constexpr double whole = 1.0 - 1e-9;

std::pair<Index, Index> sorted(Index a, Index b)
{
    return {std::min(a, b), std::max(a, b)};
}

// The part of a chain from a to b; empty when it has none.
std::vector<Index> part_of(const std::vector<Index>& chain, Index a, Index b)
{
    const bool closed = chain.front() == chain.back();
    auto at = std::find(chain.begin(), chain.end(), a);
    std::vector<Index> part;
    if (at == chain.end())
        return part;
    part.push_back(a);
    while (part.back() != b) {
        if (++at == chain.end()) {
            if (!closed)
                return {};
            at = chain.begin() + 1; // The end of a closed chain is its start.
        }
        if (*at == a)
            return {};
        part.push_back(*at);
    }
    return part;
}

// Length of each mesh edge that edges of the quads run along.
std::map<std::pair<Index, Index>, double> covered_lengths(const CurveMatch& match)
{
    std::map<std::pair<Index, Index>, double> covered;
    for (const CurveEdge& e : match.edges) {
        const CurveLine& line = match.lines[e.line];
        const auto [begin, end] = match.span(e);
        for (std::size_t i = 0; i + 1 < line.arc.size(); ++i)
            for (const double shift : {0.0, line.length()})
                covered[sorted(line.vertices[i], line.vertices[i + 1])] +=
                    std::max(0.0, std::min(end, line.arc[i + 1] + shift) -
                                      std::max(begin, line.arc[i] + shift));
    }
    return covered;
}

// The vertices of the source edge or face that a carrier vertex is inside of, or its own.
std::set<Index> support_of(Index v, const ManifoldMesh& source, const CarrierMesh& carrier)
{
    if (v < source.vertex_count())
        return {v};
    const SourcePoint& p = carrier.vertex_source[v];
    std::set<Index> result;
    for (std::size_t k = 0; k < 3; ++k)
        if (p.bary[k] != 0.0)
            result.insert(source.triangle(p.face)[k]);
    return result;
}

} // namespace

std::vector<CurveLine> followable_lines(const ManifoldMesh& mesh,
                                        const std::vector<std::vector<Index>>& creases,
                                        const std::vector<char>& is_corner)
{
    std::vector<CurveLine> lines;
    for (std::vector<Index> loop : boundary_loops(mesh)) {
        loop.push_back(loop.front());
        lines.emplace_back(mesh, std::move(loop), true);
    }
    std::vector<FeaturePath> paths;
    for (const std::vector<Index>& chain : creases)
        paths.push_back({FeatureKind::crease, chain});
    for (Curve& curve : trace_curves(mesh, mark_edges(mesh, paths), is_corner))
        if (curve.kind == FeatureKind::crease)
            lines.emplace_back(mesh, std::move(curve.vertices), false);
    return lines;
}

Result<std::vector<DrawnCurve>>
drawn_along_lines(const CurveMatch& match, const ManifoldMesh& source, const QuadCarrier& board)
{
    const auto chains = lines_on_carrier(match.lines, source, board.carrier);
    std::vector<DrawnCurve> curves;
    for (const CurveEdge& e : match.edges) {
        const std::vector<CurveSite>& sites = match.sites[e.line];
        const Index a = board.vertices[sites[e.first_site].vertex];
        const Index b = board.vertices[sites[(e.first_site + 1) % sites.size()].vertex];
        DrawnCurve curve{e.edge, part_of(chains[e.line], a, b)};
        if (curve.vertices.size() < 2)
            return Error{ErrorCode::invalid_domain,
                         std::string("finds no room for both its ends on the ") +
                             (match.lines[e.line].boundary ? "boundary" : "crease") +
                             " of the mesh that it runs along",
                         e.edge};
        if (e.reversed)
            std::reverse(curve.vertices.begin(), curve.vertices.end());
        curves.push_back(std::move(curve));
    }
    return curves;
}

std::vector<std::vector<Index>>
ways_along_source(const QuadComplex& quads, const ManifoldMesh& source, const QuadCarrier& board)
{
    std::vector<std::set<Index>> support; // Per vertex of the quads.
    for (const Index v : board.vertices)
        support.push_back(support_of(v, source, board.carrier));
    std::vector<CurveLine> lines;
    std::vector<Index> edge_of_line;
    for (Index e = 0; e < quads.edge_count(); ++e) {
        const Index h = quads.halfedge_of_edge(e);
        std::set<Index> both = support[quads.from(h)];
        both.insert(support[quads.to(h)].begin(), support[quads.to(h)].end());
        if (both.size() != 2)
            continue;
        const Index u = *both.begin(), v = *both.rbegin();
        if (source.find_halfedge(u, v) == invalid_index &&
            source.find_halfedge(v, u) == invalid_index)
            continue;
        lines.emplace_back(source, std::vector<Index>{u, v}, false);
        edge_of_line.push_back(e);
    }
    const auto chains = lines_on_carrier(lines, source, board.carrier);
    std::vector<std::vector<Index>> ways(quads.edge_count());
    for (std::size_t l = 0; l < lines.size(); ++l) {
        const Index h = quads.halfedge_of_edge(edge_of_line[l]);
        const Index a = board.vertices[quads.from(h)], b = board.vertices[quads.to(h)];
        std::vector<Index>& way = ways[edge_of_line[l]];
        way = part_of(chains[l], a, b);
        if (way.empty()) {
            way = part_of(chains[l], b, a);
            std::reverse(way.begin(), way.end());
        }
    }
    return ways;
}

std::vector<Index> vertices_on_corners(const CurveMatch& match, const std::vector<char>& is_corner)
{
    std::set<Index> result;
    for (std::size_t l = 0; l < match.lines.size(); ++l)
        for (const CurveSite& site : match.sites[l]) {
            const auto& arc = match.lines[l].arc;
            const auto at = std::lower_bound(arc.begin(), arc.end(), site.s);
            if (at != arc.end() && *at == site.s &&
                is_corner[match.lines[l].vertices[static_cast<std::size_t>(at - arc.begin())]])
                result.insert(site.vertex);
        }
    return {result.begin(), result.end()};
}

std::vector<std::array<Index, 2>> edges_not_followed(const CurveMatch& match,
                                                     const ManifoldMesh& mesh,
                                                     const std::vector<std::vector<Index>>& creases)
{
    const auto covered = covered_lengths(match);
    std::set<std::array<Index, 2>> result;
    for (const std::vector<Index>& chain : creases)
        for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
            const std::pair<Index, Index> edge = sorted(chain[i], chain[i + 1]);
            const double length = norm(mesh.position(edge.second) - mesh.position(edge.first));
            const auto found = covered.find(edge);
            if (found == covered.end() || found->second < whole * length)
                result.insert({edge.first, edge.second});
        }
    return {result.begin(), result.end()};
}

} // namespace bot2nurbs
