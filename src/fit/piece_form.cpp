// SPDX-License-Identifier: MIT
#include "fit/piece_form.h"

#include "fit/bernstein_gram.h"
#include "spline/bernstein.h"

#include <algorithm>

namespace bot2nurbs {

PieceForm::PieceForm(const ReducedNetwork& network, Index piece, int blocks, double* out)
    : network_(network), piece_(piece), size_(network.piece_size(piece)), blocks_(blocks),
      block_(out), right_(out + blocks * pairs(size_))
{
    std::fill(out, out + doubles(size_, blocks), 0.0);
}

//! Adds weight times product of rows_at_a_time rows, which loads and stores each sum once.
void PieceForm::add_products(const double* products, const RowWeights* weights)
{
    const std::size_t count = pairs(size_);
    const double *p = products, *q = p + count, *r = q + count, *s = r + count;
    for (int m = 0; m < blocks_; ++m) {
        double* sum = block_ + m * count;
        const double w = weights[0][m], x = weights[1][m], y = weights[2][m], z = weights[3][m];
        for (std::size_t e = 0; e < count; ++e)
            sum[e] = sum[e] + w * p[e] + x * q[e] + y * r[e] + z * s[e];
    }
}

void PieceForm::add_rows(const RoundProblem& problem, std::vector<double>& scratch)
{
    const std::size_t k = size_, count = pairs(k);
    scratch.assign(k + rows_at_a_time * count, 0.0); // What is missing of the last rows is zero.
    double *basis = scratch.data(), *products = basis + k, *next = products;
    RowWeights row_weights[rows_at_a_time] = {};
    std::size_t pending = 0;
    for (std::size_t o = problem.groups->offset[piece_]; o < problem.groups->offset[piece_ + 1];
         ++o) {
        const FitRow& row = (*problem.rows)[problem.groups->order[o]];
        const Cubic bs = bernstein(row.s), bt = bernstein(row.t);
        std::fill(basis, basis + k, 0.0);
        const double* weights = network_.piece_weights(piece_);
        for (int c = 0; c < ReducedNetwork::coefficients; ++c, weights += k) {
            const double phi = bs[c / 4] * bt[c % 4];
            for (std::size_t i = 0; i < k; ++i)
                basis[i] += phi * weights[i];
        }
        const Vec3 &n = row.normal, &r = row.residual;
        const double mu = std::max(problem.mu, row.least_mu);
        // A row without a normal counts in full in every direction, one of a curve in all but one.
        const double less = (1.0 - mu) * row.weight;
        const double along = n == Vec3{} ? 0.0 : row.of_curve ? -less : less;
        const double all = n == Vec3{} || row.of_curve ? row.weight : mu * row.weight;
        const Vec3 wanted = along * dot(n, r) * n + all * r;
        for (std::size_t i = 0; i < k; ++i)
            for (int c = 0; c < 3; ++c)
                right_[3 * i + c] += basis[i] * wanted[c];
        for (std::size_t i = 0; i < k; ++i) {
            for (std::size_t j = i; j < k; ++j)
                next[j - i] = basis[i] * basis[j];
            next += k - i;
        }
        row_weights[pending] = {along * n.x * n.x + all, along * n.x * n.y,
                                along * n.x * n.z,       along * n.y * n.y + all,
                                along * n.y * n.z,       along * n.z * n.z + all};
        if (blocks_ == 1)
            row_weights[pending][0] = row.weight;
        if (++pending == rows_at_a_time) {
            add_products(products, row_weights);
            pending = 0;
            next = products;
        }
    }
    if (pending == 0)
        return;
    for (; pending < rows_at_a_time; ++pending)
        row_weights[pending] = {};
    add_products(products, row_weights);
}

void PieceForm::add_fairness(const RoundProblem& problem, const double* energy)
{
    const Index k = size_;
    const std::size_t count = pairs(k);
    const double f = (*problem.fairness)[piece_ / ReducedNetwork::pieces_per_quad];
    for (const int m : {0, 3, 5}) {
        if (m >= blocks_)
            break;
        for (std::size_t e = 0; e < count; ++e)
            block_[m * count + e] += f * energy[e];
    }
    if (problem.bezier->empty())
        return;
    Eigen::Matrix<double, 16, 3> x;
    for (Index i = 0; i < 16; ++i) {
        const Vec3& p = (*problem.bezier)[bezier_index(piece_, i)];
        x.row(i) << p.x, p.y, p.z;
    }
    const Eigen::Matrix<double, 16, 3> force = f * (thin_plate_matrix() * x);
    const double* weights = network_.piece_weights(piece_);
    for (Index c = 0; c < 16; ++c)
        for (Index i = 0; i < k; ++i)
            for (int a = 0; a < 3; ++a)
                right_[3 * i + a] -= weights[k * c + i] * force(c, a);
}

} // namespace bot2nurbs
