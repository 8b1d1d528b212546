// SPDX-License-Identifier: MIT
#include "bot2nurbs/refine_to_tolerance.h"

#include "bot2nurbs/point_deviation.h"
#include "bot2nurbs/validate_domain.h"
#include "domain/domain_paths.h"
#include "hand_domains.h"
#include "refine/point_trial.h"
#include "refine/trial.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>

namespace bot2nurbs {
namespace {

using test::HandDomain;

//! A torus of radii 1 and 0.4 in twelve patches; its triangles are within 8e-4 of it.
HandDomain torus()
{
    return test::torus_grid(4, 3, 24);
}

//! Too little for twelve patches, enough for the triangles.
constexpr double fine = 1.1e-3;

ToleranceOptions options_for(double tolerance)
{
    ToleranceOptions options;
    options.tolerance = tolerance;
    return options;
}

Result<ToleranceFit> refined(const HandDomain& hand, const ToleranceOptions& options,
                             unsigned threads = 0)
{
    Context context;
    context.threads = threads;
    return refine_to_tolerance(hand.mesh, hand.domain, options, nullptr, context);
}

TEST(RefineToTolerance, a_torus_of_twelve_patches_is_refined_until_the_bound_proves_the_tolerance)
{
    const HandDomain hand = torus();
    const double tolerance = fine;
    const Result<ToleranceFit> fit = refined(hand, options_for(tolerance));
    ASSERT_TRUE(fit) << fit.error().message;
    EXPECT_EQ(fit->termination, RefinementEnd::tolerance_met);
    ASSERT_GE(fit->rounds.size(), 2u);
    EXPECT_GT(fit->rounds[0].distance.lower, tolerance);
    EXPECT_GT(fit->rounds[0].beyond, 0u);
    EXPECT_EQ(fit->best, fit->rounds.size() - 1);
    EXPECT_EQ(fit->rounds.back().beyond, 0u);
    EXPECT_EQ(fit->rounds.back().patches, fit->domain.complex.quad_count());
    EXPECT_LE(fit->bound.upper(), tolerance);

    Context context;
    const Result<HausdorffBound> bound =
        bound_hausdorff(hand.mesh, fit->domain.complex, fit->fit.surface, {}, context);
    ASSERT_TRUE(bound);
    EXPECT_LE(bound->lower(), tolerance);
    const Result<DomainValidation> validation = validate_domain(hand.mesh, fit->domain, context);
    ASSERT_TRUE(validation);
    EXPECT_TRUE(validation->valid());
}

//! Length of a path over the carrier.
double length(const QuadDomain& domain, Index edge)
{
    const ManifoldMesh& mesh = domain.carrier.mesh;
    return length(mesh, *domain_path(domain, edge));
}

//! The mesh with waves, and its domain with it.
void make_wavy(HandDomain& hand, double height, double frequency)
{
    std::vector<Vec3> positions = hand.mesh.positions();
    for (Vec3& p : positions)
        p.z += height * std::sin(frequency * p.x) * std::sin(frequency * p.y);
    hand.mesh = *ManifoldMesh::build(std::move(positions), hand.mesh.triangles());
    hand.domain.carrier = CarrierMesh::from_source(hand.mesh);
}

TEST(RefineToTolerance, edges_are_straightened_after_a_cut_unless_they_are_to_stay)
{
    HandDomain hand = test::torus_askew(2, 8);
    make_wavy(hand, 0.2, 5.0);
    ToleranceOptions options = options_for(0.025);
    const Index vertices = hand.domain.complex.vertex_count();
    const auto edges_that_moved = [&](bool keep) {
        options.keep_edges = keep;
        const Result<ToleranceFit> fit = refined(hand, options);
        EXPECT_TRUE(fit);
        EXPECT_GE(fit->rounds.size(), 2u);
        std::map<std::pair<Index, Index>, double> before;
        for (Index e = 0; e < hand.domain.edges.size(); ++e)
            before[std::minmax(hand.domain.edges[e].a, hand.domain.edges[e].b)] =
                length(hand.domain, e);
        int kept = 0, moved = 0;
        for (Index e = 0; e < fit->domain.edges.size(); ++e) {
            const DomainEdge& edge = fit->domain.edges[e];
            if (edge.a >= vertices || edge.b >= vertices)
                continue; // Made by a cut.
            const double was = before.at(std::minmax(edge.a, edge.b));
            const bool same = std::fabs(length(fit->domain, e) - was) < 1e-9;
            ++(same ? kept : moved);
        }
        EXPECT_GT(kept + moved, 0);
        return moved;
    };
    EXPECT_EQ(edges_that_moved(true), 0);
    EXPECT_GT(edges_that_moved(false), 0);
}

TEST(RefineToTolerance, a_tolerance_that_is_met_at_once_cuts_nothing)
{
    const HandDomain hand = torus();
    const Result<ToleranceFit> fit = refined(hand, options_for(0.5));
    ASSERT_TRUE(fit);
    EXPECT_EQ(fit->termination, RefinementEnd::tolerance_met);
    EXPECT_EQ(fit->rounds.size(), 1u);
    EXPECT_EQ(fit->domain.complex.quad_count(), 12u);
}

TEST(RefineToTolerance, a_limit_of_patches_ends_it_with_the_best_round)
{
    const HandDomain hand = torus();
    ToleranceOptions options = options_for(1e-5);
    options.max_patches = 40;
    const Result<ToleranceFit> fit = refined(hand, options);
    ASSERT_TRUE(fit);
    EXPECT_EQ(fit->termination, RefinementEnd::patch_limit);
    EXPECT_GT(fit->bound.upper(), options.tolerance);
    double least = std::numeric_limits<double>::infinity();
    for (const RefinementRound& round : fit->rounds) {
        EXPECT_LE(round.patches, options.max_patches);
        least = std::min(least, round.distance.lower);
    }
    EXPECT_EQ(fit->rounds[fit->best].distance.lower, least);
    EXPECT_EQ(fit->rounds[fit->best].patches, fit->domain.complex.quad_count());
}

TEST(RefineToTolerance, the_surface_does_not_depend_on_the_number_of_threads)
{
    const HandDomain hand = torus();
    const Result<ToleranceFit> one = refined(hand, options_for(fine), 1);
    const Result<ToleranceFit> many = refined(hand, options_for(fine), 8);
    ASSERT_TRUE(one && many);
    EXPECT_EQ(one->rounds.size(), many->rounds.size());
    const auto &a = one->fit.surface.bezier(), &b = many->fit.surface.bezier();
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i)
        ASSERT_TRUE(a[i].x == b[i].x && a[i].y == b[i].y && a[i].z == b[i].z) << i;
}

TEST(RefineToTolerance, tolerances_that_are_no_positive_numbers_are_refused)
{
    const HandDomain hand = torus();
    for (const double tolerance : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(),
                                   std::numeric_limits<double>::infinity()}) {
        const Result<ToleranceFit> fit = refined(hand, options_for(tolerance));
        ASSERT_FALSE(fit);
        EXPECT_EQ(fit.error().code, ErrorCode::bad_option);
    }
}

