// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "fit/factor_plan.h"

#include <Eigen/Core>
#include <optional>

namespace bot2nurbs {

//! A symmetric positive definite sparse matrix of symmetric b x b blocks, b = 1 or 3, and a
//! Cholesky factor of it, scaled to unit diagonal (Jacobi). The factorisation is multifrontal: all
//! arithmetic is in dense kernels. The factor may be left behind when the matrix changes: it then
//! preconditions conjugate gradients.
class ScaledFactor {
public:
    //! The plan must outlive this.
    ScaledFactor(const FactorPlan& plan, int block);

    //! Values per slot of the plan: 1, or 6 for the blocks xx, xy, xz, yy, yz, zz.
    std::vector<double>& values() { return values_; }
    //! Scalar rows.
    Eigen::Index size() const { return static_cast<Eigen::Index>(plan_->size()) * block_; }
    //! The matrix, as it is now, times a vector.
    Eigen::VectorXd times(const Eigen::VectorXd& x) const;

    //! Scales and factorises. \return false when the matrix is not positive definite to rounding or
    //! the context was cancelled, which is polled at every panel; there is then no factor.
    bool factorize(const Context& context);
    bool has_factor() const { return has_factor_; }
    //! Forgets a factor that is not to be trusted.
    void drop_factor() { has_factor_ = false; }
    //! Solves with the matrix that was factorised last. \pre has_factor()
    Eigen::VectorXd solve(const Eigen::VectorXd& right) const;
    //! The same for three right-hand sides in one pass over the factor.
    Eigen::MatrixX3d solve_three(const Eigen::MatrixX3d& right) const;
    //! Estimate, from below, of the 2-norm condition of the scaled matrix, by power iteration on it
    //! and on its inverse. \pre `factorize` was the last change of the matrix
    //! Infinite when the context was cancelled.
    double condition(const Context& context) const;

private:
    void assemble_front(const FactorPlan::Supernode& node, const std::vector<int>& local,
                        Eigen::Ref<Eigen::MatrixXd> front) const;
    //! In place, with the scaled matrix.
    template <class Columns> void solve_scaled(Columns& x) const;

    const FactorPlan* plan_;
    int block_;
    std::vector<double> values_, factor_;
    Eigen::VectorXd scale_;
    bool has_factor_ = false;
};

//! Solves `matrix` (positive definite) by conjugate gradients, preconditioned by `precondition`,
//! from zero, until the preconditioned residual is `tolerance` of its start.
//! \return nothing when it took more than `limit` iterations, broke down or `cancelled()` said so.
template <class Precondition, class Cancelled> std::optional<Eigen::VectorXd>
conjugate_gradients(const ScaledFactor& matrix, const Eigen::VectorXd& right, int limit,
                    double tolerance, const Precondition& precondition, const Cancelled& cancelled)
{
    Eigen::VectorXd x = Eigen::VectorXd::Zero(right.size()), r = right, z = precondition(r), p = z;
    double rz = r.dot(z);
    const double enough = tolerance * tolerance * rz;
    if (rz == 0.0)
        return x;
    for (int i = 0; i < limit && !cancelled(); ++i) {
        const Eigen::VectorXd q = matrix.times(p);
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
        p = z + (next / rz) * p;
        rz = next;
    }
    return std::nullopt;
}

} // namespace bot2nurbs
