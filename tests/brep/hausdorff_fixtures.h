// SPDX-License-Identifier: MIT
#pragma once

//! Surfaces for tests of Hausdorff bounds, and distances found by brute force.

#include "bot2nurbs/closest_point.h"
#include "brep_fixtures.h"
#include "mesh_fixtures.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace bot2nurbs::fixtures {

//! Straight-sided patches: the exact bilinear surface of every quad.
inline SplineSurface flat_patches(const Domain& domain)
{
    return surface_of_points(domain.complex.quad_count(), [&](Index q, Index i, Index j) {
        const auto& c = domain.complex.quad(q);
        const auto& p = domain.positions;
        const double u = i / 12.0, v = j / 12.0;
        return (1 - u) * ((1 - v) * p[c[0]] + v * p[c[3]]) + u * ((1 - v) * p[c[1]] + v * p[c[2]]);
    });
}

//! A network near the unit sphere whose coefficients are moved at random, G1 as ever.
inline SplineSurface wavy_sphere(const Domain& domain, unsigned seed, double amplitude)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> shift(-amplitude, amplitude);
    return network_surface(domain, [&](const Vec3& p) {
        return normalized(p) + Vec3{shift(random), shift(random), shift(random)};
    });
}

//! One piece with random control points around a plane rectangle.
inline std::vector<Vec3> random_control(std::mt19937& random, double bend)
{
    std::uniform_real_distribution<double> shift(-bend, bend);
    std::vector<Vec3> control;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
            control.push_back({i / 3.0 + shift(random), j / 3.0 + shift(random), shift(random)});
    return control;
}

//! Points of a patch on a grid of n x n cells.
inline std::vector<Vec3> patch_grid(const SplineSurface& surface, Index patch, Index n)
{
    std::vector<Vec3> out;
    for (Index i = 0; i <= n; ++i)
        for (Index j = 0; j <= n; ++j)
            out.push_back(surface.position({patch, double(i) / n, double(j) / n}));
    return out;
}

//! The largest distance from a grid on a patch to a mesh: at most the true one.
inline double farthest_of_patch(const SplineSurface& surface, Index patch, Index n,
                                const ClosestPoint& mesh)
{
    double most = 0.0;
    for (const Vec3& p : patch_grid(surface, patch, n))
        most = std::max(most, mesh.query(p).distance);
    return most;
}

//! The distance from p to a surface: the nearest points of a grid, then a search that halves its
//! step, from each of them. Knows nothing of derivatives.
inline double distance_to_surface(const SplineSurface& surface, const Vec3& p, Index n = 24)
{
    struct Start {
        double distance;
        DomainPoint at;
    };
    std::vector<Start> starts;
    for (Index q = 0; q < surface.patch_count(); ++q)
        for (Index i = 0; i <= n; ++i)
            for (Index j = 0; j <= n; ++j) {
                const DomainPoint at{q, double(i) / n, double(j) / n};
                starts.push_back({norm(surface.position(at) - p), at});
            }
    const std::size_t kept = std::min<std::size_t>(12, starts.size());
    std::partial_sort(starts.begin(), starts.begin() + static_cast<std::ptrdiff_t>(kept),
                      starts.end(),
                      [](const Start& a, const Start& b) { return a.distance < b.distance; });
    double best = INFINITY;
    for (std::size_t s = 0; s < kept; ++s) {
        Start here = starts[s];
        for (double step = 1.0 / n; step > 1e-9;) {
            bool moved = false;
            for (const auto& [du, dv] :
                 {std::pair{step, 0.0}, {-step, 0.0}, {0.0, step}, {0.0, -step}}) {
                const DomainPoint at{here.at.quad, std::clamp(here.at.u + du, 0.0, 1.0),
                                     std::clamp(here.at.v + dv, 0.0, 1.0)};
                const double d = norm(surface.position(at) - p);
                if (d < here.distance) {
                    here = {d, at};
                    moved = true;
                }
            }
            if (!moved)
                step *= 0.5;
        }
        best = std::min(best, here.distance);
    }
    return best;
}

//! Points of all faces on a grid of n steps along each side.
inline std::vector<Vec3> mesh_grid(const ManifoldMesh& mesh, Index n)
{
    std::vector<Vec3> out;
    for (Index f = 0; f < mesh.face_count(); ++f)
        for (Index i = 0; i <= n; ++i)
            for (Index j = 0; i + j <= n; ++j) {
                const double s = double(i) / n, t = double(j) / n;
                out.push_back(mesh.at({f, {1.0 - s - t, s, t}}));
            }
    return out;
}

} // namespace bot2nurbs::fixtures
