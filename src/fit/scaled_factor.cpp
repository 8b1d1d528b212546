// SPDX-License-Identifier: MIT
#include "fit/scaled_factor.h"

#include <cmath>

namespace bot2nurbs {

namespace {

//! Power iterations of the condition estimate. The extreme eigenvalues of a fit's matrix are well
//! apart from the bulk at neither end; ten iterations give the condition within a factor of about
//! two, which is what a limit of powers of ten needs.
constexpr int power_iterations = 10;

//! A fixed start vector that no eigenvector of a mesh problem is orthogonal to in practice.
Eigen::VectorXd start_vector(Eigen::Index n)
{
    Eigen::VectorXd v(n);
    std::uint32_t state = 12345u;
    for (Eigen::Index i = 0; i < n; ++i) {
        state = state * 1664525u + 1013904223u;
        v[i] = static_cast<double>(state >> 8) / 16777216.0 - 0.5;
    }
    return v.normalized();
}

} // namespace

bool ScaledFactor::factorize(const Context& context)
{
    has_factor_ = false;
    const Eigen::Index n = matrix_.cols();
    scale_.resize(n);
    for (Eigen::Index j = 0; j < n; ++j) {
        // The diagonal is the last entry of a column of the upper triangle.
        const double d = matrix_.valuePtr()[matrix_.outerIndexPtr()[j + 1] - 1];
        if (!(d > 0.0) || !std::isfinite(d))
            return false;
        scale_[j] = 1.0 / std::sqrt(d);
    }
    if (!analysed_)
        polled_ = matrix_.cast<PolledDouble>();
    for (Eigen::Index j = 0; j < n; ++j)
        for (int e = matrix_.outerIndexPtr()[j]; e < matrix_.outerIndexPtr()[j + 1]; ++e)
            polled_.valuePtr()[e] =
                matrix_.valuePtr()[e] * scale_[matrix_.innerIndexPtr()[e]] * scale_[j];
    if (!analysed_) {
        factor_.analyzePattern(polled_);
        analysed_ = true;
    }
    const PolledDouble::Scope scope(context);
    factor_.factorize(polled_);
    if (factor_.info() != Eigen::Success || context.cancelled())
        return false;
    const auto& pivots = factor_.vectorD();
    for (Eigen::Index i = 0; i < n; ++i)
        if (!(pivots[i] > 0.0))
            return false;
    has_factor_ = true;
    return true;
}

Eigen::VectorXd ScaledFactor::solve_scaled(const Eigen::VectorXd& right) const
{
    const Eigen::Matrix<PolledDouble, Eigen::Dynamic, 1> polled = right.cast<PolledDouble>();
    const Eigen::Matrix<PolledDouble, Eigen::Dynamic, 1> x = factor_.solve(polled);
    return x.cast<double>();
}

Eigen::VectorXd ScaledFactor::solve(const Eigen::VectorXd& right) const
{
    return scale_.cwiseProduct(solve_scaled(scale_.cwiseProduct(right)));
}

double ScaledFactor::condition(const Context& context) const
{
    Eigen::VectorXd v = start_vector(matrix_.cols());
    double largest = 0.0, inverse_largest = 0.0;
    for (int i = 0; i < power_iterations && !context.cancelled(); ++i) {
        const Eigen::VectorXd w =
            scale_.cwiseProduct(matrix_.selfadjointView<Eigen::Upper>() * scale_.cwiseProduct(v));
        largest = w.norm();
        v = w / largest;
    }
    v = start_vector(matrix_.cols());
    for (int i = 0; i < power_iterations && !context.cancelled(); ++i) {
        const Eigen::VectorXd w = solve_scaled(v);
        inverse_largest = w.norm();
        v = w / inverse_largest;
    }
    return context.cancelled() ? INFINITY : largest * inverse_largest;
}

} // namespace bot2nurbs
