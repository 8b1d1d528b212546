// SPDX-License-Identifier: MIT
#include "fit/bernstein_gram.h"

#include "bot2nurbs/spline_network.h"

#include <cmath>
#include <gtest/gtest.h>

namespace bot2nurbs {
namespace {

using Coefficients = Eigen::Matrix<double, 16, 1>;

//! Bezier coefficients of a polynomial u^a v^b, a, b <= 3: blossom values at multiples of 1/3.
Coefficients monomial(int a, int b)
{
    // Cubic Bezier coefficients of t^k: coefficient i is C(i, k) / C(3, k).
    static constexpr double power[4][4] = {
        {1, 1, 1, 1}, {0, 1.0 / 3, 2.0 / 3, 1}, {0, 0, 1.0 / 3, 1}, {0, 0, 0, 1}};
    Coefficients c;
    for (int i = 0; i < 16; ++i)
        c[i] = power[a][i / 4] * power[b][i % 4];
    return c;
}

//! Integral over the unit square of f_uu g_uu + 2 f_uv g_uv + f_vv g_vv for monomials.
double exact(int a, int b, int c, int d)
{
    const auto moment = [](int p, int q, double factor) {
        return factor == 0.0 ? 0.0 : factor / ((p + 1.0) * (q + 1.0));
    };
    return moment(a + c - 4, b + d, double(a * (a - 1)) * c * (c - 1)) +
           2.0 * moment(a + c - 2, b + d - 2, double(a * b) * c * d) +
           moment(a + c, b + d - 4, double(b * (b - 1)) * d * (d - 1));
}

TEST(ThinPlate, is_exact_for_every_pair_of_monomials)
{
    for (int f = 0; f < 16; ++f)
        for (int g = 0; g < 16; ++g) {
            const double energy =
                monomial(f / 4, f % 4).dot(thin_plate_matrix() * monomial(g / 4, g % 4));
            EXPECT_NEAR(energy, exact(f / 4, f % 4, g / 4, g % 4), 1e-12) << f << " " << g;
        }
}

TEST(ThinPlate, is_symmetric_and_vanishes_exactly_on_planes)
{
    const Matrix16& e = thin_plate_matrix();
    EXPECT_LT((e - e.transpose()).cwiseAbs().maxCoeff(), 1e-14);
    for (const auto& [a, b] : {std::pair{0, 0}, std::pair{1, 0}, std::pair{0, 1}})
        EXPECT_LT((e * monomial(a, b)).cwiseAbs().maxCoeff(), 1e-13);
    EXPECT_GT(monomial(1, 1).dot(e * monomial(1, 1)), 1.0);
}

TEST(ThinPlate, equals_the_square_of_its_rows)
{
    const Matrix16 square = thin_plate_rows().transpose() * thin_plate_rows();
    EXPECT_LT((square - thin_plate_matrix()).cwiseAbs().maxCoeff(), 1e-12);
}

} // namespace
} // namespace bot2nurbs
