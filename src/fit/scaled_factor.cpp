// SPDX-License-Identifier: MIT
#include "fit/scaled_factor.h"

#include <Eigen/Cholesky>
#include <cmath>

namespace bot2nurbs {

namespace {

//! Power iterations of the condition estimate. The extreme eigenvalues of a fit's matrix are well
//! apart from the bulk at neither end; ten iterations give the condition within a factor of about
//! two, which is what a limit of powers of ten needs.
constexpr int power_iterations = 10;
//! Fewer when an iteration raises the estimate by less than this share.
constexpr double power_gain = 0.05;
//! Columns eliminated between two polls of the context; a front of a thousand rows takes a few
//! milliseconds for them.
constexpr Eigen::Index panel_columns = 48;

using Size = Eigen::Index;
using Panel = Eigen::Map<const Eigen::MatrixXd>;

//! A fixed start vector that no eigenvector of a mesh problem is orthogonal to in practice.
Eigen::VectorXd start_vector(Size n)
{
    Eigen::VectorXd v(n);
    std::uint32_t state = 12345u;
    for (Size i = 0; i < n; ++i) {
        state = state * 1664525u + 1013904223u;
        v[i] = static_cast<double>(state >> 8) / 16777216.0 - 0.5;
    }
    return v.normalized();
}

//! Where entry (a, c) of a symmetric block is among its values.
constexpr int block_entry[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};

//! Eliminates the first columns of a front: they become those of its Cholesky factor, the rest what
//! they leave. Lower triangles. \return false when a pivot is not positive or when cancelled.
bool eliminate(Size columns, Eigen::Ref<Eigen::MatrixXd> front, const Context& context)
{
    const Size rows = front.rows();
    for (Size k = 0; k < columns; k += panel_columns) {
        if (context.cancelled())
            return false;
        const Size w = std::min(panel_columns, columns - k), rest = rows - k - w;
        auto corner = front.block(k, k, w, w);
        Eigen::Ref<Eigen::MatrixXd> corner_ref(corner);
        const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factor(corner_ref);
        if (factor.info() != Eigen::Success)
            return false;
        if (rest == 0)
            continue;
        auto below = front.block(k + w, k, rest, w);
        corner.triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(below);
        front.bottomRightCorner(rest, rest).selfadjointView<Eigen::Lower>().rankUpdate(below, -1.0);
    }
    return true;
}

} // namespace

ScaledFactor::ScaledFactor(const FactorPlan& plan, int block) : plan_(&plan), block_(block) {}

Eigen::VectorXd ScaledFactor::times(const Eigen::VectorXd& x) const
{
    Eigen::VectorXd y = Eigen::VectorXd::Zero(x.size());
    const int n = plan_->size();
    if (block_ == 1) {
        for (int j = 0; j < n; ++j) {
            double sum = 0.0;
            for (int e = plan_->column[j]; e < plan_->column[j + 1] - 1; ++e) {
                y[plan_->row[e]] += values_[e] * x[j];
                sum += values_[e] * x[plan_->row[e]];
            }
            y[j] += sum + values_[plan_->column[j + 1] - 1] * x[j];
        }
        return y;
    }
    for (int j = 0; j < n; ++j) {
        const double x0 = x[3 * j], x1 = x[3 * j + 1], x2 = x[3 * j + 2];
        double s0 = 0.0, s1 = 0.0, s2 = 0.0;
        for (int e = plan_->column[j]; e < plan_->column[j + 1]; ++e) {
            const double* v = &values_[6 * static_cast<std::size_t>(e)];
            const int i = plan_->row[e];
            const double* xi = x.data() + 3 * static_cast<Size>(i);
            s0 += v[0] * xi[0] + v[1] * xi[1] + v[2] * xi[2];
            s1 += v[1] * xi[0] + v[3] * xi[1] + v[4] * xi[2];
            s2 += v[2] * xi[0] + v[4] * xi[1] + v[5] * xi[2];
            if (i == j)
                continue;
            double* yi = y.data() + 3 * static_cast<Size>(i);
            yi[0] += v[0] * x0 + v[1] * x1 + v[2] * x2;
            yi[1] += v[1] * x0 + v[3] * x1 + v[4] * x2;
            yi[2] += v[2] * x0 + v[4] * x1 + v[5] * x2;
        }
        y[3 * j] += s0;
        y[3 * j + 1] += s1;
        y[3 * j + 2] += s2;
    }
    return y;
}

void ScaledFactor::assemble_front(const FactorPlan::Supernode& node, const std::vector<int>& local,
                                  Eigen::Ref<Eigen::MatrixXd> front) const
{
    const int b = block_, per_slot = b == 1 ? 1 : 6;
    for (int j = node.first; j < node.last; ++j)
        for (int e = plan_->lower_column[j]; e < plan_->lower_column[j + 1]; ++e) {
            const int i = plan_->lower_row[e];
            const double* v = &values_[static_cast<std::size_t>(plan_->lower_slot[e]) * per_slot];
            for (int c = 0; c < b; ++c)
                for (int a = 0; a < b; ++a)
                    front(b * local[i] + a, b * (j - node.first) + c) =
                        v[block_entry[a][c]] * scale_[b * i + a] * scale_[b * j + c];
        }
}

bool ScaledFactor::factorize(const Context& context)
{
    has_factor_ = false;
    const int n = plan_->size(), b = block_;
    scale_.resize(size());
    for (int j = 0; j < n; ++j)
        for (int a = 0; a < b; ++a) {
            const auto slot = static_cast<std::size_t>(plan_->column[j + 1] - 1);
            const double d = b == 1 ? values_[slot] : values_[6 * slot + block_entry[a][a]];
            if (!(d > 0.0) || !std::isfinite(d))
                return false;
            scale_[b * j + a] = 1.0 / std::sqrt(d);
        }
    const std::size_t square = static_cast<std::size_t>(b) * b;
    factor_.resize(plan_->value_count * square);
    // What the eliminated columns leave for the others waits on a stack, children above parents.
    std::vector<double> stack(plan_->largest_stack * square);
    std::vector<double> buffer(static_cast<std::size_t>(plan_->largest_front) *
                               plan_->largest_front * square);
    std::vector<std::size_t> waiting;
    std::vector<int> owner, local(n, -1);
    std::size_t top = 0;
    for (std::size_t s = 0; s < plan_->supernodes.size(); ++s) {
        const FactorPlan::Supernode& node = plan_->supernodes[s];
        const int* below = plan_->rows_below.data() + node.rows;
        for (int j = node.first; j < node.last; ++j)
            local[j] = j - node.first;
        for (int k = 0; k < node.row_count; ++k)
            local[below[k]] = node.width() + k;
        const Size m = static_cast<Size>(b) * node.height(),
                   w = static_cast<Size>(b) * node.width(), r = m - w;
        Eigen::Map<Eigen::MatrixXd> front(buffer.data(), m, m);
        front.setZero();
        assemble_front(node, local, front);
        while (!owner.empty() && plan_->supernodes[owner.back()].parent == static_cast<int>(s)) {
            const FactorPlan::Supernode& child = plan_->supernodes[owner.back()];
            const Size side = static_cast<Size>(b) * child.row_count;
            top -= static_cast<std::size_t>(side * side);
            const double* update = stack.data() + top;
            const int* rows = plan_->rows_below.data() + child.rows;
            for (int j = 0; j < child.row_count; ++j)
                for (int c = 0; c < b; ++c) {
                    double* to = &front(0, static_cast<Size>(b) * local[rows[j]] + c);
                    const double* from = update + (static_cast<Size>(b) * j + c) * side;
                    for (int i = j; i < child.row_count; ++i)
                        for (int a = 0; a < b; ++a)
                            to[b * local[rows[i]] + a] += from[b * i + a];
                }
            owner.pop_back();
        }
        if (!eliminate(w, front, context))
            return false;
        Eigen::Map<Eigen::MatrixXd>(factor_.data() + node.values * square, m, w) =
            front.leftCols(w);
        if (node.parent >= 0) {
            Eigen::Map<Eigen::MatrixXd>(stack.data() + top, r, r) = front.bottomRightCorner(r, r);
            top += static_cast<std::size_t>(r * r);
            owner.push_back(static_cast<int>(s));
        }
    }
    has_factor_ = true;
    return true;
}

template <class Columns> void ScaledFactor::solve_scaled(Columns& x) const
{
    const Size b = block_;
    const std::size_t square = static_cast<std::size_t>(b * b);
    Columns gathered;
    for (const FactorPlan::Supernode& node : plan_->supernodes) {
        const Size w = b * node.width(), r = b * node.row_count;
        const Panel panel(factor_.data() + node.values * square, w + r, w);
        auto own = x.middleRows(b * node.first, w);
        panel.topRows(w).triangularView<Eigen::Lower>().solveInPlace(own);
        gathered.noalias() = panel.bottomRows(r) * own;
        const int* below = plan_->rows_below.data() + node.rows;
        for (Size c = 0; c < x.cols(); ++c)
            for (Size k = 0; k < node.row_count; ++k)
                for (Size a = 0; a < b; ++a)
                    x(b * below[k] + a, c) -= gathered(b * k + a, c);
    }
    for (auto it = plan_->supernodes.rbegin(); it != plan_->supernodes.rend(); ++it) {
        const FactorPlan::Supernode& node = *it;
        const Size w = b * node.width(), r = b * node.row_count;
        const Panel panel(factor_.data() + node.values * square, w + r, w);
        auto own = x.middleRows(b * node.first, w);
        const int* below = plan_->rows_below.data() + node.rows;
        gathered.resize(r, x.cols());
        for (Size c = 0; c < x.cols(); ++c)
            for (Size k = 0; k < node.row_count; ++k)
                for (Size a = 0; a < b; ++a)
                    gathered(b * k + a, c) = x(b * below[k] + a, c);
        own.noalias() -= panel.bottomRows(r).transpose() * gathered;
        panel.topRows(w).triangularView<Eigen::Lower>().transpose().solveInPlace(own);
    }
}

Eigen::VectorXd ScaledFactor::solve(const Eigen::VectorXd& right) const
{
    Eigen::VectorXd x = scale_.cwiseProduct(right);
    solve_scaled(x);
    return scale_.cwiseProduct(x);
}

Eigen::MatrixX3d ScaledFactor::solve_three(const Eigen::MatrixX3d& right) const
{
    Eigen::MatrixX3d x = scale_.asDiagonal() * right;
    solve_scaled(x);
    return scale_.asDiagonal() * x;
}

double ScaledFactor::condition(const Context& context) const
{
    // The norms grow from step to step; when they hardly do any more, the rest is not worth it.
    double largest = 0.0, inverse_largest = 0.0, last = -1.0;
    Eigen::VectorXd v = start_vector(size());
    for (int i = 0; i < power_iterations && largest > last * (1.0 + power_gain); ++i) {
        if (context.cancelled())
            return INFINITY;
        v = scale_.cwiseProduct(times(scale_.cwiseProduct(v)));
        last = largest;
        largest = v.norm();
        v /= largest;
    }
    v = start_vector(size());
    last = -1.0;
    for (int i = 0; i < power_iterations && inverse_largest > last * (1.0 + power_gain); ++i) {
        if (context.cancelled())
            return INFINITY;
        solve_scaled(v);
        last = inverse_largest;
        inverse_largest = v.norm();
        v /= inverse_largest;
    }
    return largest * inverse_largest;
}

} // namespace bot2nurbs
