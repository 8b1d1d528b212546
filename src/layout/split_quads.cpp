// SPDX-License-Identifier: MIT
#include "bot2nurbs/import_quads.h"

#include "bot2nurbs/tolerance.h"
#include "core/disjoint_sets.h"
#include "mesh/weld.h"

#include <algorithm>
#include <string>

namespace bot2nurbs {

namespace {

// A boundary vertex this near to the inside of a boundary edge, over the edge's length, is a
// T-junction: modelling tools put such vertices on the edge, rounded to single precision.
constexpr double on_edge = 1e-4;

using Quads = std::vector<std::array<Index, 4>>;

std::string text(Index i)
{
    return std::to_string(i);
}

Error invalid(std::string message, Index element)
{
    return {ErrorCode::invalid_domain, std::move(message) + " (counted from 0)", element};
}

std::string edge_text(Index a, Index b)
{
    return "edge " + text(a) + "-" + text(b);
}

// Sides of quads, those of an undirected edge together.
struct Side {
    Index low, high, halfedge;
    bool operator<(const Side& o) const
    {
        if (low != o.low)
            return low < o.low;
        return high != o.high ? high < o.high : halfedge < o.halfedge;
    }
    bool same_edge(const Side& o) const { return low == o.low && high == o.high; }
};

Index from(const Quads& quads, Index h)
{
    return quads[h / 4][h % 4];
}
Index to(const Quads& quads, Index h)
{
    return quads[h / 4][(h + 1) % 4];
}

std::vector<Side> sorted_sides(const Quads& quads)
{
    std::vector<Side> sides(4 * quads.size());
    for (Index h = 0; h < sides.size(); ++h) {
        const Index a = from(quads, h), b = to(quads, h);
        sides[h] = {std::min(a, b), std::max(a, b), h};
    }
    std::sort(sides.begin(), sides.end());
    return sides;
}

Result<Quads> read_quads(const PolygonMesh& mesh)
{
    Quads quads(mesh.polygons.size());
    Index others = 0, first = invalid_index;
    for (Index p = 0; p < quads.size(); ++p)
        if (mesh.polygons.count(p) != 4) {
            ++others;
            first = std::min(first, p);
        }
    if (others > 0)
        return Error{ErrorCode::invalid_domain,
                     text(others) + " of " + text(static_cast<Index>(quads.size())) +
                         " faces are no quads: the first, face " + text(first) +
                         " (counted from 0), has " +
                         text(static_cast<Index>(mesh.polygons.count(first))) +
                         " corners. One step of Catmull-Clark subdivision in the program they come "
                         "from makes all faces quads",
                     first};
    for (Index p = 0; p < quads.size(); ++p)
        for (Index k = 0; k < 4; ++k)
            quads[p][k] = mesh.polygons.corner(p, k);
    return quads;
}

// Welds vertices of open edges that agree.
void weld_boundary(const std::vector<Vec3>& positions, Quads& quads)
{
    std::vector<char> open(positions.size(), 0);
    const std::vector<Side> sides = sorted_sides(quads);
    bool any = false;
    for (std::size_t i = 0; i < sides.size(); ++i) {
        const bool alone = (i == 0 || !sides[i].same_edge(sides[i - 1])) &&
                           (i + 1 == sides.size() || !sides[i].same_edge(sides[i + 1]));
        if (alone) {
            open[sides[i].low] = open[sides[i].high] = 1;
            any = true;
        }
    }
    if (!any)
        return;
    Box3 box;
    for (const auto& q : quads)
        for (const Index v : q)
            box.add(positions[v]);
    const std::vector<Index> group = weld_points(positions, open, tolerance::weld * box.diagonal());
    for (auto& q : quads)
        for (Index& v : q)
            v = group[v];
}

std::optional<Error> check_corners(const Quads& quads)
{
    for (Index q = 0; q < quads.size(); ++q)
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < i; ++j)
                if (quads[q][i] == quads[q][j])
                    return invalid(
                        "face " + text(q) + " uses vertex " + text(quads[q][i]) + " twice", q);
    return std::nullopt;
}

// Turns faces to agree with the first of their piece, and says which piece each is in, as the
// number of its first face.
Result<std::vector<Index>> orient(Quads& quads)
{
    std::vector<Side> sides = sorted_sides(quads);
    DisjointSets pieces(quads.size());
    std::vector<Index> across(4 * quads.size(), invalid_index);
    for (std::size_t i = 0; i < sides.size();) {
        std::size_t j = i + 1;
        while (j < sides.size() && sides[j].same_edge(sides[i]))
            ++j;
        if (j - i > 2)
            return invalid(edge_text(sides[i].low, sides[i].high) + " has " +
                               text(static_cast<Index>(j - i)) +
                               " faces: a layout must be a manifold",
                           sides[i + 2].halfedge / 4);
        if (j - i == 2) {
            across[sides[i].halfedge] = sides[i + 1].halfedge;
            across[sides[i + 1].halfedge] = sides[i].halfedge;
            pieces.join(sides[i].halfedge / 4, sides[i + 1].halfedge / 4);
        }
        i = j;
    }
    std::vector<char> seen(quads.size(), 0), turned(quads.size(), 0);
    std::vector<Index> pending;
    for (Index seed = 0; seed < quads.size(); ++seed) {
        if (seen[seed])
            continue;
        seen[seed] = 1;
        pending.assign(1, seed);
        while (!pending.empty()) {
            const Index q = pending.back();
            pending.pop_back();
            for (Index h = 4 * q; h < 4 * q + 4; ++h) {
                const Index g = across[h];
                if (g == invalid_index)
                    continue;
                const bool agree = from(quads, h) == to(quads, g);
                const char wanted = agree ? turned[q] : static_cast<char>(!turned[q]);
                if (!seen[g / 4]) {
                    seen[g / 4] = 1;
                    turned[g / 4] = wanted;
                    pending.push_back(g / 4);
                } else if (turned[g / 4] != wanted) {
                    return invalid("the faces cannot be turned to agree: " +
                                       edge_text(from(quads, h), to(quads, h)) +
                                       " closes a Moebius strip",
                                   g / 4);
                }
            }
        }
    }
    std::vector<Index> piece(quads.size());
    for (Index q = 0; q < quads.size(); ++q) {
        if (turned[q])
            std::swap(quads[q][1], quads[q][3]);
        piece[q] = pieces.find(q);
    }
    return piece;
}

// Every vertex must have one fan of faces: following the fan from any face must reach them all.
std::optional<Error> check_fans(const Quads& quads, Index vertex_count)
{
    const std::vector<Side> sides = sorted_sides(quads);
    std::vector<Index> twin(4 * quads.size(), invalid_index);
    for (std::size_t i = 0; i + 1 < sides.size(); ++i)
        if (sides[i].same_edge(sides[i + 1])) {
            twin[sides[i].halfedge] = sides[i + 1].halfedge;
            twin[sides[i + 1].halfedge] = sides[i].halfedge;
        }
    std::vector<Index> count(vertex_count, 0), start(vertex_count, invalid_index);
    for (Index h = 0; h < twin.size(); ++h) {
        const Index v = from(quads, h);
        ++count[v];
        // At the boundary begin where no face lies clockwise.
        if (start[v] == invalid_index || twin[h] == invalid_index)
            start[v] = h;
    }
    for (Index v = 0; v < vertex_count; ++v) {
        if (count[v] == 0)
            continue;
        Index reached = 0, h = start[v];
        do {
            ++reached;
            h = twin[h % 4 == 0 ? h + 3 : h - 1];
        } while (h != invalid_index && h != start[v]);
        if (reached != count[v])
            return invalid("vertex " + text(v) +
                               " joins faces that share no edge: a layout must be a manifold",
                           v);
    }
    return std::nullopt;
}

// A boundary vertex on the inside of a boundary edge.
std::optional<Error> check_junctions(const std::vector<Vec3>& positions, const Quads& quads)
{
    const std::vector<Side> sides = sorted_sides(quads);
    std::vector<Side> open;
    for (std::size_t i = 0; i < sides.size(); ++i)
        if ((i == 0 || !sides[i].same_edge(sides[i - 1])) &&
            (i + 1 == sides.size() || !sides[i].same_edge(sides[i + 1])))
            open.push_back(sides[i]);
    // Sorted along x, so that each edge only meets the vertices beside it.
    std::vector<Index> vertices;
    for (const Side& s : open)
        vertices.insert(vertices.end(), {s.low, s.high});
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    const auto left = [&positions](Index a, Index b) {
        return positions[a].x != positions[b].x ? positions[a].x < positions[b].x : a < b;
    };
    std::sort(vertices.begin(), vertices.end(), left);
    for (const Side& s : open) {
        const Vec3 a = positions[s.low], b = positions[s.high];
        const double length = norm(b - a), slack = on_edge * length;
        const double least = std::min(a.x, b.x) - slack, most = std::max(a.x, b.x) + slack;
        auto v = std::lower_bound(vertices.begin(), vertices.end(), least,
                                  [&positions](Index i, double x) { return positions[i].x < x; });
        for (; v != vertices.end() && positions[*v].x <= most; ++v) {
            const Vec3 p = positions[*v] - a;
            const double along = dot(p, b - a) / length;
            if (along > slack && along < length - slack &&
                norm(p - (along / length) * (b - a)) < slack)
                return invalid("vertex " + text(*v) + " lies on " + edge_text(s.low, s.high) +
                                   " of face " + text(s.halfedge / 4) +
                                   " but is no corner of it: a layout must have no T-junctions",
                               *v);
        }
    }
    return std::nullopt;
}

} // namespace

