// SPDX-License-Identifier: MIT
#include "fit/factor_plan.h"

#include <Eigen/OrderingMethods>
#include <Eigen/Sparse>
#include <algorithm>

namespace bot2nurbs {

namespace {

//! Merged supernodes may hold this share of explicit zeros, the less the wider they are: wide dense
//! kernels are faster by more than the zeros cost (the widths and shares are those of common
//! sparse solvers).
struct Relaxation {
    int width;
    double zeros;
};
constexpr Relaxation relaxations[] = {{4, 0.8}, {16, 0.3}, {48, 0.1}};
constexpr double wide_zeros = 0.03;
//! Largest share of the work that is not divided among threads: with a few times as many subtrees
//! as cores, all are busy to the end.
constexpr double subtree_share = 1.0 / 16.0;

double allowed_zeros(int width)
{
    for (const Relaxation& r : relaxations)
        if (width <= r.width)
            return r.zeros;
    return wide_zeros;
}

//! Postorder of a forest; children of a node in ascending order.
std::vector<int> postorder(const std::vector<int>& parent)
{
    const int n = static_cast<int>(parent.size());
    std::vector<int> head(n, -1), next(n, -1), order, stack;
    for (int i = n - 1; i >= 0; --i)
        if (parent[i] >= 0) {
            next[i] = head[parent[i]];
            head[parent[i]] = i;
        }
    for (int root = 0; root < n; ++root) {
        if (parent[root] >= 0)
            continue;
        stack.push_back(root);
        while (!stack.empty()) {
            const int i = stack.back();
            if (head[i] >= 0) {
                stack.push_back(head[i]);
                head[i] = next[head[i]];
            } else {
                order.push_back(i);
                stack.pop_back();
            }
        }
    }
    return order;
}

} // namespace

FactorPlan::FactorPlan(const std::vector<std::vector<int>>& neighbours, const Context& context)
{
    place = order_by_degree(neighbours);
    if (context.cancelled())
        return;
    fill_pattern(neighbours);
    std::vector<int> count;
    const std::vector<int> order = postorder(elimination_tree(count));
    if (context.cancelled())
        return;
    std::vector<int> position(order.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        position[order[i]] = static_cast<int>(i);
    for (int& p : place)
        p = position[p];
    fill_pattern(neighbours);
    const std::vector<int> parent = elimination_tree(count);
    for (const int c : count) {
        entries += static_cast<std::size_t>(c);
        work += static_cast<double>(c) * c;
    }
    if (context.cancelled())
        return;
    merge_columns(parent, count);
    fill_rows();
    fill_places();
    cut_subtrees();
}

std::vector<int> FactorPlan::order_by_degree(const std::vector<std::vector<int>>& neighbours) const
{
    const int n = static_cast<int>(neighbours.size());
    using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;
    std::vector<Eigen::Triplet<double, int>> list;
    for (int i = 0; i < n; ++i)
        for (const int j : neighbours[i])
            list.emplace_back(j, i, 1.0);
    Matrix pattern(n, n);
    pattern.setFromTriplets(list.begin(), list.end());
    Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
    Eigen::AMDOrdering<int>()(pattern, order);
    std::vector<int> result(n);
    for (int i = 0; i < n; ++i)
        result[order.indices()[i]] = i;
    return result;
}

void FactorPlan::fill_pattern(const std::vector<std::vector<int>>& neighbours)
{
    const int n = static_cast<int>(neighbours.size());
    std::vector<std::vector<int>> upper(n);
    for (int i = 0; i < n; ++i)
        for (const int j : neighbours[i])
            if (place[j] <= place[i])
                upper[place[i]].push_back(place[j]);
    column.assign(1, 0);
    row.clear();
    for (std::vector<int>& list : upper) {
        std::sort(list.begin(), list.end());
        row.insert(row.end(), list.begin(), list.end());
        column.push_back(static_cast<int>(row.size()));
    }
    lower_column.assign(static_cast<std::size_t>(n) + 1, 0);
    for (const int r : row)
        ++lower_column[r + 1];
    for (int i = 0; i < n; ++i)
        lower_column[i + 1] += lower_column[i];
    std::vector<int> next(lower_column.begin(), lower_column.end() - 1);
    lower_row.resize(row.size());
    lower_slot.resize(row.size());
    for (int j = 0; j < n; ++j)
        for (int e = column[j]; e < column[j + 1]; ++e) {
            const int at = next[row[e]]++;
            lower_row[at] = j;
            lower_slot[at] = e;
        }
}

int FactorPlan::slot(int i, int j) const
{
    const int col = std::max(place[i], place[j]), r = std::min(place[i], place[j]);
    return static_cast<int>(
        std::lower_bound(row.begin() + column[col], row.begin() + column[col + 1], r) -
        row.begin());
}

std::vector<int> FactorPlan::elimination_tree(std::vector<int>& count) const
{
    const int n = size();
    std::vector<int> parent(n, -1), mark(n, -1);
    count.assign(n, 1);
    // Row col of the factor is the subtree between the entries of the matrix in it and col.
    for (int col = 0; col < n; ++col) {
        mark[col] = col;
        for (int e = column[col]; e < column[col + 1]; ++e)
            for (int i = row[e]; mark[i] != col; i = parent[i]) {
                if (parent[i] < 0)
                    parent[i] = col;
                ++count[i];
                mark[i] = col;
            }
    }
    return parent;
}

void FactorPlan::merge_columns(const std::vector<int>& parent, const std::vector<int>& count)
{
    struct Run {
        Supernode node;
        double zeros = 0.0;
    };
    // Every column joins the run before it if that is its last child and few zeros come of it.
    std::vector<Run> runs;
    for (int j = 0; j < size(); ++j) {
        Run run;
        run.node.first = j;
        run.node.last = j + 1;
        run.node.row_count = count[j] - 1;
        while (!runs.empty()) {
            const Run& child = runs.back();
            const int p = parent[child.node.last - 1];
            if (p < run.node.first || p >= run.node.last)
                break;
            const int width = child.node.width() + run.node.width();
            const double zeros = child.zeros + run.zeros +
                                 static_cast<double>(child.node.width()) *
                                     (run.node.height() - child.node.row_count);
            const double all = width * (0.5 * (width + 1) + run.node.row_count);
            if (zeros > allowed_zeros(width) * all)
                break;
            run.node.first = child.node.first;
            run.zeros = zeros;
            runs.pop_back();
        }
        runs.push_back(run);
    }
    for (const Run& run : runs)
        supernodes.push_back(run.node);
}

void FactorPlan::fill_rows()
{
    std::vector<int> node_of(size()), mark(size(), -1);
    for (std::size_t s = 0; s < supernodes.size(); ++s)
        std::fill(node_of.begin() + supernodes[s].first, node_of.begin() + supernodes[s].last,
                  static_cast<int>(s));
    for (std::size_t s = 0; s < supernodes.size(); ++s) {
        Supernode& node = supernodes[s];
        node.rows = rows_below.size();
        const auto add = [&](int r) {
            if (r >= node.last && mark[r] != static_cast<int>(s)) {
                mark[r] = static_cast<int>(s);
                rows_below.push_back(r);
            }
        };
        for (int e = lower_column[node.first]; e < lower_column[node.last]; ++e)
            add(lower_row[e]);
        for (const int c : node.children)
            for (int k = 0; k < supernodes[c].row_count; ++k)
                add(rows_below[supernodes[c].rows + k]);
        std::sort(rows_below.begin() + static_cast<std::ptrdiff_t>(node.rows), rows_below.end());
        node.row_count = static_cast<int>(rows_below.size() - node.rows);
        node.values = value_count;
        value_count += static_cast<std::size_t>(node.height()) * node.width();
        if (node.row_count > 0) {
            node.parent = node_of[rows_below[node.rows]];
            supernodes[node.parent].children.push_back(static_cast<int>(s));
        }
    }
}

void FactorPlan::fill_places()
{
    std::vector<int> place_of(size());
    lower_place.resize(lower_row.size());
    place_in_parent.resize(rows_below.size());
    for (const Supernode& node : supernodes) {
        for (int j = node.first; j < node.last; ++j)
            place_of[j] = j - node.first;
        for (int k = 0; k < node.row_count; ++k)
            place_of[rows_below[node.rows + k]] = node.width() + k;
        for (int e = lower_column[node.first]; e < lower_column[node.last]; ++e)
            lower_place[e] = place_of[lower_row[e]];
        for (const int c : node.children)
            for (int k = 0; k < supernodes[c].row_count; ++k) {
                const std::size_t at = supernodes[c].rows + k;
                place_in_parent[at] = place_of[rows_below[at]];
            }
    }
}

void FactorPlan::cut_subtrees()
{
    const std::size_t n = supernodes.size();
    // Multiplications of a subtree, and its first node: it is a run of the postorder.
    std::vector<double> subtree_work(n);
    std::vector<int> first(n);
    double all = 0.0;
    for (std::size_t s = 0; s < n; ++s) {
        const double w = supernodes[s].width(), r = supernodes[s].row_count;
        const double own = w * (r * r + w * r + w * w / 3.0);
        all += own;
        subtree_work[s] = own;
        first[s] = static_cast<int>(s);
        for (const int c : supernodes[s].children) {
            subtree_work[s] += subtree_work[c];
            first[s] = std::min(first[s], first[c]);
        }
    }
    const double most = subtree_share * all;
    for (std::size_t s = 0; s < n; ++s) {
        if (subtree_work[s] > most) {
            top.push_back(static_cast<int>(s));
        } else if (const int p = supernodes[s].parent; p < 0 || subtree_work[p] > most) {
            subtrees.push_back({first[s], static_cast<int>(s) + 1});
        }
    }
}

} // namespace bot2nurbs
