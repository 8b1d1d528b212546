// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/spline_network.h"

#include <cmath>
#include <utility>

namespace bot2nurbs {

//! Weights are sums of a few terms of size 1 / 36 to 2; cosines that are zero in exact arithmetic
//! leave terms of a few 1e-17 behind. Smaller weights are dropped: they would only fill the matrix.
inline constexpr double negligible_weight = 1e-15;

//! Sums weighted sparse rows into one. Reused, it does not allocate.
class RowSum {
public:
    void add(double weight, Index column) { terms_.push_back({column, weight}); }
    void add(double weight, const SparseRows& rows, Index row)
    {
        for (std::size_t i = rows.offset[row]; i < rows.offset[row + 1]; ++i) {
            terms_.push_back({rows.column[i], weight * rows.weight[i]});
        }
    }

    //! Appends the sum, columns ascending, as a row of `out` and starts a new sum.
    //! \return the number of that row.
    Index append_to(SparseRows& out)
    {
        // Rows have few terms, and a stable order of equal columns keeps sums reproducible.
        for (std::size_t i = 1; i < terms_.size(); ++i) {
            const auto term = terms_[i];
            std::size_t j = i;
            for (; j > 0 && terms_[j - 1].first > term.first; --j)
                terms_[j] = terms_[j - 1];
            terms_[j] = term;
        }
        for (std::size_t i = 0; i < terms_.size();) {
            const Index column = terms_[i].first;
            double sum = 0.0;
            for (; i < terms_.size() && terms_[i].first == column; ++i)
                sum += terms_[i].second;
            if (std::fabs(sum) <= negligible_weight)
                continue;
            out.column.push_back(column);
            out.weight.push_back(sum);
        }
        terms_.clear();
        out.offset.push_back(out.column.size());
        return out.row_count() - 1;
    }

private:
    std::vector<std::pair<Index, double>> terms_;
};

//! Appends a copy of row `row` of `from`.
inline void append_copy(SparseRows& out, const SparseRows& from, Index row)
{
    const auto begin = static_cast<std::ptrdiff_t>(from.offset[row]);
    const auto end = static_cast<std::ptrdiff_t>(from.offset[row + 1]);
    out.column.insert(out.column.end(), from.column.begin() + begin, from.column.begin() + end);
    out.weight.insert(out.weight.end(), from.weight.begin() + begin, from.weight.begin() + end);
    out.offset.push_back(out.column.size());
}

} // namespace bot2nurbs
