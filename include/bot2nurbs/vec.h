// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>

namespace bot2nurbs {

//! A point or vector in space.
struct Vec3 {
    double x = 0.0, y = 0.0, z = 0.0;

    double& operator[](int i) { return i == 0 ? x : (i == 1 ? y : z); }
    double operator[](int i) const { return i == 0 ? x : (i == 1 ? y : z); }

    Vec3& operator+=(const Vec3& b)
    {
        x += b.x, y += b.y, z += b.z;
        return *this;
    }
    Vec3& operator-=(const Vec3& b)
    {
        x -= b.x, y -= b.y, z -= b.z;
        return *this;
    }
    Vec3& operator*=(double s)
    {
        x *= s, y *= s, z *= s;
        return *this;
    }
    friend bool operator==(const Vec3& a, const Vec3& b)
    {
        return a.x == b.x && a.y == b.y && a.z == b.z;
    }
    friend bool operator!=(const Vec3& a, const Vec3& b) { return !(a == b); }
};

inline Vec3 operator+(const Vec3& a, const Vec3& b)
{
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vec3 operator-(const Vec3& a, const Vec3& b)
{
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vec3 operator-(const Vec3& a)
{
    return {-a.x, -a.y, -a.z};
}
inline Vec3 operator*(double s, const Vec3& a)
{
    return {s * a.x, s * a.y, s * a.z};
}
inline Vec3 operator*(const Vec3& a, double s)
{
    return s * a;
}
inline Vec3 operator/(const Vec3& a, double s)
{
    return {a.x / s, a.y / s, a.z / s};
}
inline double dot(const Vec3& a, const Vec3& b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Vec3 cross(const Vec3& a, const Vec3& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double norm_squared(const Vec3& a)
{
    return dot(a, a);
}
inline double norm(const Vec3& a)
{
    return std::sqrt(dot(a, a));
}
//! `a` scaled to length one; the zero vector stays zero.
inline Vec3 normalized(const Vec3& a)
{
    const double n = norm(a);
    return n > 0.0 ? a / n : Vec3{};
}
inline bool is_finite(const Vec3& a)
{
    return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

//! A point in a parameter plane.
struct Vec2 {
    double x = 0.0, y = 0.0;
    friend bool operator==(const Vec2& a, const Vec2& b) { return a.x == b.x && a.y == b.y; }
};

inline Vec2 operator+(const Vec2& a, const Vec2& b)
{
    return {a.x + b.x, a.y + b.y};
}
inline Vec2 operator-(const Vec2& a, const Vec2& b)
{
    return {a.x - b.x, a.y - b.y};
}
inline Vec2 operator*(double s, const Vec2& a)
{
    return {s * a.x, s * a.y};
}
inline double dot(const Vec2& a, const Vec2& b)
{
    return a.x * b.x + a.y * b.y;
}
inline double cross(const Vec2& a, const Vec2& b)
{
    return a.x * b.y - a.y * b.x;
}
inline double norm(const Vec2& a)
{
    return std::sqrt(dot(a, a));
}

//! An axis-aligned box; empty until a point is added.
struct Box3 {
    Vec3 min{INFINITY, INFINITY, INFINITY};
    Vec3 max{-INFINITY, -INFINITY, -INFINITY};

    //! Coordinates that are not numbers are ignored.
    void add(const Vec3& p)
    {
        // Comparisons become single instructions, which fmin and fmax do not.
        min = {p.x < min.x ? p.x : min.x, p.y < min.y ? p.y : min.y, p.z < min.z ? p.z : min.z};
        max = {p.x > max.x ? p.x : max.x, p.y > max.y ? p.y : max.y, p.z > max.z ? p.z : max.z};
    }
    bool empty() const { return !(min.x <= max.x); }
    Vec3 center() const { return 0.5 * (min + max); }
    double diagonal() const { return empty() ? 0.0 : norm(max - min); }
};

} // namespace bot2nurbs
