// SPDX-License-Identifier: MIT
#include "refine/grade_marks.h"

#include "hand_domains.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace bot2nurbs {
namespace {

//! The halfedge of a quad complex from one vertex to another.
Index halfedge(const QuadComplex& complex, Index from, Index to)
{
    for (Index h = 0; h < complex.halfedge_count(); ++h)
        if (complex.from(h) == from && complex.to(h) == to)
            return h;
    return invalid_index;
}

//! An edge and those that follow each other straight on from its end.
std::vector<Index> straight_on(const QuadComplex& complex, Index halfedge, int count)
{
    std::vector<Index> edges;
    Index h = halfedge;
    for (int i = 0; i < count; ++i) {
        edges.push_back(complex.edge(h));
        // Across the next vertex, which has four quads.
        h = complex.next(complex.twin(complex.next(h)));
    }
    return edges;
}

TEST(GradeMarks, an_edge_over_three_times_its_opposite_is_marked)
{
    const QuadComplex complex = test::torus_grid().domain.complex;
    const std::vector<Index> row = straight_on(complex, 0, 2);
    for (const double length : {2.9, 3.1}) {
        std::vector<double> lengths(complex.edge_count(), 1.0);
        lengths[row[1]] = length;
        std::vector<char> marks(complex.edge_count(), 0);
        grade_marks(complex, lengths, {0}, marks);
        EXPECT_EQ(marks[row[1]] != 0, length > 3.0);
        EXPECT_EQ(std::count(marks.begin(), marks.end(), 1), length > 3.0);
    }
}

TEST(GradeMarks, a_marked_edge_counts_half)
{
    const QuadComplex complex = test::torus_grid().domain.complex;
    const std::vector<Index> row = straight_on(complex, 0, 2);
    std::vector<double> lengths(complex.edge_count(), 1.0);
    lengths[row[1]] = 2.0;
    std::vector<char> marks(complex.edge_count(), 0);
    grade_marks(complex, lengths, {0}, marks);
    EXPECT_FALSE(marks[row[1]]);
    marks[row[0]] = 1;
    grade_marks(complex, lengths, {0}, marks);
    EXPECT_TRUE(marks[row[1]]);
}

TEST(GradeMarks, marks_go_on_along_a_row_of_growing_edges)
{
    const QuadComplex complex = test::torus_grid().domain.complex;
    const std::vector<Index> row = straight_on(complex, 0, 3);
    std::vector<double> lengths(complex.edge_count(), 1.0);
    lengths[row[0]] = 1.0;
    lengths[row[1]] = 2.0;
    lengths[row[2]] = 4.0;
    std::vector<char> marks(complex.edge_count(), 0);
    marks[row[0]] = 1;
    grade_marks(complex, lengths, {0}, marks);
    EXPECT_TRUE(marks[row[1]]); // 2 > 3 * 0.5
    EXPECT_TRUE(marks[row[2]]); // 4 > 3 * 1, from a vertex that is none of quad 0
}

TEST(GradeMarks, edges_of_different_length_that_cross_are_left)
{
    const QuadComplex complex = test::torus_grid().domain.complex;
    std::vector<double> lengths(complex.edge_count(), 1.0);
    // All edges along one direction of the grid.
    for (Index q = 0; q < complex.quad_count(); ++q)
        for (const Index s : {0, 2})
            lengths[complex.edge(4 * q + s)] = 20.0;
    std::vector<char> marks(complex.edge_count(), 0);
    grade_marks(complex, lengths, {0}, marks);
    EXPECT_EQ(std::count(marks.begin(), marks.end(), 1), 0);
}

TEST(GradeMarks, around_three_quads_the_longer_of_two_opposite_edges_counts)
{
    // A cube: every vertex has three quads.
    const auto complex = QuadComplex::build(
        8, {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}});
    ASSERT_TRUE(complex.ok());
    const Index e = complex->edge(halfedge(*complex, 0, 1));
    const Index f = complex->edge(halfedge(*complex, 0, 3));
    const Index g = complex->edge(halfedge(*complex, 0, 4));
    const auto grade = [&](double length_f) {
        std::vector<double> lengths(complex->edge_count(), 10.0);
        lengths[e] = 10.0;
        lengths[f] = length_f;
        lengths[g] = 1.0;
        std::vector<char> marks(complex->edge_count(), 0);
        grade_marks(*complex, lengths, {0}, marks);
        return marks;
    };
    EXPECT_TRUE(grade(3.0)[e]);
    EXPECT_FALSE(grade(4.0)[e]);
}

TEST(GradeMarks, vertices_on_creases_are_left)
{
    const auto complex = QuadComplex::build(
        8, {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}},
        {{0, 1}, {1, 2}, {2, 3}, {3, 0}});
    ASSERT_TRUE(complex.ok());
    std::vector<double> lengths(complex->edge_count(), 1.0);
    lengths[complex->edge(halfedge(*complex, 0, 4))] = 100.0;
    std::vector<char> marks(complex->edge_count(), 0);
    grade_marks(*complex, lengths, {0}, marks); // The quad has vertices on the crease alone.
    EXPECT_EQ(std::count(marks.begin(), marks.end(), 1), 0);
    grade_marks(*complex, lengths, {1}, marks);
    EXPECT_EQ(std::count(marks.begin(), marks.end(), 1), 1);
}

} // namespace
} // namespace bot2nurbs
