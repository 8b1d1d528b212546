// SPDX-License-Identifier: MIT
#include "io/point_columns.h"

#include <cmath>

namespace bot2nurbs {

namespace {

//! Vectors count as unit within this: normals are often written with two digits.
constexpr double unit_slack = 0.05;
//! Share of the vectors that must be unit or zero: a scan may have a few broken normals, while of
//! other triples of numbers hardly any are unit.
constexpr double unit_share = 0.95;

using Columns = std::vector<std::optional<PointField>>;

void set_triple(Columns& columns, std::size_t at, PointField first)
{
    for (int k = 0; k < 3; ++k)
        columns[at + static_cast<std::size_t>(k)] =
            static_cast<PointField>(static_cast<int>(first) + k);
}

//! Normals: unit vectors, zero where none was found. Three columns of zeros are normals too; as
//! colours they would say nothing.
bool are_normals(const NumberRows& rows, std::size_t at)
{
    std::size_t good = 0;
    for (std::size_t r = 0; r < rows.size(); ++r) {
        const double length = std::hypot(rows.at(r, at), rows.at(r, at + 1), rows.at(r, at + 2));
        good += length == 0.0 || std::abs(length - 1.0) <= unit_slack;
    }
    return static_cast<double>(good) >= unit_share * static_cast<double>(rows.size());
}

bool are_colors(const NumberRows& rows, std::size_t at)
{
    for (std::size_t r = 0; r < rows.size(); ++r)
        for (std::size_t k = at; k < at + 3; ++k) {
            const double value = rows.at(r, k);
            if (!(value >= 0.0 && value <= 255.0 && value == std::floor(value)))
                return false;
        }
    return true;
}

//! Reads the columns from `at` to the end as triples; false when one of them is neither normals nor
//! colours, or both are normals or both colours.
bool read_triples(const NumberRows& rows, std::size_t at, std::size_t end, Columns& columns)
{
    bool normals = false, colors = false;
    for (; at + 3 <= end; at += 3) {
        if (!normals && are_normals(rows, at)) {
            normals = true;
            set_triple(columns, at, PointField::nx);
        } else if (!colors && are_colors(rows, at)) {
            colors = true;
            set_triple(columns, at, PointField::red);
        } else {
            return false;
        }
    }
    return true;
}

} // namespace

std::vector<std::optional<PointField>> guess_columns(const NumberRows& rows)
{
    Columns plain(rows.columns);
    set_triple(plain, 0, PointField::x);
    const std::size_t others = rows.columns - 3;
    Columns columns = plain;
    if (others % 3 == 0 && read_triples(rows, 3, rows.columns, columns))
        return columns;
    if (others % 3 == 1) {
        // The intensity comes first (.pts); a single number behind all others may be anything.
        columns = plain;
        if (read_triples(rows, 4, rows.columns, columns)) {
            columns[3] = PointField::intensity;
            return columns;
        }
        columns = plain;
        if (read_triples(rows, 3, rows.columns - 1, columns))
            return columns;
    }
    return plain;
}

} // namespace bot2nurbs
