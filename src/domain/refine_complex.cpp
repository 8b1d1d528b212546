// SPDX-License-Identifier: MIT
#include "bot2nurbs/refine_domain.h"

#include "core/predicates.h"
#include "domain/quad_marks.h"

#include <algorithm>
#include <cassert>
#include <string>

namespace bot2nurbs {

namespace {

// One template in a frame where the marked sides are 0 and 2, 0 and 1, or all. Corners of pieces
// are numbered 0 to 3 for the quad's own, 4 to 7 for the middles of sides 0 to 3, 8 for the centre.
using PieceCorners = std::vector<std::array<Index, 4>>;

const PieceCorners whole{{0, 1, 2, 3}};
const PieceCorners two{{0, 4, 6, 3}, {4, 1, 2, 6}};
const PieceCorners three{{0, 4, 8, 3}, {4, 1, 5, 8}, {8, 5, 2, 3}};
const PieceCorners four{{0, 4, 8, 7}, {4, 1, 5, 8}, {8, 5, 2, 6}, {7, 8, 6, 3}};

const std::array<Vec2, 9> places{{{0.0, 0.0},
                                  {1.0, 0.0},
                                  {1.0, 1.0},
                                  {0.0, 1.0},
                                  {0.5, 0.0},
                                  {1.0, 0.5},
                                  {0.5, 1.0},
                                  {0.0, 0.5},
                                  {0.5, 0.5}}};

// A corner of the frame that is turned by `turns` sides, in the quad's own numbers.
Index turned(Index corner, Index turns)
{
    return corner == 8 ? 8 : corner < 4 ? (corner + turns) % 4 : 4 + (corner + turns) % 4;
}

struct Template {
    const PieceCorners* pieces;
    Index turns;
};

Template template_of(const QuadComplex& complex, const std::vector<char>& marks, Index q)
{
    switch (marked_sides(complex, marks, q)) {
    case 0: return {&whole, 0};
    case 4: return {&four, 0};
    default: break;
    }
    if (const auto corner = turned_corner(complex, marks, q))
        return {&three, (*corner + 1) % 4};
    return {&two, marks[complex.edge(4 * q)] ? 0u : 1u};
}

double mix(double a, double b, double t)
{
    return (1.0 - t) * a + t * b;
}

} // namespace

std::optional<Index> turned_corner(const QuadComplex& complex, const std::vector<char>& marks,
                                   Index quad)
{
    for (Index k = 0; k < 4; ++k) {
        const auto marked = [&](Index s) { return marks[complex.edge(4 * quad + (k + s) % 4)]; };
        if (!marked(0) && marked(1) && marked(2) && !marked(3))
            return k;
    }
    return std::nullopt;
}

Index marked_sides(const QuadComplex& complex, const std::vector<char>& marks, Index quad)
{
    Index count = 0;
    for (Index s = 0; s < 4; ++s)
        count += marks[complex.edge(4 * quad + s)] != 0;
    return count;
}

DomainPoint PieceMap::to_parent(const DomainPoint& place) const
{
    const QuadPiece& piece = pieces[place.quad];
    const auto& c = piece.corners;
    const auto at = [&](double Vec2::*axis) {
        return mix(mix(c[0].*axis, c[1].*axis, place.u), mix(c[3].*axis, c[2].*axis, place.u),
                   place.v);
    };
    return {piece.parent, at(&Vec2::x), at(&Vec2::y)};
}

DomainPoint PieceMap::to_piece(const DomainPoint& place) const
{
    const Vec2 p{place.u, place.v};
    Index found = first_piece[place.quad];
    for (; found + 1 < first_piece[place.quad + 1]; ++found) {
        const auto& c = pieces[found].corners;
        bool inside = true;
        for (int k = 0; k < 4; ++k)
            inside = inside && orient2d(c[k], c[(k + 1) % 4], p) >= 0;
        if (inside)
            break;
    }
    // All pieces are trapezoids along an axis: across the parallel sides first, then along them.
    const auto& c = pieces[found].corners;
    const auto share = [](double x, double low, double high) {
        return std::clamp((x - low) / (high - low), 0.0, 1.0);
    };
    DomainPoint result{found, 0.0, 0.0};
    if (c[0].x == c[3].x && c[1].x == c[2].x) {
        result.u = share(p.x, c[0].x, c[1].x);
        result.v = share(p.y, mix(c[0].y, c[1].y, result.u), mix(c[3].y, c[2].y, result.u));
    } else {
        result.v = share(p.y, c[0].y, c[3].y);
        result.u = share(p.x, mix(c[0].x, c[3].x, result.v), mix(c[1].x, c[2].x, result.v));
    }
    return result;
}

Result<RefinedComplex> refine_complex(const QuadComplex& complex, const std::vector<char>& marks)
{
    assert(marks.size() == complex.edge_count());
    RefinedComplex refined;
    Index vertices = complex.vertex_count();
    refined.middle.assign(complex.edge_count(), invalid_index);
    for (Index e = 0; e < complex.edge_count(); ++e)
        if (marks[e])
            refined.middle[e] = vertices++;
    refined.center.assign(complex.quad_count(), invalid_index);
    std::vector<std::array<Index, 4>> quads;
    for (Index q = 0; q < complex.quad_count(); ++q) {
        if (marked_sides(complex, marks, q) % 2 != 0)
            return Error{ErrorCode::bad_option,
                         "quad " + std::to_string(q) + " has an odd number of marked edges", q};
        const Template pattern = template_of(complex, marks, q);
        if (pattern.pieces->size() > 2)
            refined.center[q] = vertices++;
        refined.map.first_piece.push_back(static_cast<Index>(quads.size()));
        for (const auto& corners : *pattern.pieces) {
            std::array<Index, 4> quad{};
            QuadPiece piece;
            piece.parent = q;
            // Corner k of the frame becomes corner k + turns, so that u stays roughly u.
            for (Index k = 0; k < 4; ++k) {
                const Index own = turned(corners[k], pattern.turns), to = (k + pattern.turns) % 4;
                piece.corners[to] = places[own];
                quad[to] = own == 8  ? refined.center[q]
                           : own < 4 ? complex.quad(q)[own]
                                     : refined.middle[complex.edge(4 * q + own - 4)];
            }
            quads.push_back(quad);
            refined.map.pieces.push_back(piece);
        }
    }
    refined.map.first_piece.push_back(static_cast<Index>(quads.size()));

    std::vector<std::pair<Index, Index>> creases;
    for (Index e = 0; e < complex.edge_count(); ++e) {
        if (!complex.is_crease(e))
            continue;
        const Index h = complex.halfedge_of_edge(e), a = complex.from(h), b = complex.to(h);
        if (marks[e]) {
            creases.emplace_back(a, refined.middle[e]);
            creases.emplace_back(refined.middle[e], b);
        } else {
            creases.emplace_back(a, b);
        }
    }
    std::vector<Index> corners;
    for (Index v = 0; v < complex.vertex_count(); ++v)
        if (complex.is_corner(v))
            corners.push_back(v);
    Result<QuadComplex> built =
        QuadComplex::build(vertices, std::move(quads), std::move(creases), std::move(corners));
    if (!built)
        return built.error();
    refined.complex = std::move(*built);
    return refined;
}

} // namespace bot2nurbs
