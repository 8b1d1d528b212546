// SPDX-License-Identifier: MIT
#include "bot2nurbs/refine_domain.h"

#include "core/perfect_matching.h"
#include "domain/quad_marks.h"

#include <algorithm>
#include <cassert>

namespace bot2nurbs {

namespace {

// Costs of MarkCosts::of_regularity, in new quads. Two opposite marks make one and four make three:
// with costs that add up, something between one and half of three for each.
constexpr double halving = 1.25;
constexpr double turning = 2.0;
// An irregular vertex is where a surface is least smooth and fits worst. Times the square of the
// number of quads too few or too many.
constexpr double irregularity = 0.5;

// Of turns that must not be: more than halving all sides of a large domain, and still a million
// times coarser than the resolution of matching costs.
constexpr double out_of_reach = 1e6;

// The quads at a vertex between two sharp edges, or all of them where there are none, and how many
// there should be.
struct Sectors {
    Index count = 1;
    double wanted = 4.0; // Four round a smooth vertex, else one for every right angle.

    double irregular(double more) const
    {
        const double d = count + more - wanted;
        return irregularity * d * d;
    }
};

// Those around the start of halfedge h.
Sectors sectors_around(const QuadComplex& complex, Index h,
                       const std::vector<double>& corner_angles)
{
    const auto angle_at = [&](Index g) { return corner_angles.empty() ? 0.0 : corner_angles[g]; };
    Sectors sectors;
    double angle = angle_at(h);
    for (Index g = h; !complex.is_sharp(complex.edge(QuadComplex::prev(g)));) {
        g = complex.rotate_ccw(g);
        if (g == h)
            return sectors; // No sharp edge.
        ++sectors.count;
        angle += angle_at(g);
    }
    for (Index g = h; !complex.is_sharp(complex.edge(g));) {
        g = QuadComplex::next(complex.twin(g));
        ++sectors.count;
        angle += angle_at(g);
    }
    constexpr double right_angle = 1.57079632679489662;
    sectors.wanted = corner_angles.empty() ? 2.0 : std::max(1.0, angle / right_angle);
    return sectors;
}

// The marking as a perfect matching. Node h stands for halfedge h of the complex, "the side of the
// quad". A side matched with its twin is marked; two sides of one quad matched with each other are
// not. So in every quad an even number is marked. The outside of a boundary is a quad with any
// number of sides, cut up into a chain of small ones.
class MarkingProblem {
public:
    MarkingProblem(const QuadComplex& complex, const std::vector<char>& marks)
        : complex_(complex), marks_(marks), number_(complex.halfedge_count(), invalid_index)
    {
        // Sides that are marked already are not nodes.
        for (Index h = 0; h < complex.halfedge_count(); ++h)
            if (!marks[complex.edge(h)])
                number_[h] = nodes_++;
        for (Index e = 0; e < complex.edge_count(); ++e) {
            const Index h = complex.halfedge_of_edge(e);
            if (!marks[e] && !complex.is_boundary_edge(e)) {
                edges_.push_back({number_[h], number_[complex.twin(h)], 0.0});
                marking_.push_back(e);
            }
        }
        add_outside();
    }

    std::vector<char> solve(const MarkCosts& costs)
    {
        const std::size_t count = edges_.size();
        for (Index q = 0; q < complex_.quad_count(); ++q)
            add_quad(q, costs);
        const auto matched = cheapest_perfect_matching(nodes_, edges_);
        edges_.resize(count);
        assert(matched); // Marking all edges is one.
        std::vector<char> closed = marks_;
        for (const Index i : *matched)
            if (i < marking_.size() && marking_[i] != invalid_index)
                closed[marking_[i]] = 1;
        return closed;
    }

private:
    void link(Index a, Index b)
    {
        edges_.push_back({a, b, 0.0});
        marking_.push_back(invalid_index);
    }