TEST(NoiseReach, is_farther_than_the_largest_of_so_many_normal_errors_but_not_by_much)
{
    EXPECT_EQ(noise_reach(1.0, 0), 0.0);
    EXPECT_EQ(noise_reach(0.0, 1000), 0.0);
    std::mt19937 generator(3);
    std::normal_distribution<double> error(0.0, 2.0);
    for (const std::size_t count : {30u, 1000u, 100000u}) {
        double mean = 0.0;
        for (int trial = 0; trial < 20; ++trial) {
            double largest = 0.0;
            for (std::size_t i = 0; i < count; ++i)
                largest = std::max(largest, std::abs(error(generator)));
            mean += largest / 20.0;
        }
        EXPECT_GT(noise_reach(2.0, count), mean);
        EXPECT_LT(noise_reach(2.0, count), mean + 2.0 * 1.25);
    }
}

//! Points scattered over the torus of torus(), moved across it by normal errors.
PointData points_of_torus(const HandDomain& hand, std::size_t count, double noise)
{
    std::mt19937 generator(11);
    std::uniform_real_distribution<double> angle(0.0, 2.0 * 3.14159265358979323846);
    std::normal_distribution<double> error(0.0, noise);
    PointData data;
    for (std::size_t i = 0; i < count; ++i) {
        const double u = angle(generator), v = angle(generator);
        const double r = 0.4 + (noise > 0.0 ? error(generator) : 0.0);
        const double ring = 1.0 + r * std::cos(v);
        data.positions.push_back({ring * std::cos(u), ring * std::sin(u), r * std::sin(v)});
        data.weights.push_back(1.0 / double(count));
    }
    Context context;
    data.source = *closest_places(hand.mesh, data.positions, context);
    data.noise = noise;
    data.least_deviation = noise;
    return data;
}

