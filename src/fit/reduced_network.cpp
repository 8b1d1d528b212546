// SPDX-License-Identifier: MIT
#include "fit/reduced_network.h"

#include <algorithm>
#include <cmath>

namespace bot2nurbs {

namespace {

struct Entry {
    Index column;
    double weight;
};

Error bad_constraint(const char* what, Index row)
{
    return {ErrorCode::fit_failed,
            "constraint row " + std::to_string(row) + " " + what + "; it cannot be eliminated",
            row};
}

} // namespace

Result<ReducedNetwork> ReducedNetwork::build(const SplineNetwork& network, const Context& context)
{
    const Index n = network.unknown_count;
    const SparseRows& constraints = network.constraints;
    // Per unknown: the constraint row that eliminates it, and whether any row uses it.
    std::vector<Index> row_of(n, invalid_index);
    std::vector<char> constrained(n, 0);
    for (Index r = 0; r < constraints.row_count(); ++r) {
        std::size_t pivot = constraints.offset[r];
        for (std::size_t e = constraints.offset[r]; e < constraints.offset[r + 1]; ++e) {
            if (constrained[constraints.column[e]])
                return bad_constraint("shares an unknown with another row", r);
            constrained[constraints.column[e]] = 1;
            if (std::abs(constraints.weight[e]) > std::abs(constraints.weight[pivot]))
                pivot = e;
        }
        if (constraints.offset[r] == constraints.offset[r + 1] || constraints.weight[pivot] == 0.0)
            return bad_constraint("is zero", r);
        row_of[constraints.column[pivot]] = r;
    }

    ReducedNetwork reduced;
    reduced.is_point_ = network.is_point;
    std::vector<Index> free_of(n, invalid_index);
    for (Index y = 0; y < n; ++y)
        if (row_of[y] == invalid_index) {
            free_of[y] = reduced.free_count();
            reduced.free_.push_back(y);
        }
    std::vector<Index> eliminated_row(n, invalid_index);
    for (Index y = 0; y < n; ++y) {
        const Index r = row_of[y];
        if (r == invalid_index)
            continue;
        double pivot = 0.0;
        for (std::size_t e = constraints.offset[r]; e < constraints.offset[r + 1]; ++e)
            if (constraints.column[e] == y)
                pivot = constraints.weight[e];
        for (std::size_t e = constraints.offset[r]; e < constraints.offset[r + 1]; ++e)
            if (constraints.column[e] != y) {
                reduced.eliminated_.column.push_back(free_of[constraints.column[e]]);
                reduced.eliminated_.weight.push_back(-constraints.weight[e] / pivot);
            }
        eliminated_row[y] = static_cast<Index>(reduced.eliminated_unknown_.size());
        reduced.eliminated_unknown_.push_back(y);
        reduced.eliminated_.offset.push_back(reduced.eliminated_.column.size());
    }

    std::vector<Entry> row;
    std::vector<std::vector<Entry>> rows(coefficients);
    std::vector<Index> columns;
    const Index quads = network.complex.quad_count();
    for (Index p = 0; p < quads * pieces_per_quad; ++p) {
        if (context.cancelled())
            return Context::cancelled_error("fit");
        const Index q = p / pieces_per_quad, a = p % pieces_per_quad / 4, b = p % 4;
        columns.clear();
        for (Index c = 0; c < coefficients; ++c) {
            const Index s = SplineNetwork::row(q, 3 * a + c / 4, 3 * b + c % 4);
            row.clear();
            for (std::size_t e = network.stencils.offset[s]; e < network.stencils.offset[s + 1];
                 ++e) {
                const Index y = network.stencils.column[e];
                const double w = network.stencils.weight[e];
                if (free_of[y] != invalid_index) {
                    row.push_back({free_of[y], w});
                    continue;
                }
                const Index r = eliminated_row[y];
                for (std::size_t k = reduced.eliminated_.offset[r];
                     k < reduced.eliminated_.offset[r + 1]; ++k)
                    row.push_back(
                        {reduced.eliminated_.column[k], w * reduced.eliminated_.weight[k]});
            }
            std::stable_sort(row.begin(), row.end(),
                             [](const Entry& x, const Entry& y) { return x.column < y.column; });
            rows[c].clear();
            for (const Entry& entry : row) {
                if (!rows[c].empty() && rows[c].back().column == entry.column)
                    rows[c].back().weight += entry.weight;
                else
                    rows[c].push_back(entry);
                columns.push_back(entry.column);
            }
        }
        std::sort(columns.begin(), columns.end());
        columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
        const std::size_t first = reduced.weight_.size();
        reduced.weight_.resize(first + coefficients * columns.size(), 0.0);
        for (Index c = 0; c < coefficients; ++c)
            for (const Entry& entry : rows[c]) {
                const auto k = static_cast<std::size_t>(
                    std::lower_bound(columns.begin(), columns.end(), entry.column) -
                    columns.begin());
                reduced.weight_[first + c * columns.size() + k] = entry.weight;
            }
        reduced.unknown_.insert(reduced.unknown_.end(), columns.begin(), columns.end());
        reduced.offset_.push_back(reduced.unknown_.size());
    }
    return reduced;
}

std::vector<Vec3> ReducedNetwork::expand(const std::vector<Vec3>& free) const
{
    std::vector<Vec3> all(is_point_.size());
    for (std::size_t i = 0; i < free_.size(); ++i)
        all[free_[i]] = free[i];
    for (std::size_t r = 0; r < eliminated_unknown_.size(); ++r) {
        Vec3 sum;
        for (std::size_t e = eliminated_.offset[r]; e < eliminated_.offset[r + 1]; ++e)
            sum += eliminated_.weight[e] * free[eliminated_.column[e]];
        all[eliminated_unknown_[r]] = sum;
    }
    return all;
}

} // namespace bot2nurbs