    // One link of the chain for each boundary edge: a node matched with the side when that is
    // marked, a node for each neighbour in the chain, and one more where the others are odd in
    // number. All may be matched with each other.
    void add_outside()
    {
        Index before = invalid_index;
        std::vector<Index> boundary;
        for (Index e = 0; e < complex_.edge_count(); ++e)
            if (!marks_[e] && complex_.is_boundary_edge(e))
                boundary.push_back(e);
        for (std::size_t i = 0; i < boundary.size(); ++i) {
            std::vector<Index> at{nodes_++};
            edges_.push_back({number_[complex_.halfedge_of_edge(boundary[i])], at[0], 0.0});
            marking_.push_back(boundary[i]);
            if (before != invalid_index) {
                at.push_back(nodes_++);
                link(before, at.back());
            }
            const bool last = i + 1 == boundary.size();
            if (!last) {
                at.push_back(nodes_++);
                before = at.back();
            }
            // Whether marked boundary edges are even in number is not for the last link to choose:
            // the quads decide, and the count of all nodes says which.
            if (last ? nodes_ % 2 == 1 : at.size() % 2 == 1)
                at.push_back(nodes_++);
            for (std::size_t j = 0; j < at.size(); ++j)
                for (std::size_t k = 0; k < j; ++k)
                    link(at[k], at[j]);
        }
    }

    // Matching sides i and j of a quad leaves them without marks: its cost is what the marking of
    // the other two costs, less the cost of marking all four, so that costs of both add up.
    void add_quad(Index q, const MarkCosts& costs)
    {
        const double all = costs.halve[q][0] + costs.halve[q][1];
        for (Index i = 0; i < 4; ++i)
            for (Index j = i + 1; j < 4; ++j) {
                const Index a = number_[4 * q + i], b = number_[4 * q + j];
                if (a == invalid_index || b == invalid_index)
                    continue;
                // Unmarked neighbours i and i + 1 meet at corner i + 1, which names the turn.
                const double cost = j - i == 2         ? costs.halve[q][1 - i]
                                    : i == 0 && j == 3 ? costs.turn[q][0]
                                                       : costs.turn[q][j];
                edges_.push_back({a, b, cost - all});
            }
    }

    const QuadComplex& complex_;
    const std::vector<char>& marks_;
    std::vector<Index> number_;
    Index nodes_ = 0;
    std::vector<MatchingEdge> edges_;
    std::vector<Index> marking_; // Per matching edge outside quads: the edge it marks, or invalid.
};

// Puts turns at vertices that would get too many quads out of reach.
bool forbid_excess(const QuadComplex& complex, const std::vector<char>& marks, MarkCosts& costs)
{
    std::vector<Index> gained(complex.vertex_count(), 0);
    for (Index q = 0; q < complex.quad_count(); ++q)
        if (const auto corner = turned_corner(complex, marks, q))
            ++gained[complex.quad(q)[*corner]];
    bool changed = false;
    for (Index q = 0; q < complex.quad_count(); ++q)
        for (Index k = 0; k < 4; ++k) {
            const Index v = complex.quad(q)[k];
            if (gained[v] > 0 && complex.valence(v) + gained[v] > costs.max_valence &&
                costs.turn[q][k] < out_of_reach) {
                costs.turn[q][k] += out_of_reach;
                changed = true;
            }
        }
    return changed;
}

} // namespace

MarkCosts MarkCosts::of_regularity(const QuadComplex& complex,
                                   const std::vector<double>& corner_angles)
{
    MarkCosts costs;
    costs.halve.assign(complex.quad_count(), {halving, halving});
    costs.turn.resize(complex.quad_count());
    for (Index q = 0; q < complex.quad_count(); ++q)
        for (Index k = 0; k < 4; ++k) {
            const Sectors at_corner = sectors_around(complex, 4 * q + k, corner_angles);
            costs.turn[q][k] =
                std::max(0.0, turning + Sectors{3, 4.0}.irregular(0.0) + at_corner.irregular(1.0) -
                                  at_corner.irregular(0.0));
        }
    return costs;
}

double MarkCosts::total(const QuadComplex& complex, const std::vector<char>& marks) const
{
    double sum = 0.0;
    for (Index q = 0; q < complex.quad_count(); ++q) {
        if (const auto corner = turned_corner(complex, marks, q))
            sum += turn[q][*corner];
        else
            for (Index s = 0; s < 2; ++s)
                if (marks[complex.edge(4 * q + s)])
                    sum += halve[q][s];
    }
    return sum;
}

std::vector<char> close_marks(const QuadComplex& complex, const std::vector<char>& marks,
                              const MarkCosts& costs)
{
    assert(marks.size() == complex.edge_count());
    MarkingProblem problem(complex, marks);
    MarkCosts current = costs;
    std::vector<char> closed = problem.solve(current);
    // Ends: each time more turns are out of reach, and marking all edges turns nowhere.
    while (forbid_excess(complex, closed, current))
        closed = problem.solve(current);
    return closed;
}

} // namespace bot2nurbs
