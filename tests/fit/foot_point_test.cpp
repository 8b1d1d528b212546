// SPDX-License-Identifier: MIT
#include "fit/foot_point.h"

#include "analytic_targets.h"
#include "fit/parameter_correction.h"
#include "fit/surface_locator.h"
#include "mesh_fixtures.h"

#include <gtest/gtest.h>
#include <random>

namespace bot2nurbs::test {
namespace {

SplineSurface fitted(const Target& target, const FitOptions& options = {})
{
    const auto network = build_spline_network(target.domain.complex, SplineScheme::peters);
    SurfaceSampleSet samples = sample_target(target);
    Context context;
    auto result = fit_network(*network, samples, options, context);
    if (!result)
        throw std::logic_error(result.error().message);
    return std::move(result->surface);
}

//! A surface over a domain whose unknowns come from the domain's own straight-sided quads pushed
//! about at random: wavy, with every kind of vertex.
SplineSurface wavy(const fixtures::Domain& domain, double amplitude)
{
    Target target{domain,
                  [amplitude](const Vec3& p) {
                      return p + amplitude * Vec3{std::sin(3 * p.y + p.z), std::sin(2 * p.z - p.x),
                                                  std::cos(2 * p.x + p.y)};
                  },
                  {},
                  1.0};
    // With little fairness the fit follows the edges of the domain, and round an edge that is
    // narrower than a search's first steps another local minimum may be nearer.
    FitOptions gentle;
    gentle.fairness = gentle.fairness_floor = 1e-2;
    gentle.rows = DistanceRows::point;
    return fitted(target, gentle);
}

struct NamedSurface {
    std::string name;
    fixtures::Domain domain;
    SplineSurface surface;
};

const std::vector<NamedSurface>& surfaces()
{
    static const std::vector<NamedSurface> all = [] {
        std::vector<NamedSurface> s;
        const auto add = [&](const Target& t) {
            s.push_back({t.domain.name, t.domain, fitted(t)});
        };
        add(sphere_target(1));
        add(torus_target(8, 5));
        for (const Index n : {5u, 6u, 8u})
            add(sphere_target(fixtures::split_bipyramid(n)));
        s.push_back({"genus2", fixtures::genus2(), wavy(fixtures::genus2(), 0.1)});
        return s;
    }();
    return all;
}

//! Distance by a fine grid on every patch: an upper bound, short of the truth by at most the square
//! of the spacing.
double brute_force(const SplineSurface& surface, const Vec3& p, int n)
{
    double best = INFINITY;
    for (Index q = 0; q < surface.patch_count(); ++q)
        for (int i = 0; i <= n; ++i)
            for (int j = 0; j <= n; ++j)
                best =
                    std::min(best, norm(surface.position({q, double(i) / n, double(j) / n}) - p));
    return best;
}

DomainPoint random_place(std::mt19937& generator, Index quads)
{
    std::uniform_real_distribution<double> value(0.0, 1.0);
    return {static_cast<Index>(generator() % quads), value(generator), value(generator)};
}

Vec3 unit_normal(const SurfacePoint& s)
{
    return normalized(cross(s.du, s.dv));
}

TEST(FootPoint, finds_back_the_place_a_point_was_lifted_from)
{
    std::mt19937 generator(1);
    for (const NamedSurface& s : surfaces()) {
        const SurfaceWalk walk(s.domain.complex, s.surface);
        for (int k = 0; k < 400; ++k) {
            const DomainPoint home = random_place(generator, s.surface.patch_count());
            const SurfacePoint there = s.surface.evaluate(home);
            const double lift = 1e-3 * (k % 3 - 1);
            const Vec3 p = there.position + lift * unit_normal(there);
            // From a start a third of a patch away, often in another patch.
            DomainPoint start = home;
            start.u = std::clamp(home.u + 0.3 * (k % 5 - 2) / 2.0, 0.0, 1.0);
            start.v = std::clamp(home.v + 0.3 * (k % 7 - 3) / 3.0, 0.0, 1.0);
            const FootPoint foot = walk.descend(p, start);
            EXPECT_NEAR(foot.distance, std::abs(lift), 1e-9) << s.name << " " << k;
        }
    }
}

TEST(FootPoint, agrees_with_brute_force_from_the_global_search)
{
    std::mt19937 generator(2);
    std::uniform_real_distribution<double> value(-1.0, 1.0);
    for (const NamedSurface& s : surfaces()) {
        const SurfaceLocator locator(s.domain.complex, s.surface, 2);
        for (int k = 0; k < 40; ++k) {
            const SurfacePoint there =
                s.surface.evaluate(random_place(generator, s.surface.patch_count()));
            const Vec3 p =
                there.position + 0.2 * Vec3{value(generator), value(generator), value(generator)};
            const double brute = brute_force(s.surface, p, 40);
            const double found = locator.closest(p).distance;
            EXPECT_LE(found, brute + 1e-12) << s.name << " " << k;
            EXPECT_GE(found, brute - 0.05) << s.name << " " << k;
        }
    }
}

TEST(FootPoint, walks_around_every_vertex_whatever_its_valence)
{
    // Around each vertex points above a small circle, sought from the vertex's every sector.
    for (const NamedSurface& s : surfaces()) {
        const QuadComplex& complex = s.domain.complex;
        const SurfaceWalk walk(complex, s.surface);
        const auto in_sector = [](Index h, double a, double b) -> DomainPoint {
            const Index q = h / 4;
            switch (h % 4) {
            case 0: return {q, a, b};
            case 1: return {q, 1 - b, a};
            case 2: return {q, 1 - a, 1 - b};
            default: return {q, b, 1 - a};
            }
        };
        for (Index v = 0; v < complex.vertex_count(); ++v) {
            std::vector<Index> sectors;
            Index h = complex.halfedge_at(v);
            do {
                sectors.push_back(h);
                h = complex.rotate_ccw(h);
            } while (h != complex.halfedge_at(v));
            for (const Index from : sectors)
                for (const Index to : sectors) {
                    const SurfacePoint goal = s.surface.evaluate(in_sector(to, 0.04, 0.06));
                    const Vec3 p = goal.position + 1e-4 * unit_normal(goal);
                    for (const DomainPoint& start :
                         {in_sector(from, 0.05, 0.05), in_sector(from, 0.0, 0.0),
                          in_sector(from, 0.1, 0.0)}) {
                        const FootPoint foot = walk.descend(p, start);
                        EXPECT_NEAR(foot.distance, 1e-4, 1e-10)
                            << s.name << " vertex " << v << " valence " << sectors.size();
                    }
                }
        }
    }
}

TEST(FootPoint, never_ends_farther_than_it_started)
{
    std::mt19937 generator(4);
    std::uniform_real_distribution<double> value(-4.0, 4.0);
    for (const NamedSurface& s : surfaces()) {
        const SurfaceWalk walk(s.domain.complex, s.surface);
        for (int k = 0; k < 500; ++k) {
            const DomainPoint start = random_place(generator, s.surface.patch_count());
            const Vec3 p{value(generator), value(generator), value(generator)};
            const FootPoint foot = walk.descend(p, start);
            EXPECT_LE(foot.distance, norm(s.surface.position(start) - p));
            EXPECT_NEAR(foot.distance, norm(s.surface.position(foot.where) - p), 1e-12);
        }
    }
}

TEST(FootPoint, ends_where_the_distance_is_stationary)
{
    std::mt19937 generator(5);
    std::uniform_real_distribution<double> value(-0.2, 0.2);
    for (const NamedSurface& s : surfaces()) {
        const SurfaceWalk walk(s.domain.complex, s.surface);
        for (int k = 0; k < 300; ++k) {
            const DomainPoint start = random_place(generator, s.surface.patch_count());
            const Vec3 p = s.surface.position(start) +
                           Vec3{value(generator), value(generator), value(generator)};
            const FootPoint foot = walk.descend(p, start);
            const Vec3 r = normalized(foot.surface.position - p);
            // Exact kinks of the parametrisation are smooth in space, so this holds there too.
            EXPECT_LT(std::abs(dot(r, normalized(foot.surface.du))), 1e-5) << s.name << " " << k;
            EXPECT_LT(std::abs(dot(r, normalized(foot.surface.dv))), 1e-5) << s.name << " " << k;
        }
    }
}

TEST(FootPoint, of_a_point_beyond_a_boundary_is_on_the_boundary)
{
    const fixtures::Domain disk = fixtures::disk_grid(2, 2);
    Target target{disk, [](const Vec3& p) { return p; }, {}, 1.0};
    const SplineSurface surface = fitted(target);
    const SurfaceWalk walk(disk.complex, surface);
    const FootPoint side = walk.descend({0.7, -0.5, 0.1}, {3, 0.9, 0.9});
    EXPECT_LT(norm(side.surface.position - Vec3{0.7, 0.0, 0.0}), 1e-6);
    EXPECT_TRUE(on_sharp_edge(disk.complex, side.where));
    const FootPoint corner = walk.descend({2.5, 2.5, 0.0}, {0, 0.1, 0.1});
    EXPECT_LT(norm(corner.surface.position - Vec3{2.0, 2.0, 0.0}), 1e-6);
    EXPECT_FALSE(on_sharp_edge(disk.complex, walk.descend({1.0, 1.0, 1.0}, {0, 0.1, 0.1}).where));
}

TEST(FootPoint, along_a_curve_stays_on_it_and_passes_smooth_vertices)
{
    // The rim of a 2 x 2 disk: corners at its four ends, smooth vertices in the middle of its
    // sides.
    const fixtures::Domain disk = fixtures::disk_grid(2, 2);
    Target target{disk, [](const Vec3& p) { return p; }, {}, 1.0};
    const SplineSurface surface = fitted(target);
    const SurfaceWalk walk(disk.complex, surface);
    const DomainPoint start = walk.descend({0.4, -1.0, 0.0}, {0, 0.5, 0.5}).where;
    ASSERT_TRUE(on_sharp_edge(disk.complex, start));
    for (const double x : {0.1, 0.4, 0.99, 1.01, 1.7}) {
        const FootPoint foot = walk.descend_along_curve({x, 0.8, 0.3}, start);
        // Above the disk, yet on its rim.
        EXPECT_LT(norm(foot.surface.position - Vec3{x, 0.0, 0.0}), 1e-6) << x;
        EXPECT_TRUE(on_sharp_edge(disk.complex, foot.where));
        EXPECT_NEAR(std::abs(walk.curve_tangent(foot).x), 1.0, 1e-6);
    }
    // The curve ends at the corner, and what starts in a corner stays.
    const FootPoint end = walk.descend_along_curve({3.0, 1.0, 0.0}, start);
    EXPECT_LT(norm(end.surface.position - Vec3{2.0, 0.0, 0.0}), 1e-6);
    EXPECT_EQ(walk.curve_tangent(end), Vec3{});
    EXPECT_EQ(walk.descend_along_curve({0.0, 0.0, 0.0}, end.where).surface.position,
              end.surface.position);
}

TEST(ParameterCorrection, leaves_the_wrong_sheet)
{
    // On a sphere squeezed to a tenth, one point starts on the far sheet, where the distance has a
    // local minimum of its own.
    Target flat{fixtures::refine(fixtures::cube()),
                [](const Vec3& p) {
                    const Vec3 s = normalized(p);
                    return Vec3{s.x, s.y, 0.1 * s.z};
                },
                {},
                1.0};
    const SplineSurface surface = fitted(flat);
    SurfaceSampleSet samples = sample_target(flat);
    std::size_t top = 0;
    for (std::size_t i = 0; i < samples.size(); ++i)
        if (samples.positions[i].z > samples.positions[top].z)
            top = i;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const Vec3 &a = samples.positions[i], &b = samples.positions[top];
        if (std::abs(a.x - b.x) + std::abs(a.y - b.y) < 1e-9 && a.z < 0.0)
            samples.domain[top] = samples.domain[i];
    }
    const SurfaceWalk walk(flat.domain.complex, surface);
    ASSERT_GT(walk.descend(samples.positions[top], samples.domain[top]).distance, 0.1);
    const auto feet = correct_parameters(flat.domain.complex, surface, samples.positions,
                                         samples.domain, {}, Context());
    ASSERT_EQ(feet.size(), samples.size());
    EXPECT_LT(feet[top].distance, 0.01);
}

} // namespace
} // namespace bot2nurbs::test
