// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "fit/frontal_factor.h"

#include <Eigen/Core>
#include <cmath>
#include <optional>

namespace bot2nurbs {

//! A symmetric positive definite sparse matrix of symmetric b x b blocks, b = 1 or 3, and a
//! Cholesky factor of it, scaled to unit diagonal (Jacobi). The factor may be left behind when the
//! matrix changes: it then preconditions conjugate gradients.
class ScaledFactor {
public:
    //! Single precision takes half the time and memory, for a factor that is good enough to
    //! precondition with unless the matrix is nearly singular.
    enum class Precision { single, full };

    //! The plan must outlive this.
    ScaledFactor(const FactorPlan& plan, int block);

    //! Values per slot of the plan: 1, or 6 for the blocks xx, xy, xz, yy, yz, zz.
    std::vector<double>& values() { return values_; }
    //! Scalar rows.
    Eigen::Index size() const { return static_cast<Eigen::Index>(plan_->size()) * block_; }
    //! The matrix, as it is now, times a vector.
    Eigen::VectorXd times(const Eigen::VectorXd& x, const Context& context) const;

    //! Scales and factorises. \return false when the matrix is not positive definite to rounding or
    //! the context was cancelled, which is polled at every panel; there is then no factor.
    bool factorize(Precision precision, const Context& context);
    bool has_factor() const { return has_factor_; }
    //! Forgets a factor that is not to be trusted.
    void drop_factor() { has_factor_ = false; }
    //! Solves with the matrix that was factorised last, to the precision of the factor.
    //! \pre has_factor()
    Eigen::VectorXd solve(const Eigen::VectorXd& right, const Context& context) const;
    //! The same for three right-hand sides in one pass over the factor. \pre full precision
    Eigen::MatrixX3d solve_three(const Eigen::MatrixX3d& right, const Context& context) const;
    //! Estimate, from below, of the 2-norm condition of the scaled matrix, by power iteration on it
    //! and on its inverse. \pre `factorize` was the last change of the matrix
    //! Infinite when the context was cancelled.
    double condition(const Context& context);

private:
    //! In place, with the scaled matrix.
    void solve_scaled(Eigen::VectorXd& x, const Context& context) const;

    const FactorPlan* plan_;
    int block_;
    std::vector<double> values_;
    Eigen::VectorXd scale_;
    FrontalFactor<float> single_;
    FrontalFactor<double> full_;
    Precision precision_ = Precision::full;
    bool has_factor_ = false;
    Eigen::VectorXd top_, bottom_; //!< Last estimates of the outermost eigenvectors.
};

//! When conjugate gradients stop.
struct GradientLimits {
    int iterations = 0;
    //! Of the error, as a share of the solution, both in the energy norm of the matrix, as far as
    //! the preconditioner is its inverse.
    double tolerance = 0.0;
};

//! Solves `matrix` (positive definite) by conjugate gradients, preconditioned by `precondition`,
//! from x: zero, or nearly the solution. \return nothing when it broke down, would clearly take
//! more iterations than allowed, or the context was cancelled.
template <class Precondition> std::optional<Eigen::VectorXd>
conjugate_gradients(const ScaledFactor& matrix, const Eigen::VectorXd& right, Eigen::VectorXd x,
                    const GradientLimits& limits, const Precondition& precondition,
                    const Context& context)
{
    // Iterations after which the rate so far says whether the rest is worth while.
    constexpr int trial = 4;
    // A start that points away from the solution is none.
    const double along = right.dot(x);
    const bool from_zero = !(along > 0.0);
    if (from_zero)
        x.setZero();
    Eigen::VectorXd r = from_zero ? right : right - matrix.times(x, context);
    Eigen::VectorXd z = precondition(r), p = z;
    double rz = r.dot(z);
    const double first = rz, scale = from_zero ? rz : along;
    const double enough = limits.tolerance * limits.tolerance * scale;
    if (!(rz >= 0.0))
        return std::nullopt;
    if (rz == 0.0 || (!from_zero && rz <= enough))
        return x;
    for (int i = 1; i <= limits.iterations && !context.cancelled(); ++i) {
        const Eigen::VectorXd q = matrix.times(p, context);
        const double curvature = p.dot(q);
        if (!(curvature > 0.0) || !(rz > 0.0))
            return std::nullopt;
        const double step = rz / curvature;
        x += step * p;
        r -= step * q;
        z = precondition(r);
        const double next = r.dot(z);
        if (next <= enough)
            return x;
        if (i >= trial && i * std::log(enough / first) < limits.iterations * std::log(next / first))
            return std::nullopt;
        p = z + (next / rz) * p;
        rz = next;
    }
    return std::nullopt;
}

} // namespace bot2nurbs
