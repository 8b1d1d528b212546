// SPDX-License-Identifier: MIT
#include "fit/scaled_factor.h"

#include "core/parallel.h"

#include <cmath>

namespace bot2nurbs {

namespace {

//! Power iterations of the condition estimate. The extreme eigenvalues of a fit's matrix are well
//! apart from the bulk at neither end; ten iterations give the condition within a factor of about
//! two, which is what a limit of powers of ten needs.
constexpr int power_iterations = 10;
//! Fewer when an iteration raises the estimate by less than this share.
constexpr double power_gain = 0.05;
constexpr std::size_t chunk_columns = 256;

using Size = Eigen::Index;

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

} // namespace

ScaledFactor::ScaledFactor(const FactorPlan& plan, int block)
    : plan_(&plan), block_(block), single_(plan, block), full_(plan, block)
{
}

Eigen::VectorXd ScaledFactor::times(const Eigen::VectorXd& x, const Context& context) const
{
    Eigen::VectorXd y = Eigen::VectorXd::Zero(x.size());
    const auto n = static_cast<std::size_t>(plan_->size());
    const FactorPlan& plan = *plan_;
    if (block_ == 1) {
        for_each_chunk(context, n, chunk_columns, [&](std::size_t begin, std::size_t end) {
            for (std::size_t j = begin; j < end; ++j) {
                double sum = 0.0;
                for (int e = plan.column[j]; e < plan.column[j + 1]; ++e)
                    sum += values_[e] * x[plan.row[e]];
                for (int e = plan.lower_column[j] + 1; e < plan.lower_column[j + 1]; ++e)
                    sum += values_[plan.lower_slot[e]] * x[plan.lower_row[e]];
                y[static_cast<Size>(j)] = sum;
            }
        });
        return y;
    }
    // Row j of the blocks, then column j, whose blocks are the transposes: all are symmetric.
    for_each_chunk(context, n, chunk_columns, [&](std::size_t begin, std::size_t end) {
        for (std::size_t j = begin; j < end; ++j) {
            double sum[3] = {};
            const auto add = [&](int slot, int other) {
                const double* v = &values_[6 * static_cast<std::size_t>(slot)];
                const double* o = x.data() + 3 * static_cast<Size>(other);
                sum[0] += v[0] * o[0] + v[1] * o[1] + v[2] * o[2];
                sum[1] += v[1] * o[0] + v[3] * o[1] + v[4] * o[2];
                sum[2] += v[2] * o[0] + v[4] * o[1] + v[5] * o[2];
            };
            for (int e = plan.column[j]; e < plan.column[j + 1]; ++e)
                add(e, plan.row[e]);
            for (int e = plan.lower_column[j] + 1; e < plan.lower_column[j + 1]; ++e)
                add(plan.lower_slot[e], plan.lower_row[e]);
            for (int a = 0; a < 3; ++a)
                y[3 * static_cast<Size>(j) + a] = sum[a];
        }
    });
    return y;
}

bool ScaledFactor::factorize(Precision precision, const Context& context)
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
    precision_ = precision;
    has_factor_ = precision == Precision::single ? single_.factorize(values_, scale_, context)
                                                 : full_.factorize(values_, scale_, context);
    return has_factor_;
}

void ScaledFactor::solve_scaled(Eigen::VectorXd& x, const Context& context) const
{
    if (precision_ == Precision::full) {
        full_.solve(x, context);
        return;
    }
    Eigen::VectorXf rounded = x.cast<float>();
    single_.solve(rounded, context);
    x = rounded.cast<double>();
}

Eigen::VectorXd ScaledFactor::solve(const Eigen::VectorXd& right, const Context& context) const
{
    Eigen::VectorXd x = scale_.cwiseProduct(right);
    solve_scaled(x, context);
    return scale_.cwiseProduct(x);
}

Eigen::MatrixX3d ScaledFactor::solve_three(const Eigen::MatrixX3d& right,
                                           const Context& context) const
{
    Eigen::MatrixX3d x = scale_.asDiagonal() * right;
    full_.solve(x, context);
    return scale_.asDiagonal() * x;
}

double ScaledFactor::condition(const Context& context)
{
    // The norms grow from step to step; when they hardly do any more, the rest is not worth it.
    // Between rounds the outermost eigenvectors change little, so the last ones are a good start.
    const auto grow = [&](Eigen::VectorXd& v, const auto& apply) -> double {
        if (v.size() == 0)
            v = start_vector(size());
        double length = 0.0, last = -1.0;
        for (int i = 0; i < power_iterations && length > last * (1.0 + power_gain); ++i) {
            if (context.cancelled())
                return INFINITY;
            apply(v);
            last = length;
            length = v.norm();
            v /= length;
        }
        return length;
    };
    return grow(top_,
                [&](Eigen::VectorXd& v) {
                    v = scale_.cwiseProduct(times(scale_.cwiseProduct(v), context));
                }) *
           grow(bottom_, [&](Eigen::VectorXd& v) { solve_scaled(v, context); });
}

} // namespace bot2nurbs
