// SPDX-License-Identifier: MIT
#pragma once

#include "fit/polled_double.h"

#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>
#include <optional>

namespace bot2nurbs {

//! A symmetric positive definite sparse matrix and a Cholesky factor of it, scaled to unit diagonal
//! (Jacobi). The caller orders the columns; the pattern is analysed once. The factor may be left
//! behind when the matrix changes: it then preconditions conjugate gradients.
class ScaledFactor {
public:
    using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

    //! The upper triangle; the pattern must stay the same after the first `factorize`.
    Matrix& matrix() { return matrix_; }
    const Matrix& matrix() const { return matrix_; }

    //! Scales and factorises `matrix()`. \return false when it is not positive definite to rounding
    //! or the context was cancelled, which is polled at every column; there is then no factor.
    bool factorize(const Context& context);
    bool has_factor() const { return has_factor_; }
    //! Forgets a factor that is not to be trusted.
    void drop_factor() { has_factor_ = false; }
    //! Solves with the matrix that was factorised last. \pre has_factor()
    Eigen::VectorXd solve(const Eigen::VectorXd& right) const;
    //! Estimate, from below, of the 2-norm condition of the scaled matrix, by power iteration on it
    //! and on its inverse. \pre `factorize` was the last change of the matrix
    //! Infinite when the context was cancelled.
    double condition(const Context& context) const;

private:
    Matrix matrix_;
    Eigen::VectorXd scale_;
    using PolledMatrix = Eigen::SparseMatrix<PolledDouble, Eigen::ColMajor, int>;

    Eigen::VectorXd solve_scaled(const Eigen::VectorXd& right) const;

    PolledMatrix polled_;
    Eigen::SimplicialLDLT<PolledMatrix, Eigen::Upper, Eigen::NaturalOrdering<int>> factor_;
    bool analysed_ = false, has_factor_ = false;
};

//! Solves `matrix` (upper triangle, positive definite) by conjugate gradients, preconditioned by
//! `precondition`, from zero, until the preconditioned residual is `tolerance` of its start.
//! \return nothing when it took more than `limit` iterations, broke down or `cancelled()` said so.
template <class Precondition, class Cancelled> std::optional<Eigen::VectorXd>
conjugate_gradients(const ScaledFactor::Matrix& matrix, const Eigen::VectorXd& right, int limit,
                    double tolerance, const Precondition& precondition, const Cancelled& cancelled)
{
    Eigen::VectorXd x = Eigen::VectorXd::Zero(right.size()), r = right, z = precondition(r), p = z;
    double rz = r.dot(z);
    const double enough = tolerance * tolerance * rz;
    if (rz == 0.0)
        return x;
    for (int i = 0; i < limit && !cancelled(); ++i) {
        const Eigen::VectorXd q = matrix.selfadjointView<Eigen::Upper>() * p;
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
