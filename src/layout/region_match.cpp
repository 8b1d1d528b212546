// SPDX-License-Identifier: MIT
#include "layout/region_match.h"

namespace bot2nurbs {

Index DrawnEdges::end_at(Index h) const
{
    const Index e = complex.edge(h);
    return PathWeb::end_of(path_of[e], complex.halfedge_of_edge(e) != h);
}

Index DrawnEdges::sector_at(Index h) const
{
    Index g = h;
    do {
        if (is_drawn(complex.edge(g)))
            return end_at(g);
        g = QuadComplex::next(complex.twin(g));
    } while (g != h);
    return invalid_index;
}

RegionMatch::RegionMatch(const DrawnEdges& drawn)
    : drawn_(drawn), quad_mark_(drawn.complex.quad_count(), 0),
      vertex_mark_(drawn.web.mesh().vertex_count(), 0)
{
    const std::size_t sectors =
        2 * std::size_t{drawn.complex.edge_count()} + drawn.complex.vertex_count();
    sector_mark_.assign(sectors, 0);
    found_mark_.assign(sectors, 0);
}

std::size_t RegionMatch::sector_number(Index sector, Index vertex) const
{
    return sector != invalid_index ? sector : 2 * std::size_t{drawn_.complex.edge_count()} + vertex;
}

RegionMatch::QuadFlood RegionMatch::start(Index quad)
{
    QuadFlood flood;
    flood.stamp = ++stamp_;
    quad_mark_[quad] = flood.stamp;
    flood.pending.push_back(quad);
    return flood;
}

RegionMatch::Step RegionMatch::step(QuadFlood& flood, std::uint32_t other)
{
    if (flood.next == flood.pending.size())
        return Step::done;
    const QuadComplex& complex = drawn_.complex;
    const Index q = flood.pending[flood.next++];
    ++flood.pieces;
    for (Index h = 4 * q; h < 4 * q + 4; ++h) {
        const Index sector = drawn_.sector_at(h), v = complex.from(h);
        std::uint32_t& mark = sector_mark_[sector_number(sector, v)];
        if (mark != flood.stamp) {
            mark = flood.stamp;
            ++flood.sectors;
            flood.inside += sector == invalid_index;
        }
        if (drawn_.is_drawn(complex.edge(h)))
            continue;
        ++flood.sides;
        const Index neighbour = QuadComplex::quad_of(complex.twin(h));
        if (quad_mark_[neighbour] == other)
            return Step::met;
        if (quad_mark_[neighbour] != flood.stamp) {
            quad_mark_[neighbour] = flood.stamp;
            flood.pending.push_back(neighbour);
        }
    }
    return Step::on;
}

RegionMatch::CellFlood RegionMatch::start(const PathWeb::Wedge& seed)
{
    CellFlood flood;
    flood.stamp = ++stamp_;
    flood.pending.push_back(drawn_.web.border_start(seed));
    side_mark_.resize(2 * std::size_t{drawn_.web.stretch_count()}, 0);
    return flood;
}

RegionMatch::Step RegionMatch::step(CellFlood& flood, std::uint32_t other, std::uint32_t allowed)
{
    const PathWeb& web = drawn_.web;
    const auto side_of = [&web](const PathWeb::Stretch& s) {
        return 2 * std::size_t{web.number(s)} + (web.mesh().edge(s.halfedge) != s.halfedge);
    };
    // The cell of the seed may have no stretch to recognise it by.
    while (!flood.at_seed && !flood.pending.empty() &&
           side_mark_[side_of(flood.pending.back())] == flood.stamp)
        flood.pending.pop_back();
    if (flood.pending.empty())
        return Step::done;
    const PathWeb::Stretch start = flood.pending.back();
    flood.pending.pop_back();
    flood.at_seed = false;
    ++flood.pieces;
    bool met = false;
    web.walk_cell(
        start,
        [&](const PathWeb::Stretch& s) {
            const std::size_t side = side_of(s);
            met =
                met || (other != 0 && (side_mark_[side] == other || side_mark_[side ^ 1] == other));
            side_mark_[side] = flood.stamp;
            ++flood.sides;
            if (side_mark_[side ^ 1] != flood.stamp)
                flood.pending.push_back(web.across(s));
        },
        [&](const PathWeb::Wedge& w) {
            const Index v = web.mesh().from(w.halfedge);
            Index sector = invalid_index;
            if (web.is_site(v)) {
                sector = web.sector_of(w);
                const std::size_t n = sector_number(sector, web.site_number(v));
                met = met || (allowed != 0 && sector_mark_[n] != allowed);
                if (found_mark_[n] != flood.stamp) {
                    found_mark_[n] = flood.stamp;
                    ++flood.sectors;
                }
            }
            if (sector == invalid_index && !web.on_curve(v) && vertex_mark_[v] != flood.stamp) {
                vertex_mark_[v] = flood.stamp;
                ++flood.inside;
            }
        });
    return met ? Step::met : Step::on;
}

bool RegionMatch::fits(Index edge)
{
    const QuadComplex& complex = drawn_.complex;
    const Index h = complex.halfedge_of_edge(edge), path = drawn_.path_of[edge];
    QuadFlood quads[2] = {start(QuadComplex::quad_of(h)),
                          start(QuadComplex::quad_of(complex.twin(h)))};
    Step reached = Step::on;
    int side = 1;
    while (reached == Step::on) {
        side = 1 - side;
        reached = step(quads[side], quads[1 - side].stamp);
    }
    const PathWeb::Wedge seeds[2] = {drawn_.web.left_of(path), drawn_.web.right_of(path)};
    if (reached == Step::done) {
        CellFlood cells = start(seeds[side]);
        do
            reached = step(cells, 0, quads[side].stamp);
        while (reached == Step::on);
        return reached == Step::done && cells.sectors == quads[side].sectors &&
               cells.euler() == quads[side].euler();
    }
    CellFlood cells[2] = {start(seeds[0]), start(seeds[1])};
    do {
        side = 1 - side;
        reached = step(cells[side], cells[1 - side].stamp, 0);
    } while (reached == Step::on);
    return reached == Step::met;
}

} // namespace bot2nurbs
