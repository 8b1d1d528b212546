// SPDX-License-Identifier: MIT
#include "fit/bernstein_gram.h"

#include <Eigen/Eigenvalues>

namespace bot2nurbs {

namespace {

using Matrix4 = Eigen::Matrix4d;

double binomial(int n, int k)
{
    double value = 1.0;
    for (int i = 1; i <= k; ++i)
        value = value * (n - k + i) / i;
    return value;
}

//! Integrals over [0, 1] of the products of Bernstein polynomials of degree n:
//! C(n, i) C(n, j) / (C(2 n, i + j) (2 n + 1)).
Eigen::MatrixXd gram(int n)
{
    Eigen::MatrixXd g(n + 1, n + 1);
    for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n; ++j)
            g(i, j) = binomial(n, i) * binomial(n, j) / (binomial(2 * n, i + j) * (2.0 * n + 1.0));
    return g;
}

//! Gram matrix of the order-th derivatives of the cubic Bernstein polynomials.
Matrix4 derivative_gram(int order)
{
    Eigen::MatrixXd difference = Eigen::MatrixXd::Identity(4, 4);
    for (int d = 0; d < order; ++d) {
        const Eigen::Index rows = difference.rows() - 1;
        const Eigen::MatrixXd next =
            static_cast<double>(rows) * (difference.bottomRows(rows) - difference.topRows(rows));
        difference = next;
    }
    return difference.transpose() * gram(3 - order) * difference;
}

Matrix16 kronecker(const Matrix4& u, const Matrix4& v)
{
    Matrix16 k;
    for (int i = 0; i < 16; ++i)
        for (int j = 0; j < 16; ++j)
            k(i, j) = u(i / 4, j / 4) * v(i % 4, j % 4);
    return k;
}

} // namespace

const Matrix16& thin_plate_matrix()
{
    static const Matrix16 energy = [] {
        const Matrix4 g0 = derivative_gram(0), g1 = derivative_gram(1), g2 = derivative_gram(2);
        return Matrix16(kronecker(g2, g0) + 2.0 * kronecker(g1, g1) + kronecker(g0, g2));
    }();
    return energy;
}

const Eigen::Matrix<double, 13, 16>& thin_plate_rows()
{
    static const Eigen::Matrix<double, 13, 16> rows = [] {
        // Eigenvalues ascend; the first three belong to the kernel and are zero up to rounding.
        const Eigen::SelfAdjointEigenSolver<Matrix16> solver(thin_plate_matrix());
        Eigen::Matrix<double, 13, 16> r;
        for (int i = 0; i < 13; ++i)
            r.row(i) = std::sqrt(solver.eigenvalues()[i + 3]) *
                       solver.eigenvectors().col(i + 3).transpose();
        return r;
    }();
    return rows;
}

} // namespace bot2nurbs
