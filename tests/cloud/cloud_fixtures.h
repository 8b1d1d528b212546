// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/vec.h"

#include <cmath>
#include <random>
#include <vector>

//! Points on known surfaces, with their outward unit normals.
namespace bot2nurbs::fixtures {

inline constexpr double pi = 3.14159265358979323846;

struct SampledSurface {
    std::vector<Vec3> points, normals;
};

//! Evenly spread over a sphere around `centre` (golden spiral).
inline SampledSurface sphere_points(std::size_t n, double radius = 1.0, const Vec3& centre = {})
{
    SampledSurface s;
    const double golden = 3.14159265358979323846 * (3.0 - std::sqrt(5.0));
    for (std::size_t i = 0; i < n; ++i) {
        const double z = 1.0 - (2.0 * double(i) + 1.0) / double(n), r = std::sqrt(1.0 - z * z);
        const Vec3 d{r * std::cos(golden * double(i)), r * std::sin(golden * double(i)), z};
        s.points.push_back(centre + radius * d);
        s.normals.push_back(d);
    }
    return s;
}

//! Scattered evenly over a torus about the z axis, by area.
inline SampledSurface torus_points(std::size_t n, double ring = 1.0, double tube = 0.4)
{
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    SampledSurface s;
    while (s.points.size() < n) {
        const double u = 2.0 * 3.14159265358979323846 * uniform(random);
        const double v = 2.0 * 3.14159265358979323846 * uniform(random);
        const double width = ring + tube * std::cos(v);
        if (uniform(random) * (ring + tube) > width)
            continue;
        s.points.push_back({width * std::cos(u), width * std::sin(u), tube * std::sin(v)});
        s.normals.push_back({std::cos(v) * std::cos(u), std::cos(v) * std::sin(u), std::sin(v)});
    }
    return s;
}

//! The points moved by normally distributed steps in every direction.
inline std::vector<Vec3> with_noise(std::vector<Vec3> points, double deviation)
{
    std::mt19937 random(11);
    std::normal_distribution<double> step(0.0, deviation);
    for (Vec3& p : points)
        p += Vec3{step(random), step(random), step(random)};
    return points;
}

inline SampledSurface joined(SampledSurface a, const SampledSurface& b)
{
    a.points.insert(a.points.end(), b.points.begin(), b.points.end());
    a.normals.insert(a.normals.end(), b.normals.begin(), b.normals.end());
    return a;
}

//! Share of normals on the right side.
inline double right_share(const std::vector<Vec3>& found, const std::vector<Vec3>& expected)
{
    std::size_t right = 0;
    for (std::size_t i = 0; i < found.size(); ++i)
        right += dot(found[i], expected[i]) > 0.0;
    return double(right) / double(found.size());
}

} // namespace bot2nurbs::fixtures
