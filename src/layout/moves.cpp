// SPDX-License-Identifier: MIT
#include "layout/moves.h"

#include <algorithm>
#include <limits>

namespace bot2nurbs {

namespace {

using Side = PatchComplex::Side;

// A vertex this near to the middle of its star, over the star's radius, stays.
constexpr double middle_enough = 0.12;

// A move before any map is made: the disk and what changes in it.
struct Sketch {
    std::vector<Index> faces;
    std::vector<Side> border;
    std::vector<Chord> chords;
    std::vector<std::pair<Index, int>> valences;
    Index gone = invalid_index;
};

// Position of a vertex among the corners of a border; border.size() when it is none.
Index corner_at(const PatchComplex& complex, const std::vector<Side>& border, Index vertex)
{
    Index i = 0;
    while (i < border.size() && complex.start(border[i]) != vertex)
        ++i;
    return i;
}

std::optional<Sketch> sketch_of_path(const ComplexState& state, const Move& move)
{
    const PatchComplex& complex = state.complex;
    const PatchComplex::Path& path = complex.paths()[move.at.path];
    if (complex.is_fixed(move.at.path))
        return std::nullopt;
    Sketch s;
    s.faces = {path.left, path.right};
    const auto border = complex.border(s.faces);
    const Index n = 2 * state.sides - 2;
    if (!border || border->size() != n)
        return std::nullopt;
    s.border = *border;
    const Index a = path.geometry.a, b = path.geometry.b;
    const Index turn = move.kind == Move::Kind::rotate ? move.turn : 0;
    const Index from = (corner_at(complex, s.border, a) + turn) % n;
    const Index to = (from + state.sides - 1) % n;
    s.chords = {{from, to}};
    if (turn != 0)
        s.valences = {
            {a, -1}, {b, -1}, {complex.start(s.border[from]), 1}, {complex.start(s.border[to]), 1}};
    return s;
}

std::optional<Sketch> sketch_of_collapse(const ComplexState& state, const Move& move)
{
    // The quad to the left of `at`: v, e0, w, e1. v goes; its other edges move to w.
    const PatchComplex& complex = state.complex;
    const std::vector<Side> star = complex.star(move.at);
    const Index v = complex.start(move.at), n = static_cast<Index>(star.size());
    if (complex.is_fixed_vertex(move.at) || n < 3)
        return std::nullopt;
    const Side across = complex.next(move.at);
    const Index e0 = complex.start(across), w = complex.end(across);
    const Index e1 = complex.start(complex.previous(move.at));
    if (w == v)
        return std::nullopt;
    Sketch s;
    s.faces = complex.faces_around(move.at);
    const auto border = complex.border(s.faces);
    if (!border || border->size() != 2 * n)
        return std::nullopt;
    s.border = *border;
    const Index at_w = corner_at(complex, s.border, w);
    if (at_w == 2 * n)
        return std::nullopt;
    for (Index k = 3; k + 2 < 2 * n; k += 2)
        s.chords.emplace_back(at_w, (at_w + k) % (2 * n));
    s.valences = {{e0, -1}, {e1, -1}, {w, static_cast<int>(n) - 2}};
    s.gone = v;
    return s;
}

std::optional<Sketch> sketch_of_merge(const ComplexState& state, const Move& move)
{
    const PatchComplex& complex = state.complex;
    const Index v = complex.start(move.at);
    if (!state.valences.is_inside(v) || !state.valences.is_degenerate(v) ||
        complex.is_fixed_vertex(move.at))
        return std::nullopt;
    Sketch s;
    s.faces = complex.faces_around(move.at);
    const auto border = complex.border(s.faces);
    if (!border || border->size() != 4)
        return std::nullopt;
    s.border = *border;
    s.valences = {{complex.end(move.at), -1}, {complex.start(complex.previous(move.at)), -1}};
    s.gone = v;
    return s;
}

std::optional<Sketch> sketch_of_relocation(const ComplexState& state, const Move& move)
{
    const PatchComplex& complex = state.complex;
    const Index v = complex.start(move.at);
    if (complex.is_fixed_vertex(move.at))
        return std::nullopt;
    const std::vector<Side> star = complex.star(move.at);
    const Index n = static_cast<Index>(star.size());
    Sketch s;
    s.faces = complex.faces_around(move.at);
    const auto border = complex.border(s.faces);
    if (!border || border->size() != (state.sides - 2) * n)
        return std::nullopt;
    s.border = *border;
    for (Index i = 0; i < s.border.size(); ++i)
        for (const Side& spoke : star)
            if (complex.end(spoke) == complex.start(s.border[i]))
                s.chords.emplace_back(i, invalid_index);
    if (s.chords.size() != n)
        return std::nullopt;
    s.gone = v;
    return s;
}

std::optional<Sketch> sketch_of(const ComplexState& state, const Move& move)
{
    if (!state.complex.paths()[move.at.path].alive)
        return std::nullopt;
    switch (move.kind) {
    case Move::Kind::rotate:
    case Move::Kind::straighten: return sketch_of_path(state, move);
    case Move::Kind::collapse: return sketch_of_collapse(state, move);
    case Move::Kind::merge: return sketch_of_merge(state, move);
    case Move::Kind::relocate: return sketch_of_relocation(state, move);
    }
    return std::nullopt;
}

// The mesh vertex nearest to the middle of a mapped star, unless the centre is near enough to it.
Index middle_vertex(const MappedDisk& disk, Index center)
{
    const Overlay& overlay = disk.overlay;
    Vec2 middle;
    for (const Index c : overlay.corners)
        middle = middle + (1.0 / static_cast<double>(overlay.side_count())) * disk.uv[c];
    Index best = invalid_index;
    double nearest = std::numeric_limits<double>::infinity(), now = nearest;
    for (Index i = overlay.boundary_count; i < overlay.vertices.size(); ++i) {
        const Index v = overlay.vertices[i].mesh_vertex;
        if (v == invalid_index)
            continue;
        const double distance = norm(disk.uv[i] - middle);
        if (distance < nearest) {
            nearest = distance;
            best = v;
        }
        if (v == center)
            now = distance;
    }
    const double radius = norm(disk.uv[overlay.corners[0]] - middle);
    return now - nearest < middle_enough * radius ? invalid_index : best;
}

bool adjacent(const PatchComplex& complex, const Side& at_a, Index b)
{
    for (const Side& s : complex.star(at_a))
        if (complex.end(s) == b)
            return true;
    return false;
}

double sum_of_changes(const ComplexState& state, const std::vector<std::pair<Index, int>>& changes,
                      Index gone)
{
    double sum = 0.0;
    for (const auto& [v, by] : changes)
        sum += state.valences.change(v, by);
    if (gone != invalid_index)
        sum -= state.valences.cost(gone, state.valences[gone]);
    return sum;
}

bool allowed(const ComplexState& state, const std::vector<Index>& faces,
             const std::vector<Side>& border, const std::vector<Chord>& chords,
             const std::vector<std::pair<Index, int>>& changes, bool same_edges)
{
    for (const Index f : faces)
        if (!state.complex.faces()[f].alive() || state.complex.faces()[f].frozen)
            return false;
    for (const auto& [v, by] : changes)
        if (by > 0 ? !state.valences.may_gain(v, by) : !state.valences.may_lose(v))
            return false;
    if (same_edges)
        return true;
    for (const auto& [a, b] : chords)
        if (adjacent(state.complex, border[a], state.complex.start(border[b])) ||
            !state.complex.may_join(state.complex.start(border[a]), state.complex.start(border[b])))
            return false;
    return true;
}

} // namespace

double valence_change(const ComplexState& state, const Proposal& proposal)
{
    const bool moved = proposal.moved_to != invalid_index;
    return sum_of_changes(state, proposal.valences, moved ? invalid_index : proposal.gone);
}

bool is_possible(const ComplexState& state, const Proposal& proposal)
{
    return allowed(state, proposal.change.faces, proposal.change.border, proposal.change.chords,
                   proposal.valences, proposal.valences.empty());
}

std::optional<Proposal> propose(const ComplexState& state, const Move& move, double credit,
                                double least_gain, OverlayBuilder& builder)
{
    std::optional<Sketch> sketch = sketch_of(state, move);
    if (!sketch)
        return std::nullopt;
    const bool relocation = move.kind == Move::Kind::relocate;
    if (!allowed(state, sketch->faces, sketch->border, sketch->chords, sketch->valences,
                 sketch->valences.empty()))
        return std::nullopt;
    double before = 0.0, size = 0.0;
    for (const Index f : sketch->faces) {
        before += state.energies[f].energy;
        size += state.energies[f].size;
    }
    const double terms =
        sum_of_changes(state, sketch->valences, relocation ? invalid_index : sketch->gone);
    const double limit = before - terms + credit - least_gain;
    // However the disk is divided, distortion is at least one and sizes add up to the same.
    const double count = static_cast<double>(sketch->chords.size()) + (relocation ? 0.0 : 1.0);
    if (!(limit > size * size / count))
        return std::nullopt;

    Proposal p;
    std::optional<PatchComplex::Change> change;
    if (relocation) {
        const auto disk = map_disk(builder, state.complex.geometry(sketch->border));
        p.moved_to = disk ? middle_vertex(*disk, sketch->gone) : invalid_index;
        if (p.moved_to == invalid_index)
            return std::nullopt;
        change = state.complex.plan(std::move(sketch->faces), std::move(sketch->border),
                                    std::move(sketch->chords), *disk, p.moved_to);
    } else {
        change = state.complex.plan(std::move(sketch->faces), std::move(sketch->border),
                                    std::move(sketch->chords), builder);
    }
    if (!change)
        return std::nullopt;
    p.change = std::move(*change);
    p.valences = std::move(sketch->valences);
    p.gone = sketch->gone;
    double after = 0.0;
    for (const auto& border : state.complex.faces_after(p.change)) {
        p.energies.push_back(face_energy(border, state.metric, builder));
        after += p.energies.back().energy;
        if (!(after < limit))
            return std::nullopt;
    }
    p.energy_change = after - before;
    return p;
}

} // namespace bot2nurbs
