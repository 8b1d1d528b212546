// SPDX-License-Identifier: MIT
#pragma once

#include "io/point_table.h"

namespace bot2nurbs {

//! Rows of numbers without names: row r has the values [r * columns, (r + 1) * columns).
struct NumberRows {
    std::size_t columns = 0;
    std::vector<double> values;

    std::size_t size() const { return columns == 0 ? 0 : values.size() / columns; }
    double at(std::size_t row, std::size_t column) const { return values[row * columns + column]; }
};

//! Says what each column is when nothing names it: nothing for columns of unknown meaning. See
//! read_points for the rules. \pre at least three columns.
std::vector<std::optional<PointField>> guess_columns(const NumberRows& rows);

} // namespace bot2nurbs
