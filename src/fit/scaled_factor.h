// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>

namespace bot2nurbs {

//! A symmetric positive definite sparse matrix, scaled to unit diagonal (Jacobi), and its Cholesky
//! factor. The caller orders the columns; the pattern is analysed once.
class ScaledFactor {
public:
    using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

    //! The upper triangle; the pattern must stay the same after the first `factorize`.
    Matrix& matrix() { return matrix_; }

    //! Scales and factorises `matrix()`. \return false when it is not positive definite to
    //! rounding.
    bool factorize();
    //! Solves with the unscaled matrix.
    Eigen::VectorXd solve(const Eigen::VectorXd& right) const;
    //! Estimate, from below, of the 2-norm condition of the scaled matrix, by power iteration on it
    //! and on its inverse.
    double condition() const;

private:
    Matrix matrix_;
    Eigen::VectorXd scale_;
    Eigen::SimplicialLDLT<Matrix, Eigen::Upper, Eigen::NaturalOrdering<int>> factor_;
    bool analysed_ = false;
};

} // namespace bot2nurbs