TEST(RefineToTolerance, points_are_met_by_a_surface_that_is_nearer_to_them_than_their_mesh_is)
{
    const HandDomain hand = torus(); // its triangles are up to 8e-4 away
    const PointData data = points_of_torus(hand, 6000, 0.0);
    const ToleranceOptions options = options_for(3e-4);
    Context context;
    const Result<ToleranceFit> fit =
        refine_to_tolerance(hand.mesh, hand.domain, options, &data, context);
    ASSERT_TRUE(fit) << fit.error().message;
    EXPECT_EQ(fit->termination, RefinementEnd::tolerance_met);
    EXPECT_GT(fit->rounds.size(), 1u);
    EXPECT_GT(fit->rounds[0].distance.lower, options.tolerance);
    const auto feet =
        find_point_feet(data.positions, fit->domain.complex, fit->fit.surface, context);
    ASSERT_TRUE(feet);
    for (const PointFoot& foot : *feet)
        EXPECT_LE(foot.distance, options.tolerance);
}

TEST(RefineToTolerance, noise_of_points_is_not_followed)
{
    const HandDomain hand = torus();
    constexpr double noise = 0.01;
    const PointData data = points_of_torus(hand, 6000, noise);
    Context context;
    const Result<ToleranceFit> fit =
        refine_to_tolerance(hand.mesh, hand.domain, options_for(noise), &data, context);
    ASSERT_TRUE(fit) << fit.error().message;
    EXPECT_EQ(fit->termination, RefinementEnd::noise_limit);
    EXPECT_LT(fit->domain.complex.quad_count(), 60u);
    EXPECT_NEAR(fit->rounds.back().rms, noise, 0.15 * noise);
    // Nearer to the torus than the points are.
    double sum = 0.0;
    Index places = 0;
    for (Index q = 0; q < fit->domain.complex.quad_count(); ++q)
        for (const double u : {0.2, 0.5, 0.8})
            for (const double v : {0.3, 0.6, 0.9}) {
                const Vec3 p = fit->fit.surface.position({q, u, v});
                const double off = std::hypot(std::hypot(p.x, p.y) - 1.0, p.z) - 0.4;
                sum += off * off;
                ++places;
            }
    EXPECT_LT(std::sqrt(sum / places), 0.35 * noise);
}

TEST(PointTrial, what_changes_along_u_alone_is_told_from_what_changes_along_v)
{
    const HandDomain hand = torus();
    Context context;
    const ToleranceOptions options = options_for(1.0);
    const PointData data = points_of_torus(hand, 3000, 0.0);
    const FitTarget target(hand.mesh, &data, options.tolerance);
    Result<Trial> trial = make_trial(target, hand.domain, options, context);
    ASSERT_TRUE(trial) << trial.error().message;
    const SplineSurface& surface = trial->fit.surface;
    SurfaceSampleSet samples;
    const auto add = [&](Index quad, double u, double v, double height) {
        const SurfacePoint p = surface.evaluate({quad, u, v});
        samples.positions.push_back(p.position - height * normalized(cross(p.du, p.dv)));
        samples.domain.push_back({quad, u, v});
    };
    for (int j = 0; j < 8; ++j)
        for (int i = 0; i < 8; ++i) {
            const double u = (i + 0.5) / 8.0, v = (j + 0.5) / 8.0;
            add(0, u, v, 0.01 * u);
            add(1, u, v, 0.01 * v);
        }
    add(2, 0.1, 0.1, 0.0); // its neighbours have no sample
    add(2, 0.9, 0.9, 0.01);
    std::vector<PatchError> patches(surface.patch_count());
    measure_points(samples, samples.size(), surface, patches);
    // The means of cells a quarter apart differ by a quarter of 0.01.
    EXPECT_NEAR(patches[0].change[0], 0.0025 * 0.0025, 1e-12);
    EXPECT_NEAR(patches[0].change[1], 0.0, 1e-12);
    EXPECT_NEAR(patches[1].change[0], 0.0, 1e-12);
    EXPECT_NEAR(patches[1].change[1], 0.0025 * 0.0025, 1e-12);
    EXPECT_EQ(patches[2].change, (std::array<double, 2>{}));
    EXPECT_NEAR(patches[2].distance, 0.01, 1e-12);
}

