// SPDX-License-Identifier: MIT
#include "core/predicates.h"

#include <boost/multiprecision/cpp_int.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace bot2nurbs {
namespace {

using Rational = boost::multiprecision::cpp_rational;

int sign_of(const Rational& r)
{
    return r > 0 ? 1 : (r < 0 ? -1 : 0);
}

int orient2d_rational(const Vec2& a, const Vec2& b, const Vec2& c)
{
    const Rational ax(a.x), ay(a.y), bx(b.x), by(b.y), cx(c.x), cy(c.y);
    return sign_of((ax - cx) * (by - cy) - (ay - cy) * (bx - cx));
}

int orient3d_rational(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
    const auto row = [&d](const Vec3& p) {
        return std::array<Rational, 3>{Rational(p.x) - Rational(d.x), Rational(p.y) - Rational(d.y),
                                       Rational(p.z) - Rational(d.z)};
    };
    const auto p = row(a), q = row(b), r = row(c);
    return sign_of(p[0] * (q[1] * r[2] - q[2] * r[1]) - p[1] * (q[0] * r[2] - q[2] * r[0]) +
                   p[2] * (q[0] * r[1] - q[1] * r[0]));
}

// Points on a common line or plane moved by a few ulps: the hardest inputs for a predicate.
double nudge(double x, std::mt19937& random)
{
    for (unsigned steps = random() % 4; steps > 0; --steps)
        x = std::nextafter(x, random() % 2 ? 10.0 : -10.0);
    return x;
}

TEST(Predicates, orient2d_equals_rational_arithmetic_on_nearly_collinear_points)
{
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    int zeros = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vec2 a{uniform(random), uniform(random)}, b{uniform(random), uniform(random)};
        const double t = i % 3 == 0 ? 0.5 : uniform(random);
        const Vec2 c{nudge(a.x + t * (b.x - a.x), random), nudge(a.y + t * (b.y - a.y), random)};
        const int expected = orient2d_rational(a, b, c);
        zeros += expected == 0;
        ASSERT_EQ(orient2d(a, b, c), expected);
        ASSERT_EQ(orient2d(b, a, c), -expected);
    }
    EXPECT_GT(zeros, 0);
}

TEST(Predicates, orient3d_equals_rational_arithmetic_on_nearly_coplanar_points)
{
    std::mt19937 random(2);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    for (int i = 0; i < 5000; ++i) {
        const Vec3 a{uniform(random), uniform(random), uniform(random)};
        const Vec3 b{uniform(random), uniform(random), uniform(random)};
        const Vec3 c{uniform(random), uniform(random), uniform(random)};
        const double s = uniform(random), t = uniform(random);
        Vec3 d = a + s * (b - a) + t * (c - a);
        d = {nudge(d.x, random), nudge(d.y, random), nudge(d.z, random)};
        ASSERT_EQ(orient3d(a, b, c, d), orient3d_rational(a, b, c, d));
    }
}

TEST(Predicates, orient3d_is_positive_below_a_counter_clockwise_triangle)
{
    const Vec3 a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0};
    EXPECT_EQ(orient3d(a, b, c, {0, 0, -1}), 1);
    EXPECT_EQ(orient3d(a, b, c, {0, 0, 1}), -1);
    EXPECT_EQ(orient3d(a, b, c, {5, 7, 0}), 0);
}

} // namespace
} // namespace bot2nurbs
