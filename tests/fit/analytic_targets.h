// SPDX-License-Identifier: MIT
#pragma once

//! Smooth surfaces with known closest points, samples of them through hand-made domains, and exact
//! errors of a fitted surface.

#include "domain_fixtures.h"

#include "bot2nurbs/fit_network.h"

#include <cmath>
#include <functional>

namespace bot2nurbs::test {

//! A surface with its domain: `map` takes a place of the straight-sided domain to the surface,
//! `distance` is the signed distance, `diagonal` that of the bounding box.
struct Target {
    fixtures::Domain domain;
    std::function<Vec3(const Vec3&)> map;
    std::function<double(const Vec3&)> distance;
    double diagonal = 0.0;
};

//! The unit sphere from a domain around the origin.
inline Target sphere_target(fixtures::Domain domain)
{
    return {std::move(domain), [](const Vec3& p) { return normalized(p); },
            [](const Vec3& p) { return norm(p) - 1.0; }, 2.0 * std::sqrt(3.0)};
}

inline Target sphere_target(int level)
{
    fixtures::Domain domain = fixtures::cube();
    for (int i = 0; i < level; ++i)
        domain = fixtures::refine(domain);
    return sphere_target(std::move(domain));
}

inline double ring_distance(const Vec3& p, double major, double minor)
{
    return std::hypot(std::hypot(p.x, p.y) - major, p.z) - minor;
}

//! A ring torus of radii 3 and 1 from a regular grid; places are mapped by their two angles, which
//! a quad interpolates linearly.
inline Target torus_target(Index around, Index across)
{
    Target t;
    t.domain = fixtures::torus_grid(around, across);
    t.distance = [](const Vec3& p) { return ring_distance(p, 3.0, 1.0); };
    t.map = [](const Vec3& p) {
        const double a = std::atan2(p.y, p.x);
        const double b = std::atan2(p.z, std::hypot(p.x, p.y) - 3.0);
        return Vec3{(3 + std::cos(b)) * std::cos(a), (3 + std::cos(b)) * std::sin(a), std::sin(b)};
    };
    t.diagonal = std::sqrt(64.0 + 64.0 + 4.0);
    return t;
}

//! A ring torus of radii 1 and 0.4 from a ring of eight voxels: valences 3 and 5, kinks in the
//! start map.
inline Target voxel_ring_target()
{
    Target t;
    std::vector<std::array<int, 3>> cells;
    for (int x = 0; x < 3; ++x)
        for (int y = 0; y < 3; ++y)
            if (x != 1 || y != 1)
                cells.push_back({x, y, 0});
    t.domain = fixtures::voxel_surface("ring", std::move(cells));
    for (Vec3& p : t.domain.positions)
        p -= Vec3{1.5, 1.5, 0.5};
    t.distance = [](const Vec3& p) { return ring_distance(p, 1.0, 0.4); };
    t.map = [](const Vec3& p) {
        const double a = std::atan2(p.y, p.x);
        const double b = std::atan2(p.z, std::max(std::abs(p.x), std::abs(p.y)) - 1.0);
        const double r = 1.0 + 0.4 * std::cos(b);
        return Vec3{r * std::cos(a), r * std::sin(a), 0.4 * std::sin(b)};
    };
    t.diagonal = std::sqrt(2 * 2.8 * 2.8 + 0.8 * 0.8);
    return t;
}

//! Place of the straight-sided domain.
inline Vec3 bilinear(const fixtures::Domain& domain, const DomainPoint& d)
{
    const auto& q = domain.complex.quad(d.quad);
    const auto& p = domain.positions;
    return (1 - d.u) * ((1 - d.v) * p[q[0]] + d.v * p[q[3]]) +
           d.u * ((1 - d.v) * p[q[1]] + d.v * p[q[2]]);
}

//! `per_piece`^2 samples on every 4 x 4th of a quad, weighted by the area they stand for: Gauss
//! points where per_piece is 3, as the fit study used, otherwise cell midpoints.
inline SurfaceSampleSet sample_target(const Target& target, int per_piece = 3)
{
    std::vector<double> place, share;
    for (int piece = 0; piece < 4; ++piece)
        for (int k = 0; k < per_piece; ++k) {
            const bool gauss = per_piece == 3;
            const double t = gauss ? 0.5 + (k - 1) * std::sqrt(0.15) : (k + 0.5) / per_piece;
            place.push_back((piece + t) / 4.0);
            share.push_back((gauss ? (k == 1 ? 8.0 : 5.0) / 18.0 : 1.0 / per_piece) / 4.0);
        }
    SurfaceSampleSet samples;
    const double step = 1e-5;
    for (Index q = 0; q < target.domain.complex.quad_count(); ++q)
        for (std::size_t i = 0; i < place.size(); ++i)
            for (std::size_t j = 0; j < place.size(); ++j) {
                const DomainPoint d{q, place[i], place[j]};
                const auto at = [&](double du, double dv) {
                    return target.map(bilinear(target.domain, {q, d.u + du, d.v + dv}));
                };
                const Vec3 area = cross(at(step, 0) - at(-step, 0), at(0, step) - at(0, -step));
                samples.positions.push_back(at(0, 0));
                samples.normals.push_back(normalized(area));
                samples.weights.push_back(norm(area) / (4 * step * step) * share[i] * share[j]);
                samples.domain.push_back(d);
            }
    return samples;
}

//! Errors of a surface against its target, in percent of the diagonal; area-weighted rms.
struct TargetError {
    double max = 0.0, rms = 0.0;
    int folds = 0; //!< Places where the normal turns against the majority.
};

inline TargetError target_error(const Target& target, const SplineSurface& surface)
{
    constexpr int n = 28;
    TargetError error;
    double sum = 0.0, area = 0.0;
    int inside = 0, count = 0;
    for (Index q = 0; q < surface.patch_count(); ++q)
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) {
                const SurfacePoint s = surface.evaluate({q, i / (n - 1.0), j / (n - 1.0)});
                const double d = target.distance(s.position);
                const Vec3 normal = cross(s.du, s.dv);
                const double h = 1e-6;
                const Vec3 p = s.position;
                const Vec3 gradient{
                    target.distance({p.x + h, p.y, p.z}) - target.distance({p.x - h, p.y, p.z}),
                    target.distance({p.x, p.y + h, p.z}) - target.distance({p.x, p.y - h, p.z}),
                    target.distance({p.x, p.y, p.z + h}) - target.distance({p.x, p.y, p.z - h})};
                inside += dot(normal, gradient) < 0.0;
                ++count;
                error.max = std::max(error.max, std::abs(d));
                sum += d * d * norm(normal);
                area += norm(normal);
            }
    error.folds = std::min(inside, count - inside);
    error.max *= 100.0 / target.diagonal;
    error.rms = 100.0 * std::sqrt(sum / area) / target.diagonal;
    return error;
}

} // namespace bot2nurbs::test