TEST(PointTrial, a_surface_that_is_near_all_points_but_strays_from_the_mesh_is_not_within)
{
    // Points around the outer equator: there a shift along the axis is one along the surface.
    const HandDomain hand = torus();
    PointData data;
    for (int i = 0; i < 200; ++i) {
        const double u = 2.0 * 3.14159265358979323846 * i / 200.0;
        data.positions.push_back({1.4 * std::cos(u), 1.4 * std::sin(u), 0.0});
        data.weights.push_back(0.01);
    }
    Context context;
    data.source = *closest_places(hand.mesh, data.positions, context);
    const ToleranceOptions options = options_for(0.03);
    const FitTarget target(hand.mesh, &data, options.tolerance);
    EXPECT_LT(target.surface_limit, 0.04);
    Result<Trial> trial = make_trial(target, hand.domain, options, context);
    ASSERT_TRUE(trial) << trial.error().message;
    ASSERT_FALSE(prove_trial(target, *trial, context));
    EXPECT_TRUE(trial->within);
    EXPECT_EQ(trial->exceeding(), 0u);

    trial->fit.surface.transform(1.0, {0.0, 0.0, 0.1});
    ASSERT_FALSE(prove_trial(target, *trial, context));
    EXPECT_LT(trial->bound.source_to_surface.upper, options.tolerance);
    EXPECT_FALSE(trial->within);
    EXPECT_GT(trial->exceeding(), 0u);
    EXPECT_NEAR(trial->distance(), 0.1 - (target.surface_limit - target.limit), 0.02);
}

TEST(RefineToTolerance, it_can_be_cancelled)
{
    const HandDomain hand = torus();
    Context context;
    context.cancel();
    const Result<ToleranceFit> fit =
        refine_to_tolerance(hand.mesh, hand.domain, options_for(1e-2), nullptr, context);
    ASSERT_FALSE(fit);
    EXPECT_EQ(fit.error().code, ErrorCode::cancelled);
}

//! A sphere with waves that are 2 pi / frequency long.
ManifoldMesh wavy_ball(double frequency)
{
    const HandDomain sphere = test::sphere_cube(0, 24);
    std::vector<Vec3> positions = sphere.mesh.positions();
    for (Vec3& p : positions)
        p *= 1.0 + 0.1 * std::sin(frequency * p.x) * std::sin(frequency * p.y) *
                       std::sin(frequency * p.z);
    return *ManifoldMesh::build(std::move(positions), sphere.mesh.triangles());
}

TEST(LayoutForTolerance, a_smaller_tolerance_starts_from_more_patches_up_to_the_limit)
{
    const ManifoldMesh bumpy = wavy_ball(20.0);
    const auto patches = [&](double tolerance, Index limit) {
        ToleranceOptions options = options_for(tolerance);
        options.max_patches = limit;
        Context context;
        const Result<TriedLayout> start =
            layout_for_tolerance(bumpy, {}, options, nullptr, context);
        EXPECT_TRUE(start);
        return start ? start->layout.domain.complex.quad_count() : 0;
    };
    const Index few = patches(0.5, 5000), more = patches(1e-2, 200);
    EXPECT_LT(few, more);
    for (Index limit = few; limit < few + 9; limit += 4)
        EXPECT_LE(patches(1e-2, limit), limit);
    EXPECT_GT(patches(1e-2, 2), 2u); // No layout has so few.
}

//! A tolerance between what the samples show of a domain and what is true; 0: none was found.
double tolerance_that_samples_miss(const ManifoldMesh& mesh, const QuadDomain& domain)
{
    Context context;
    double tolerance = 0.05;
    for (int i = 0; i < 60; ++i) {
        const FitTarget target(mesh, nullptr, tolerance);
        Result<Trial> trial = make_trial(target, domain, options_for(tolerance), context);
        EXPECT_TRUE(trial);
        if (trial->exceeding() == 0) {
            EXPECT_FALSE(prove_trial(target, *trial, context));
            if (trial->exceeding() > 0)
                return tolerance;
        }
        // From twice what is known of it downwards.
        tolerance = std::min(0.97 * tolerance, 2.0 * trial->distance());
    }
    return 0.0;
}

