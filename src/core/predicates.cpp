// SPDX-License-Identifier: MIT
#include "core/predicates.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace bot2nurbs {

namespace {

// Half an ulp of one: the relative rounding error of a single operation.
constexpr double rounding = std::numeric_limits<double>::epsilon() / 2.0;
// Forward error bounds of the plainly evaluated determinants \cite shewchuk_1997, section 4.
constexpr double orient2d_bound = (3.0 + 16.0 * rounding) * rounding;
constexpr double orient3d_bound = (7.0 + 56.0 * rounding) * rounding;

// An exact sum of doubles: nonoverlapping components of increasing magnitude, zeros left out.
template <std::size_t Capacity> struct Expansion {
    std::array<double, Capacity> part{};
    std::size_t size = 0;

    // Grow-Expansion with zero elimination \cite shewchuk_1997, theorem 10.
    void add(double value)
    {
        double carry = value;
        std::size_t kept = 0;
        for (std::size_t i = 0; i < size; ++i) {
            const double sum = carry + part[i];
            const double virtual_part = sum - carry;
            const double error = (carry - (sum - virtual_part)) + (part[i] - virtual_part);
            if (error != 0.0)
                part[kept++] = error;
            carry = sum;
        }
        if (carry != 0.0)
            part[kept++] = carry;
        size = kept;
    }

    // Adds a * b without rounding. The fused operation gives the product's error exactly.
    void add_product(double a, double b)
    {
        const double product = a * b;
        add(std::fma(a, b, -product));
        add(product);
    }

    int sign() const { return size == 0 ? 0 : (part[size - 1] > 0.0 ? 1 : -1); }
};

int orient2d_exact(const Vec2& a, const Vec2& b, const Vec2& c)
{
    Expansion<12> det;
    det.add_product(a.x, b.y);
    det.add_product(-a.y, b.x);
    det.add_product(b.x, c.y);
    det.add_product(-b.y, c.x);
    det.add_product(c.x, a.y);
    det.add_product(-c.y, a.x);
    return det.sign();
}

// The 2 x 2 minor p.x q.y - p.y q.x without rounding.
Expansion<4> minor_xy(const Vec3& p, const Vec3& q)
{
    Expansion<4> m;
    m.add_product(p.x, q.y);
    m.add_product(-p.y, q.x);
    return m;
}

int orient3d_exact(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
    // Expansion of the 4 x 4 determinant with rows (p.x, p.y, p.z, 1) by its z column: each z is
    // multiplied with three minors of the other points.
    const Expansion<4> ab = minor_xy(a, b), ac = minor_xy(a, c), ad = minor_xy(a, d);
    const Expansion<4> bc = minor_xy(b, c), bd = minor_xy(b, d), cd = minor_xy(c, d);
    Expansion<96> det;
    const auto add = [&det](double z, const Expansion<4>& m) {
        for (std::size_t i = 0; i < m.size; ++i)
            det.add_product(z, m.part[i]);
    };
    add(a.z, bc), add(-a.z, bd), add(a.z, cd);
    add(-b.z, ac), add(b.z, ad), add(-b.z, cd);
    add(c.z, ab), add(-c.z, ad), add(c.z, bd);
    add(-d.z, ab), add(d.z, ac), add(-d.z, bc);
    return det.sign();
}

} // namespace

int orient2d(const Vec2& a, const Vec2& b, const Vec2& c)
{
    const double left = (a.x - c.x) * (b.y - c.y);
    const double right = (a.y - c.y) * (b.x - c.x);
    const double det = left - right;
    const double bound = orient2d_bound * (std::fabs(left) + std::fabs(right));
    if (det > bound)
        return 1;
    if (det < -bound)
        return -1;
    return orient2d_exact(a, b, c);
}

int orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
    const Vec3 p = a - d, q = b - d, r = c - d;
    const double qr = q.x * r.y, rq = r.x * q.y;
    const double rp = r.x * p.y, pr = p.x * r.y;
    const double pq = p.x * q.y, qp = q.x * p.y;
    const double det = p.z * (qr - rq) + q.z * (rp - pr) + r.z * (pq - qp);
    const double permanent = (std::fabs(qr) + std::fabs(rq)) * std::fabs(p.z) +
                             (std::fabs(rp) + std::fabs(pr)) * std::fabs(q.z) +
                             (std::fabs(pq) + std::fabs(qp)) * std::fabs(r.z);
    const double bound = orient3d_bound * permanent;
    if (det > bound)
        return 1;
    if (det < -bound)
        return -1;
    return orient3d_exact(a, b, c, d);
}

} // namespace bot2nurbs
