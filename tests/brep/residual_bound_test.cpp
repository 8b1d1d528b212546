// SPDX-License-Identifier: MIT
#include "brep/residual_bound.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace bot2nurbs {
namespace {

Vec3 value(const QuadraticResidual& f, double a, double b, double c)
{
    return a * f.r[0] + b * f.r[1] + c * f.r[2] - (a * b) * f.q[0] - (b * c) * f.q[1] -
           (c * a) * f.q[2];
}

//! The largest length on a grid of n steps.
double sampled(const QuadraticResidual& f, int n)
{
    double most = 0.0;
    for (int i = 0; i <= n; ++i)
        for (int j = 0; i + j <= n; ++j)
            most =
                std::max(most, norm(value(f, double(n - i - j) / n, double(i) / n, double(j) / n)));
    return most;
}

class Random {
public:
    explicit Random(unsigned seed) : engine_(seed) {}
    double operator()(double size = 1.0)
    {
        return std::uniform_real_distribution<double>(-size, size)(engine_);
    }
    Vec3 vector(double size = 1.0) { return {(*this)(size), (*this)(size), (*this)(size)}; }

private:
    std::mt19937 engine_;
};

TEST(ResidualBound, is_above_every_value_and_its_place_is_in_the_triangle)
{
    Random random(1);
    for (int n = 0; n < 3000; ++n) {
        QuadraticResidual f;
        const double bend = n % 3 == 0 ? 0.1 : n % 3 == 1 ? 1.0 : 10.0;
        for (int k = 0; k < 3; ++k) {
            f.r[k] = random.vector();
            f.q[k] = random.vector(bend);
        }
        const Vec3 direction = n % 7 == 0 ? Vec3{} : normalized(random.vector());
        const ResidualBound bound = residual_bound(f, direction);
        EXPECT_GE(bound.bound, sampled(f, 40) * (1 - 1e-14));
        const auto& c = bound.weight;
        EXPECT_NEAR(c[0] + c[1] + c[2], 1.0, 1e-12);
        for (const double w : c)
            EXPECT_GE(w, -1e-15);
        EXPECT_NEAR(bound.length, norm(value(f, c[0], c[1], c[2])), 1e-12);
        EXPECT_LE(bound.length, bound.bound * (1 + 1e-14));
    }
}

TEST(ResidualBound, is_the_maximum_of_what_is_along_the_direction)
{
    Random random(2);
    const Vec3 n = normalized(Vec3{1, 2, -2});
    for (int k = 0; k < 500; ++k) {
        QuadraticResidual f;
        for (int i = 0; i < 3; ++i) {
            f.r[i] = random() * n;
            f.q[i] = random(8.0) * n;
        }
        const ResidualBound bound = residual_bound(f, n);
        const double below = sampled(f, 200);
        EXPECT_GE(bound.bound, below * (1 - 1e-14));
        // A grid of step h misses at most q h^2 / 2 of a maximum.
        EXPECT_LE(bound.bound, below + 8.0 / (200.0 * 200.0) + 1e-14);
        EXPECT_NEAR(bound.length, bound.bound, 1e-12);
    }
}

TEST(ResidualBound, of_a_bulge_over_an_equilateral_triangle_is_a_third_of_its_bend)
{
    // All three sides bend alike: the middle is at -q / 3.
    const Vec3 q{0, 0, 0.3};
    const ResidualBound bound = residual_bound({{Vec3{}, Vec3{}, Vec3{}}, {q, q, q}}, {0, 0, 1});
    EXPECT_NEAR(bound.bound, 0.1, 1e-16);
    EXPECT_NEAR(bound.weight[0], 1.0 / 3.0, 1e-9);
}

TEST(ResidualBound, holds_where_the_critical_point_is_ill_conditioned)
{
    // Bent in one direction only, or nearly: a ridge through the triangle.
    Random random(3);
    const Vec3 n{0, 0, 1};
    for (int k = 0; k < 2000; ++k) {
        const double x = random(), y = random(), flat = std::pow(10.0, -20.0 * std::abs(random()));
        // Second differences of -(x s + y t)^2 - flat (s^2 + t^2) along the three sides.
        const auto bend = [&](double s, double t) {
            return -(x * s + y * t) * (x * s + y * t) - flat * (s * s + t * t);
        };
        const QuadraticResidual f{{random() * n, random() * n, random() * n},
                                  {bend(1, 0) * n, bend(-1, 1) * n, bend(0, -1) * n}};
        const ResidualBound bound = residual_bound(f, n);
        const double below = sampled(f, 100);
        EXPECT_GE(bound.bound, below * (1 - 1e-14));
        EXPECT_LE(bound.bound, below + 8.0 / (100.0 * 100.0) + 1e-5);
    }
}

TEST(ResidualBound, allows_for_what_is_across_the_direction)
{
    // Along: 3 in the corners. Across: 4 in one of them.
    const Vec3 along{0, 0, 3};
    const ResidualBound bound =
        residual_bound({{along, along, along + Vec3{4, 0, 0}}, {}}, {0, 0, 1});
    EXPECT_NEAR(bound.bound, 5.0, 1e-15);
    EXPECT_EQ(bound.weight[2], 1.0);
    EXPECT_NEAR(bound.length, 5.0, 1e-15);
}

} // namespace
} // namespace bot2nurbs