Result<LayoutResult> layout_of_24(const ManifoldMesh& mesh)
{
    Context context;
    LayoutOptions coarse;
    coarse.patches = 24;
    return build_layout(mesh, coarse, context);
}

TEST(RefineToTolerance, what_only_the_proof_saw_is_fitted_before_anything_is_cut)
{
    const ManifoldMesh ball = wavy_ball(4.0);
    const Result<LayoutResult> first = layout_of_24(ball);
    ASSERT_TRUE(first);
    const double tolerance = tolerance_that_samples_miss(ball, first->domain);
    ASSERT_GT(tolerance, 0.0);
    Context context;
    const auto fit =
        refine_to_tolerance(ball, first->domain, options_for(tolerance), nullptr, context);
    ASSERT_TRUE(fit);
    ASSERT_GE(fit->rounds.size(), 2u);
    ASSERT_LE(fit->rounds[0].exceeding, 2u);
    EXPECT_EQ(fit->rounds[1].patches, fit->rounds[0].patches);
    EXPECT_LT(fit->rounds[1].distance.lower, fit->rounds[0].distance.lower);
    EXPECT_EQ(fit->termination, RefinementEnd::tolerance_met);
}

TEST(LayoutForTolerance, a_layout_that_is_within_at_its_samples_alone_is_not_taken_for_within)
{
    const ManifoldMesh ball = wavy_ball(4.0);
    Context context;
    const Result<LayoutResult> first = layout_of_24(ball);
    ASSERT_TRUE(first);
    const double tolerance = tolerance_that_samples_miss(ball, first->domain);
    ASSERT_GT(tolerance, 0.0);
    const Result<TriedLayout> start =
        layout_for_tolerance(ball, {}, options_for(tolerance), nullptr, context);
    ASSERT_TRUE(start);
    const QuadDomain& domain = start->layout.domain;
    EXPECT_GT(domain.complex.quad_count(), first->domain.complex.quad_count());
    const Result<ToleranceFit> fit =
        refine_to_tolerance(ball, domain, options_for(tolerance), nullptr, context);
    ASSERT_TRUE(fit);
    EXPECT_EQ(fit->termination, RefinementEnd::tolerance_met);
}

TEST(LayoutForTolerance, what_was_tried_is_refined_as_if_it_were_not)
{
    const ManifoldMesh bumpy = wavy_ball(8.0);
    ToleranceOptions options = options_for(6e-3);
    options.max_patches = 400;
    Context context;
    Result<TriedLayout> start = layout_for_tolerance(bumpy, {}, options, nullptr, context);
    ASSERT_TRUE(start);
    ASSERT_TRUE(start->trial);
    const QuadDomain& domain = start->layout.domain;
    const auto again = refine_to_tolerance(bumpy, domain, options, nullptr, context);
    const auto after =
        refine_to_tolerance(bumpy, domain, options, nullptr, context, std::move(start->trial));
    ASSERT_TRUE(again && after);
    EXPECT_GE(again->rounds.size(), 2u);
    EXPECT_EQ(after->rounds.size(), again->rounds.size());
    EXPECT_EQ(after->termination, again->termination);
    EXPECT_EQ(after->fit.surface.bezier(), again->fit.surface.bezier());
    EXPECT_EQ(after->bound.upper(), again->bound.upper());
}

TEST(LayoutForTolerance, what_was_tried_is_not_fitted_again)
{
    const ManifoldMesh ball = wavy_ball(4.0);
    const ToleranceOptions options = options_for(0.5);
    Context context;
    Result<TriedLayout> start = layout_for_tolerance(ball, {}, options, nullptr, context);
    ASSERT_TRUE(start);
    ASSERT_TRUE(start->trial && start->trial->within);
    // No fit would find this surface.
    start->trial->fit.surface.transform(1.0, {0.1, 0.0, 0.0});
    const std::vector<Vec3> moved = start->trial->fit.surface.bezier();
    const auto fit = refine_to_tolerance(ball, start->layout.domain, options, nullptr, context,
                                         std::move(start->trial));
    ASSERT_TRUE(fit);
    EXPECT_EQ(fit->fit.surface.bezier(), moved);
}

} // namespace
} // namespace bot2nurbs