Result<std::vector<QuadMesh>> split_quads(const PolygonMesh& mesh)
{
    Result<Quads> quads = read_quads(mesh);
    if (!quads)
        return quads.error();
    weld_boundary(mesh.positions, *quads);
    if (std::optional<Error> bad = check_corners(*quads))
        return *bad;
    const Result<std::vector<Index>> piece = orient(*quads);
    if (!piece)
        return piece.error();
    if (std::optional<Error> bad = check_junctions(mesh.positions, *quads))
        return *bad;
    if (std::optional<Error> bad = check_fans(*quads, static_cast<Index>(mesh.positions.size())))
        return *bad;

    std::vector<QuadMesh> result;
    std::vector<Index> place(quads->size(), invalid_index); // Of a piece, by its first face.
    std::vector<Index> number(mesh.positions.size(), invalid_index);
    for (Index q = 0; q < quads->size(); ++q) {
        Index& at = place[(*piece)[q]];
        if (at == invalid_index) {
            at = static_cast<Index>(result.size());
            result.emplace_back();
        }
        QuadMesh& part = result[at];
        std::array<Index, 4> corners{};
        for (int k = 0; k < 4; ++k) {
            const Index v = (*quads)[q][k];
            if (number[v] == invalid_index) {
                number[v] = static_cast<Index>(part.positions.size());
                part.positions.push_back(mesh.positions[v]);
                part.source_vertex.push_back(v);
            }
            corners[k] = number[v];
        }
        part.quads.push_back(corners);
        part.source_face.push_back(q);
    }
    return result;
}

} // namespace bot2nurbs
