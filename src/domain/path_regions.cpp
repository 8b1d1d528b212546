// SPDX-License-Identifier: MIT
#include "domain/path_arrangement.h"

#include "core/disjoint_sets.h"

#include <algorithm>
#include <string>
#include <utility>

namespace bot2nurbs {

namespace {

std::string number(std::size_t i)
{
    return std::to_string(i);
}

} // namespace

// Chords cut a face into cells: the cell of a chord lies just inside it (towards the border between
// its ends), one more is outside all chords. Cells are joined across the stretches of carrier edges
// between crossings; what is joined is a region. A region is an open surface whose cells, stretches
// and vertices give its Euler characteristic: 1 for a disk and only for a disk.
void PathArrangement::check_regions(DefectList& defects) const
{
    const QuadComplex& complex = domain_.complex;
    const auto outer_cell = [&](Index f) { return first_chord_[f] + f; };
    const auto chord_cell = [&](Index f, Index c) {
        return outer_cell(f) + 1 + c - first_chord_[f];
    };
    const Index cells = first_chord_.back() + mesh_.face_count();

    // Per stretch of a carrier edge its cells on both sides.
    std::vector<std::size_t> first_stretch(mesh_.halfedge_count() + 1, 0);
    for (Index h = 0; h < mesh_.halfedge_count(); ++h)
        first_stretch[h + 1] = first_stretch[h] + crossings_[mesh_.edge(h)] + 1;
    std::vector<Index> stretch_cell(first_stretch.back(), invalid_index); // By halfedge and order.
    std::vector<Index> parent(cells, invalid_index);                      // Cell around a chord's.
    std::vector<Index> vertex_cell(mesh_.vertex_count(), invalid_index);
    for (Index f = 0; f < mesh_.face_count(); ++f) {
        std::vector<Index> stack{outer_cell(f)};
        sweep(
            f,
            [&](Index c) {
                parent[chord_cell(f, c)] = stack.back();
                stack.push_back(chord_cell(f, c));
            },
            [&](Index) { stack.pop_back(); },
            [&](Index slot, Index rank) {
                const Index h = 3 * f + slot / 2;
                stretch_cell[first_stretch[h] + (slot % 2 ? rank + 1 : 0)] = stack.back();
                if (slot % 2 == 0)
                    vertex_cell[mesh_.from(h)] = stack.back();
            });
    }

    std::vector<char> cut_edge(mesh_.halfedge_count(), 0), cut_vertex(mesh_.vertex_count(), 0);
    for (const Step& step : steps_)
        if (step.face == invalid_index)
            cut_edge[mesh_.edge(step.halfedge)] = 1;
    for (const auto& path : nodes_)
        for (const Node& node : path)
            if (node.is_vertex())
                cut_vertex[node.vertex] = 1;

    DisjointSets regions(cells);
    std::vector<std::size_t> inner_stretches;
    for (Index h = 0; h < mesh_.halfedge_count(); ++h) {
        const Index twin = mesh_.twin(h);
        if (mesh_.edge(h) != h || cut_edge[h] || twin == invalid_index)
            continue;
        for (Index i = 0; i <= crossings_[h]; ++i) {
            const std::size_t here = first_stretch[h] + i;
            regions.join(stretch_cell[here], stretch_cell[first_stretch[twin] + crossings_[h] - i]);
            inner_stretches.push_back(here);
        }
    }

    // Euler characteristic and quad of each region, kept at its root.
    std::vector<long> euler(cells, 0);
    std::vector<Index> quad(cells, invalid_index);
    for (Index c = 0; c < cells; ++c)
        ++euler[regions.find(c)];
    for (const std::size_t s : inner_stretches)
        --euler[regions.find(stretch_cell[s])];
    for (Index v = 0; v < mesh_.vertex_count(); ++v)
        if (!cut_vertex[v])
            ++euler[regions.find(vertex_cell[v])];

    std::vector<Index> region_of(complex.quad_count(), invalid_index);
    std::vector<char> faulty(complex.quad_count(), 0);
    const auto claim = [&](Index cell, Index q) {
        const Index r = regions.find(cell);
        if (quad[r] == invalid_index)
            quad[r] = q;
        if (region_of[q] == invalid_index)
            region_of[q] = r;
        if ((quad[r] != q || region_of[q] != r) && !faulty[q]) {
            faulty[q] = 1;
            defects.add("region",
                        "the paths around quad " + number(q) + " do not enclose one region alone",
                        q);
        }
    };
    for (const Step& step : steps_) {
        const Index h = complex.halfedge_of_edge(step.edge), twin = complex.twin(h);
        Index left = invalid_index, right = invalid_index;
        if (step.face == invalid_index) {
            const Index other = mesh_.twin(step.halfedge);
            left = stretch_cell[first_stretch[step.halfedge]];
            if (other != invalid_index)
                right = stretch_cell[first_stretch[other]];
            if (step.reversed)
                std::swap(left, right);
        } else {
            // The chord's own cell is to the right of one who goes from low to high.
            const Chord wanted{std::min(step.from, step.to), std::max(step.from, step.to),
                               static_cast<Index>(&step - steps_.data())};
            const auto begin = chords_.begin() + first_chord_[step.face];
            const auto end = chords_.begin() + first_chord_[step.face + 1];
            const auto it = std::lower_bound(begin, end, wanted, chord_before);
            right = chord_cell(step.face, static_cast<Index>(it - chords_.begin()));
            left = parent[right];
            if (step.to < step.from)
                std::swap(left, right);
        }
        if (left != invalid_index)
            claim(left, QuadComplex::quad_of(h));
        if (right != invalid_index && twin != invalid_index)
            claim(right, QuadComplex::quad_of(twin));
    }
    for (Index q = 0; q < complex.quad_count(); ++q)
        if (!faulty[q] && euler[region_of[q]] != 1)
            defects.add("region", "the region of quad " + number(q) + " is not a disk", q);
}

} // namespace bot2nurbs
