// SPDX-License-Identifier: MIT
#include "refine/choose_marks.h"

#include "bot2nurbs/refine_domain.h"
#include "refine/grade_marks.h"

#include <algorithm>

namespace bot2nurbs {

namespace {

// Patches nearer than this share of the worst one are not cut: halving both sides of a bicubic
// patch lowers its distance by up to sixteen, so the worst ones will take another round anyway.
constexpr double left_share = 0.1;
// Where the mean square change of the distance along one direction is this many times that along
// the other, halving the other would gain nothing.
constexpr double direction_ratio = 4.0;
// No patch is made narrower where it is this many times longer already.
constexpr double most_aspect = 3.0;

// Number of quads after cutting along closed marks.
Index refined_count(const QuadComplex& complex, const std::vector<char>& marks)
{
    Index count = 0;
    for (Index q = 0; q < complex.quad_count(); ++q) {
        std::array<bool, 4> marked{};
        for (Index s = 0; s < 4; ++s)
            marked[s] = marks[complex.edge(4 * q + s)] != 0;
        const auto sides = std::count(marked.begin(), marked.end(), true);
        count += sides == 0 ? 1 : sides == 4 ? 4 : marked[0] == marked[2] ? 2 : 3;
    }
    return count;
}

// Distances between the corners of a quad along u and along v.
std::array<double, 2> widths(const QuadDomain& domain, Index quad)
{
    const auto corner = [&](Index k) {
        return domain.carrier.mesh.position(domain.vertices[domain.complex.quad(quad)[k]]);
    };
    return {norm(corner(1) - corner(0)) + norm(corner(2) - corner(3)),
            norm(corner(3) - corner(0)) + norm(corner(2) - corner(1))};
}

// Per edge: the distance between its ends.
std::vector<double> edge_lengths(const QuadDomain& domain)
{
    const QuadComplex& complex = domain.complex;
    const auto place = [&](Index v) { return domain.carrier.mesh.position(domain.vertices[v]); };
    std::vector<double> lengths;
    lengths.reserve(complex.edge_count());
    for (Index e = 0; e < complex.edge_count(); ++e) {
        const Index h = complex.halfedge_of_edge(e);
        lengths.push_back(norm(place(complex.to(h)) - place(complex.from(h))));
    }
    return lengths;
}

// Marks the sides of a patch that halving it asks for.
void mark(const Trial& trial, Index quad, std::vector<char>& marks)
{
    const auto [change_u, change_v] = trial.patches[quad].change;
    const auto [width_u, width_v] = widths(trial.domain, quad);
    const bool only_u = change_u > direction_ratio * change_v && width_v < most_aspect * width_u;
    const bool only_v = change_v > direction_ratio * change_u && width_u < most_aspect * width_v;
    for (Index s = 0; s < 4; ++s)
        if (s % 2 == 0 ? !only_v : !only_u)
            marks[trial.domain.complex.edge(4 * quad + s)] = 1;
}

} // namespace

std::vector<char> choose_marks(const Trial& trial, Index max_patches)
{
    const QuadComplex& complex = trial.domain.complex;
    // Patches that are only undecided, or fold, wait until none is known to exceed the tolerance.
    const bool any = std::any_of(trial.patches.begin(), trial.patches.end(),
                                 [](const PatchError& patch) { return patch.exceeds; });
    std::vector<Index> cut;
    for (Index q = 0; q < complex.quad_count(); ++q)
        if (any ? trial.patches[q].exceeds : trial.patches[q].beyond || trial.patches[q].folded)
            cut.push_back(q);
    std::stable_sort(cut.begin(), cut.end(), [&](Index a, Index b) {
        return trial.patches[a].distance > trial.patches[b].distance;
    });
    const double least = cut.empty() ? 0.0 : left_share * trial.patches[cut[0]].distance;
    while (any && trial.patches[cut.back()].distance < least)
        cut.pop_back();

    const MarkCosts costs = MarkCosts::of_regularity(complex, corner_angles(trial.charts));
    const std::vector<double> lengths = edge_lengths(trial.domain);
    for (; !cut.empty(); cut.resize(cut.size() / 2)) {
        std::vector<char> marks(complex.edge_count(), 0);
        for (const Index q : cut)
            mark(trial, q, marks);
        grade_marks(complex, lengths, cut, marks);
        marks = close_marks(complex, marks, costs);
        if (refined_count(complex, marks) <= max_patches)
            return marks;
    }
    return {};
}

} // namespace bot2nurbs
