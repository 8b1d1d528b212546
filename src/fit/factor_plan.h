// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"

#include <cstddef>
#include <vector>

namespace bot2nurbs {

//! Pattern of a symmetric matrix in a fill-reducing order, and of its Cholesky factor.
//!
//! Columns are put in minimum-degree order and then in postorder of the elimination tree, so that
//! columns with (nearly) the same rows of the factor are neighbours: *supernodes*, which dense
//! kernels can work on. The plan serves scalar entries and dense blocks of any size alike.
class FactorPlan {
public:
    FactorPlan() = default;
    //! `neighbours` lists, per index, the indices it shares an entry with, itself included,
    //! ascending. Not to be used when the context was cancelled meanwhile.
    FactorPlan(const std::vector<std::vector<int>>& neighbours, const Context& context);

    int size() const { return static_cast<int>(place.size()); }
    //! Entries of the factor, and multiplications of a factorisation, if entries are scalars.
    std::size_t entries = 0;
    double work = 0.0;

    std::vector<int> place; //!< Per index: its column.

    // The matrix: upper triangle, compressed columns, rows ascending (the diagonal is last).
    std::vector<int> column, row;
    //! The slot of an entry. \pre it is in the pattern
    int slot(int i, int j) const;

    // The same by rows: entries of the lower triangle per column with the slots they are stored in,
    // and the places of their rows in the front of the column's supernode.
    std::vector<int> lower_column, lower_row, lower_slot, lower_place;

    //! Columns first .. last - 1 of the factor share the rows below them.
    struct Supernode {
        int first = 0, last = 0;
        std::size_t rows = 0; //!< Where its rows below `last` start in `rows_below`.
        int row_count = 0;    //!< Number of these.
        int parent = -1;      //!< The supernode of the first of them.
        std::vector<int> children;
        std::size_t values = 0; //!< Where its (width + row_count) x width panel starts.
        int width() const { return last - first; }
        int height() const { return width() + row_count; }
    };
    std::vector<Supernode> supernodes; //!< In postorder.
    std::vector<int> rows_below;
    //! Per row below: its place in the front of the parent, whose own columns come first.
    std::vector<int> place_in_parent;
    std::size_t value_count = 0;

    //! Supernodes first .. last - 1 of a subtree of the elimination tree.
    struct Subtree {
        int first = 0, last = 0;
    };
    //! Subtrees of a small share of the work each, which can be worked on side by side. They do not
    //! depend on the number of threads.
    std::vector<Subtree> subtrees;
    std::vector<int> top; //!< All other supernodes, in postorder.

private:
    std::vector<int> order_by_degree(const std::vector<std::vector<int>>& neighbours) const;
    void fill_pattern(const std::vector<std::vector<int>>& neighbours);
    std::vector<int> elimination_tree(std::vector<int>& count) const;
    void merge_columns(const std::vector<int>& parent, const std::vector<int>& count);
    void fill_rows();
    void fill_places();
    void cut_subtrees();
};

} // namespace bot2nurbs
