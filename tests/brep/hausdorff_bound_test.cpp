// SPDX-License-Identifier: MIT
#include "bot2nurbs/hausdorff_bound.h"

#include "bot2nurbs/deviation.h"
#include "hausdorff_fixtures.h"

#include <atomic>
#include <chrono>
#include <cstring>
#include <ctime>
#include <gtest/gtest.h>
#include <pthread.h>
#include <thread>

namespace bot2nurbs {
namespace {

using fixtures::Domain;

HausdorffBound must_bound(const ManifoldMesh& mesh, const Domain& domain,
                          const SplineSurface& surface, const HausdorffOptions& options = {})
{
    Context context;
    Result<HausdorffBound> bound = bound_hausdorff(mesh, domain.complex, surface, options, context);
    if (!bound)
        throw std::logic_error(bound.error().message);
    return std::move(*bound);
}

void expect_gap(const HausdorffBound& bound, double diagonal)
{
    EXPECT_EQ(bound.termination, HausdorffTermination::gap_reached);
    EXPECT_LE(bound.lower(), bound.upper());
    EXPECT_LE(bound.upper() - bound.lower(),
              std::max(0.02 * bound.upper(), 1e-6 * diagonal) * (1 + 1e-12));
    EXPECT_EQ(bound.lower(),
              std::max(bound.surface_to_source.lower, bound.source_to_surface.lower));
    EXPECT_EQ(bound.upper(),
              std::max(bound.surface_to_source.upper, bound.source_to_surface.upper));
}

bool surface_is_worse(const HausdorffBound& bound)
{
    return &bound.worse_side() == &bound.surface_to_source;
}

SplineSurface lifted(SplineSurface surface, double height)
{
    for (Vec3& c : surface.bezier())
        c.z += height;
    return surface;
}

TEST(HausdorffBound, of_an_offset_plane_is_the_offset)
{
    const Domain disk = fixtures::disk_grid(1, 1);
    const ManifoldMesh square = fixtures::square(6);
    for (const double height : {0.25, 1e-3, 3e-6}) {
        const HausdorffBound bound =
            must_bound(square, disk, lifted(fixtures::flat_patches(disk), height));
        expect_gap(bound, std::sqrt(2.0));
        EXPECT_LE(bound.lower(), height);
        EXPECT_GE(bound.upper(), height);
        // Both sides are flat, so that the first look is exact but for places beyond an edge.
        EXPECT_NEAR(bound.lower(), height, 1e-3 * height + 1e-10);
        EXPECT_NEAR(bound.upper(), height, 1e-3 * height + 1.5e-6);
        EXPECT_EQ(bound.cells, 16u + 72u);
    }
}

TEST(HausdorffBound, of_a_mesh_and_a_surface_that_are_the_same_is_nearly_zero)
{
    const Domain cube = fixtures::cube();
    const HausdorffBound bound = must_bound(fixtures::cube(5), cube, fixtures::flat_patches(cube));
    expect_gap(bound, 2.0 * std::sqrt(3.0));
    EXPECT_EQ(bound.lower(), 0.0);
    EXPECT_GT(bound.upper(), 0.0);
    EXPECT_LT(bound.upper(), 4e-6);
}

TEST(HausdorffBound, of_concentric_spheres_is_the_difference_of_their_radii)
{
    const Domain domain = fixtures::sphere_cube(1);
    const SplineSurface surface = fixtures::network_surface(domain, fixtures::to_unit_sphere);
    double least = INFINITY, most = 0.0;
    for (Index q = 0; q < surface.patch_count(); ++q)
        for (const Vec3& p : fixtures::patch_grid(surface, q, 60)) {
            least = std::min(least, norm(p));
            most = std::max(most, norm(p));
        }
    ASSERT_GT(least, 0.995);
    ASSERT_LT(most, 1.005);
    for (const double radius : {1.1, 0.9, 2.0}) {
        const ManifoldMesh ball = fixtures::moved(
            fixtures::icosphere(4), [&](const Vec3& p) -> Vec3 { return radius * p; });
        double inner = INFINITY; // Radius of the ball that touches the faces from inside.
        for (Index f = 0; f < ball.face_count(); ++f)
            inner = std::min(
                inner, dot(normalized(ball.area_vector(f)), ball.position(ball.triangle(f)[0])));
        // A vertex is at the radius, the middle of a face between, the surface within [least,
        // most].
        const HausdorffBound bound = must_bound(ball, domain, surface);
        expect_gap(bound, ball.box().diagonal());
        const double nearest = radius > 1.0 ? radius - most : least - radius;
        const double farthest = radius > 1.0 ? radius - least : most - inner;
        EXPECT_GE(bound.upper(), nearest);
        EXPECT_LE(bound.lower(), farthest + 1e-3);
        EXPECT_NEAR(bound.lower(), std::abs(radius - 1.0), 0.01);
    }
}

TEST(HausdorffBound,
     is_never_below_what_brute_force_finds_and_its_worst_places_are_as_far_as_it_says)
{
    struct Case {
        Domain domain;
        ManifoldMesh mesh;
        double amplitude;
    };
    const std::vector<Case> cases{
        {fixtures::sphere_cube(0), fixtures::icosphere(1), 0.05},
        {fixtures::sphere_cube(0), fixtures::octahedron(), 0.1},
        {fixtures::sphere_cube(1), fixtures::icosphere(2), 0.02},
        {fixtures::split_bipyramid(5), fixtures::icosphere(2), 0.05},
        {fixtures::sphere_cube(0), fixtures::cube(2), 0.2},
        {fixtures::disk_grid(2, 1), fixtures::icosphere(0), 0.2},
    };
    unsigned seed = 0;
    for (const Case& c : cases) {
        const SplineSurface surface = fixtures::wavy_sphere(c.domain, ++seed, c.amplitude);
        const HausdorffBound bound = must_bound(c.mesh, c.domain, surface);
        expect_gap(bound, c.mesh.box().diagonal());
        const ClosestPoint mesh(c.mesh);
        double from_surface = 0.0, from_source = 0.0;
        for (Index q = 0; q < surface.patch_count(); ++q) {
            const double farthest = fixtures::farthest_of_patch(surface, q, 60, mesh);
            EXPECT_GE(bound.patches[q].surface_to_source.upper, farthest) << seed << ' ' << q;
            from_surface = std::max(from_surface, farthest);
        }
        for (const Vec3& p : fixtures::mesh_grid(c.mesh, c.mesh.face_count() > 100 ? 1 : 4))
            from_source = std::max(from_source, fixtures::distance_to_surface(surface, p, 16));
        EXPECT_GE(bound.surface_to_source.upper, from_surface) << seed;
        EXPECT_GE(bound.source_to_surface.upper, from_source * (1 - 1e-9)) << seed;
        // The places themselves show that the lower bounds are none too high.
        const FarPlace &here = bound.surface_to_source.worst,
                       &there = bound.source_to_surface.worst;
        EXPECT_EQ(here.distance, bound.surface_to_source.lower);
        EXPECT_NEAR(mesh.query(here.point).distance, here.distance, 1e-9);
        EXPECT_LT(norm(surface.position(here.surface) - here.point), 1e-12);
        EXPECT_NEAR(norm(c.mesh.at(here.source) - here.point), here.distance, 1e-9);
        EXPECT_EQ(there.distance, bound.source_to_surface.lower);
        EXPECT_NEAR(fixtures::distance_to_surface(surface, there.point), there.distance, 1e-8);
        EXPECT_LT(norm(c.mesh.at(there.source) - there.point), 1e-12);
        EXPECT_GE(norm(surface.position(there.surface) - there.point), there.distance);
    }
}

TEST(HausdorffBound, of_a_vault_over_a_square_is_its_height_however_the_square_is_cut)
{
    // z = 0.1 - (x - 3 / 8)^2 / 20: the ridge runs through the middles of pieces, and where the
    // source is coarse nothing but the bend of the pieces shows it.
    const Domain disk = fixtures::disk_grid(1, 1);
    const SplineSurface vault = fixtures::surface_of_points(1, [](Index, Index i, Index j) {
        // The coefficients of a square in cubic pieces of length 1 / 4: those of its blossom.
        const double a = i / 3 * 0.25, k = i % 3; // NOLINT(bugprone-integer-division)
        const double m = a - 0.375, square = m * m + 2.0 * m * 0.25 * k / 3.0 +
                                             (k > 1.0 ? 0.0625 * k * (k - 1.0) / 6.0 : 0.0);
        return Vec3{i / 12.0, j / 12.0, 0.1 - square / 20.0};
    });
    ASSERT_NEAR(vault.position({0, 0.375, 0.3}).z, 0.1, 1e-15);
    ASSERT_NEAR(vault.position({0, 1.0, 0.3}).z, 0.1 - 0.390625 / 20.0, 1e-15);
    for (const int cells : {1, 3, 40}) {
        const HausdorffBound bound = must_bound(fixtures::square(cells), disk, vault);
        expect_gap(bound, std::sqrt(2.0));
        EXPECT_LE(bound.lower(), 0.1 * (1 + 1e-12));
        EXPECT_GE(bound.upper(), 0.1);
        EXPECT_NEAR(bound.worse_side().worst.surface.u, 0.375, 0.2);
        if (cells < 40) { // Exact at the first look.
            EXPECT_EQ(bound.cells, 16u + 2u * cells * cells);
        }
    }
}

//! A square whose cells crowd around its middle, where one vertex is pulled up to a needle.
ManifoldMesh needle(double height)
{
    constexpr int n = 40;
    const ManifoldMesh square = fixtures::square(n);
    const auto crowd = [](double x) { return 0.5 + 4.0 * std::pow(x - 0.5, 3); };
    return fixtures::moved(square, [&](const Vec3& p) -> Vec3 {
        const bool tip = std::abs(p.x - 0.5) < 1e-9 && std::abs(p.y - 0.5) < 1e-9;
        return {crowd(p.x), crowd(p.y), tip ? height : 0.0};
    });
}

TEST(HausdorffBound, sees_a_needle_of_the_source_that_samples_miss)
{
    const Domain disk = fixtures::disk_grid(3, 3);
    SplineSurface surface = fixtures::flat_patches(disk);
    surface.transform(1.0 / 3.0, {});
    const ManifoldMesh mesh = needle(0.1);
    const HausdorffBound bound = must_bound(mesh, disk, surface);
    expect_gap(bound, std::sqrt(2.0));
    EXPECT_NEAR(bound.lower(), 0.1, 1e-8);
    EXPECT_FALSE(surface_is_worse(bound));
    EXPECT_EQ(bound.worse_side().worst.surface.quad, 4u);
    EXPECT_LT(norm(bound.worse_side().worst.point - Vec3{0.5, 0.5, 0.1}), 1e-12);
    EXPECT_NEAR(bound.patches[4].source_to_surface.lower, 0.1, 1e-8);
    EXPECT_LT(bound.patches[0].source_to_surface.lower, 1e-10);
    Context context;
    const auto sampled = measure_deviation(mesh, disk.complex, surface, context);
    ASSERT_TRUE(sampled.ok());
    EXPECT_LT(sampled->max(), 0.9 * bound.lower());
}

TEST(HausdorffBound, sees_a_bump_of_the_surface_that_samples_miss)
{
    // One coefficient of a small piece raises the surface by 3 t (1 - t)^2 there, squared: by 4 /
    // 9, squared, at t = 1 / 3, where no sample is.
    Domain disk = fixtures::disk_grid(8, 8);
    for (Vec3& p : disk.positions)
        p = {std::pow(p.x / 4.0 - 1.0, 3), std::pow(p.y / 4.0 - 1.0, 3), 0.0};
    SplineSurface surface = fixtures::flat_patches(disk);
    surface.bezier()[SplineNetwork::row(27, 4, 7)].z += 0.1;
    const ManifoldMesh square = fixtures::moved(fixtures::square(4), [](const Vec3& p) -> Vec3 {
        return {2 * p.x - 1, 2 * p.y - 1, 0.0};
    });
    const double height = 0.1 * 16.0 / 81.0;
    const HausdorffBound bound = must_bound(square, disk, surface);
    expect_gap(bound, 2 * std::sqrt(2.0));
    EXPECT_LE(bound.lower(), height);
    EXPECT_GE(bound.upper(), height);
    EXPECT_TRUE(surface_is_worse(bound));
    EXPECT_EQ(bound.worse_side().worst.surface.quad, 27u);
    Context context;
    const auto sampled = measure_deviation(square, disk.complex, surface, context);
    ASSERT_TRUE(sampled.ok());
    EXPECT_LT(sampled->max(), 0.8 * bound.lower());
}

TEST(HausdorffBound, finds_the_nearest_sheet_where_a_local_search_would_not)
{
    // The surface winds up and down five times on its way; the mesh lies along one of the sheets.
    const Domain disk = fixtures::disk_grid(1, 1);
    const SplineSurface folds = fixtures::surface_of_points(1, [](Index, Index i, Index j) {
        return Vec3{std::cos(i * M_PI / 2.4), j / 12.0, i / 48.0};
    });
    const ManifoldMesh strip = fixtures::moved(fixtures::square(5), [](const Vec3& p) -> Vec3 {
        return {1.6 * p.x - 0.8, p.y, 0.11 + 0.02 * p.x};
    });
    const HausdorffBound bound = must_bound(strip, disk, folds);
    expect_gap(bound, strip.box().diagonal());
    double farthest = 0.0;
    for (const Vec3& p : fixtures::mesh_grid(strip, 4))
        farthest = std::max(farthest, fixtures::distance_to_surface(folds, p, 200));
    EXPECT_GE(bound.source_to_surface.upper, farthest * (1 - 1e-9));
    EXPECT_LE(bound.source_to_surface.lower, 1.05 * farthest);
}

TEST(HausdorffBound, of_a_surface_that_goes_on_where_the_mesh_ends_is_how_far_it_goes)
{
    // The mesh covers one of three unit squares.
    const Domain strip = fixtures::disk_grid(3, 1);
    const HausdorffBound bound =
        must_bound(fixtures::square(4), strip, fixtures::flat_patches(strip));
    expect_gap(bound, std::sqrt(2.0));
    EXPECT_NEAR(bound.lower(), 2.0, 1e-9);
    EXPECT_TRUE(surface_is_worse(bound));
    EXPECT_EQ(bound.worse_side().worst.surface.quad, 2u);
    const double last[3] = {0.0, 1.0, 2.0};
    for (Index q = 0; q < 3; ++q) {
        EXPECT_NEAR(bound.patches[q].surface_to_source.lower, last[q], q == 2 ? 1e-9 : 0.2);
        EXPECT_GE(bound.patches[q].surface_to_source.upper, last[q]);
    }
    EXPECT_LT(bound.source_to_surface.lower, 1e-9);
}

TEST(HausdorffBound, of_an_open_tube_around_a_longer_one_is_known)
{
    // Radius 1 and length 2 against a mesh of radius 0.9 and length 2.5.
    const Domain tube = fixtures::open_cylinder(Index{6}, Index{2});
    const SplineSurface surface = fixtures::network_surface(tube, [](const Vec3& p) -> Vec3 {
        const double r = std::hypot(p.x, p.y);
        return {p.x / r, p.y / r, p.z};
    });
    const ManifoldMesh mesh =
        fixtures::moved(fixtures::open_cylinder(90, 9, 0.9, 2.5), [](const Vec3& p) { return p; });
    const double low = mesh.box().min.z;
    const ManifoldMesh placed = fixtures::moved(mesh, [&](const Vec3& p) -> Vec3 {
        return {p.x, p.y, p.z - low};
    });
    const HausdorffBound bound = must_bound(placed, tube, surface);
    expect_gap(bound, placed.box().diagonal());
    // From the far rim to the other rim; the surface is round to a hundredth.
    EXPECT_NEAR(bound.lower(), std::hypot(0.5, 0.1), 0.02);
    EXPECT_FALSE(surface_is_worse(bound));
}

TEST(HausdorffBound, needs_no_proper_triangles)
{
    // Two columns of vertices on one line: faces without area, and some that are points.
    const ManifoldMesh folded = fixtures::moved(fixtures::square(8), [](const Vec3& p) -> Vec3 {
        const double x = p.x > 0.3 && p.x < 0.7 ? 0.5 : p.x;
        return {x, p.y > 0.8 ? 0.875 : p.y, 0.0};
    });
    const Domain disk = fixtures::disk_grid(1, 1);
    SplineSurface surface = lifted(fixtures::flat_patches(disk), 0.05);
    for (Vec3& c : surface.bezier())
        c.y *= 0.875;
    const HausdorffBound bound = must_bound(folded, disk, surface);
    expect_gap(bound, folded.box().diagonal());
    EXPECT_LE(bound.lower(), 0.05 * (1 + 1e-12));
    EXPECT_GE(bound.upper(), 0.05);
    EXPECT_NEAR(bound.lower(), 0.05, 1e-4);
}

TEST(HausdorffBound, takes_degenerate_patches)
{
    // A patch with one side shrunk to a point, where it has no tangents.
    const Domain disk = fixtures::disk_grid(1, 1);
    const SplineSurface cone = fixtures::surface_of_points(1, [](Index, Index i, Index j) {
        return Vec3{i / 12.0, i / 12.0 * (j / 12.0 - 0.5), 0.1};
    });
    const ManifoldMesh triangle =
        fixtures::must_build({{0, 0, 0}, {1, -0.5, 0}, {1, 0.5, 0}}, {{0, 1, 2}});
    const HausdorffBound bound = must_bound(triangle, disk, cone);
    expect_gap(bound, triangle.box().diagonal());
    EXPECT_LE(bound.lower(), 0.1 * (1 + 1e-12));
    EXPECT_GE(bound.upper(), 0.1);
}

TEST(HausdorffBound, decides_without_finding_the_value)
{
    const Domain domain = fixtures::sphere_cube(1);
    const SplineSurface surface = fixtures::wavy_sphere(domain, 11, 0.02);
    const ManifoldMesh mesh = fixtures::icosphere(3);
    const HausdorffBound value = must_bound(mesh, domain, surface);
    for (const double share : {0.5, 0.9, 0.99, 0.9999, 1.03, 2.0, 10.0}) {
        HausdorffOptions options;
        options.decide = share * value.lower();
        const HausdorffBound bound = must_bound(mesh, domain, surface, options);
        ASSERT_EQ(bound.termination, HausdorffTermination::decided);
        EXPECT_EQ(bound.upper() <= *options.decide, share > 1.0) << share;
        EXPECT_EQ(bound.lower() > *options.decide, share < 1.0) << share;
        EXPECT_LE(bound.lower(), value.upper());
        EXPECT_GE(bound.upper(), value.lower());
        EXPECT_LE(share >= 2.0 ? bound.cells : 0, value.cells);
        // Each patch is within it or has a place beyond; where both values are known they agree.
        for (Index q = 0; q < bound.patches.size(); ++q) {
            const DistanceBounds& a = bound.patches[q].surface_to_source;
            const DistanceBounds& b = value.patches[q].surface_to_source;
            EXPECT_TRUE(a.upper <= *options.decide || a.lower > *options.decide) << q;
            EXPECT_LE(a.lower, b.upper);
            EXPECT_LE(b.lower, a.upper);
            const DistanceBounds& c = bound.patches[q].source_to_surface;
            EXPECT_TRUE(c.upper <= *options.decide || c.lower > *options.decide) << q;
        }
    }
}

TEST(HausdorffBound, leaves_a_tie_undecided_instead_of_refining_for_ever)
{
    const Domain disk = fixtures::disk_grid(1, 1);
    HausdorffOptions options;
    options.decide = 0.25;
    const HausdorffBound bound =
        must_bound(fixtures::square(6), disk, lifted(fixtures::flat_patches(disk), 0.25), options);
    EXPECT_EQ(bound.termination, HausdorffTermination::decided);
    EXPECT_GT(bound.upper(), 0.25);
    EXPECT_LT(bound.upper(), 0.25 + 1e-8);
    EXPECT_LE(bound.lower(), 0.25);
}

TEST(HausdorffBound, stays_proven_when_it_may_not_refine)
{
    const Domain domain = fixtures::sphere_cube(1);
    const SplineSurface surface = fixtures::wavy_sphere(domain, 5, 0.02);
    const ManifoldMesh mesh = fixtures::icosphere(2);
    const HausdorffBound value = must_bound(mesh, domain, surface);
    HausdorffOptions options;
    options.max_cells = 1;
    const HausdorffBound bound = must_bound(mesh, domain, surface, options);
    EXPECT_EQ(bound.termination, HausdorffTermination::cell_limit);
    EXPECT_EQ(bound.cells, 24u * 16 + 320);
    EXPECT_LE(bound.lower(), value.upper());
    EXPECT_GT(bound.upper(), value.upper());
}

TEST(HausdorffBound, gets_as_close_as_is_asked_for)
{
    const Domain domain = fixtures::sphere_cube(0);
    const SplineSurface surface = fixtures::wavy_sphere(domain, 6, 0.03);
    const ManifoldMesh mesh = fixtures::icosphere(1);
    std::uint64_t before = 0;
    for (const double gap : {0.2, 0.02, 0.002}) {
        HausdorffOptions options;
        options.relative_gap = gap;
        options.absolute_gap = 0.0;
        const HausdorffBound bound = must_bound(mesh, domain, surface, options);
        EXPECT_EQ(bound.termination, HausdorffTermination::gap_reached);
        EXPECT_LE(bound.upper() - bound.lower(), gap * bound.upper() * (1 + 1e-12));
        EXPECT_GT(bound.cells, before);
        before = bound.cells;
    }
    HausdorffOptions absolute;
    absolute.relative_gap = 0.0;
    absolute.absolute_gap = 1e-4;
    const HausdorffBound bound = must_bound(mesh, domain, surface, absolute);
    EXPECT_LE(bound.upper() - bound.lower(), 1e-4 * mesh.box().diagonal() * (1 + 1e-9));
}

TEST(HausdorffBound, does_not_depend_on_scale_or_place)
{
    const Domain domain = fixtures::sphere_cube(0);
    const SplineSurface surface = fixtures::wavy_sphere(domain, 7, 0.03);
    const ManifoldMesh mesh = fixtures::icosphere(1);
    const HausdorffBound here = must_bound(mesh, domain, surface);
    for (const double scale : {1e-6, 1.0, 1e6})
        for (const double away : {0.0, 1000.0}) {
            const Vec3 offset = scale * away * Vec3{1, -2, 3};
            SplineSurface moved = surface;
            moved.transform(scale, offset);
            const ManifoldMesh there =
                fixtures::moved(mesh, [&](const Vec3& p) -> Vec3 { return scale * p + offset; });
            const HausdorffBound bound = must_bound(there, domain, moved);
            expect_gap(bound, there.box().diagonal());
            // Scaling rounds, and coordinates far away have lost digits before they came here.
            const double lost = 1e-10;
            EXPECT_NEAR(bound.lower() / scale, here.lower(), lost) << scale << ' ' << away;
            EXPECT_NEAR(bound.upper() / scale, here.upper(), 0.02 * here.upper());
        }
}

TEST(HausdorffBound, is_the_same_for_any_number_of_threads)
{
    const Domain domain = fixtures::sphere_cube(1);
    const SplineSurface surface = fixtures::wavy_sphere(domain, 8, 0.01);
    const ManifoldMesh mesh = fixtures::icosphere(3);
    for (const bool decide : {false, true}) {
        std::vector<HausdorffBound> bounds;
        for (const unsigned threads : {1u, 2u, 8u}) {
            Context context;
            context.threads = threads;
            HausdorffOptions options;
            if (decide)
                options.decide = 0.01;
            auto bound = bound_hausdorff(mesh, domain.complex, surface, options, context);
            ASSERT_TRUE(bound.ok());
            bounds.push_back(std::move(*bound));
        }
        const HausdorffBound& one = bounds[0];
        for (const HausdorffBound& many : bounds) {
            EXPECT_EQ(one.lower(), many.lower());
            EXPECT_EQ(one.upper(), many.upper());
            EXPECT_EQ(one.cells, many.cells);
            EXPECT_EQ(one.queries, many.queries);
            EXPECT_EQ(one.worse_side().worst.point, many.worse_side().worst.point);
            ASSERT_EQ(one.patches.size(), many.patches.size());
            EXPECT_EQ(std::memcmp(one.patches.data(), many.patches.data(),
                                  one.patches.size() * sizeof(PatchDistance)),
                      0);
        }
    }
}

double thread_seconds(clockid_t clock)
{
    timespec t{};
    clock_gettime(clock, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

TEST(HausdorffBound, is_cancelled_within_50_ms)
{
    const Domain domain = fixtures::refine(fixtures::sphere_cube(2));
    const SplineSurface surface = fixtures::wavy_sphere(domain, 9, 0.002);
    const ManifoldMesh mesh = fixtures::icosphere(5);
    // A gap that takes for ever.
    HausdorffOptions options;
    options.relative_gap = 1e-12;
    options.absolute_gap = 0.0;
    clockid_t clock;
    ASSERT_EQ(pthread_getcpuclockid(pthread_self(), &clock), 0);
    for (const double after : {0.0, 0.01, 0.05, 0.2, 0.5}) {
        Context context;
        context.threads = 1;
        const double start = thread_seconds(clock);
        double asked = 0.0;
        std::atomic<bool> ended_early{false};
        std::thread canceller([&] {
            while (thread_seconds(clock) < start + after && !ended_early)
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
            asked = thread_seconds(clock);
            context.cancel();
        });
        const auto bound = bound_hausdorff(mesh, domain.complex, surface, options, context);
        const double ended = thread_seconds(clock);
        ended_early = true;
        canceller.join();
        ASSERT_FALSE(bound.ok());
        EXPECT_EQ(bound.error().code, ErrorCode::cancelled);
        EXPECT_LT(ended - asked, 0.05) << after;
    }
}

TEST(HausdorffBound, names_what_is_wrong)
{
    const Domain cube = fixtures::cube();
    const SplineSurface surface = fixtures::flat_patches(cube);
    const ManifoldMesh mesh = fixtures::cube(1);
    Context context;
    const auto code = [&](const HausdorffOptions& options) {
        const auto bound = bound_hausdorff(mesh, cube.complex, surface, options, context);
        return bound ? ErrorCode::internal : bound.error().code;
    };
    HausdorffOptions options;
    options.relative_gap = 1.0;
    EXPECT_EQ(code(options), ErrorCode::bad_option);
    options.relative_gap = std::nan("");
    EXPECT_EQ(code(options), ErrorCode::bad_option);
    options = {};
    options.absolute_gap = -1e-9;
    EXPECT_EQ(code(options), ErrorCode::bad_option);
    options.relative_gap = options.absolute_gap = 0.0;
    EXPECT_EQ(code(options), ErrorCode::bad_option);
    options = {};
    options.decide = -1.0;
    EXPECT_EQ(code(options), ErrorCode::bad_option);
    const auto empty = bound_hausdorff(mesh, cube.complex, {}, {}, context);
    ASSERT_FALSE(empty.ok());
    EXPECT_EQ(empty.error().code, ErrorCode::empty_input);
    SplineSurface broken = surface;
    broken.bezier()[169 * 4 + 7].y = std::nan("");
    const auto bad = bound_hausdorff(mesh, cube.complex, broken, {}, context);
    ASSERT_FALSE(bad.ok());
    EXPECT_EQ(bad.error().code, ErrorCode::bad_geometry);
    EXPECT_EQ(bad.error().element, 4u);
}

} // namespace
} // namespace bot2nurbs
