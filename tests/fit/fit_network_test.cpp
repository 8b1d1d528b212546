// SPDX-License-Identifier: MIT
#include "bot2nurbs/fit_network.h"

#include "analytic_targets.h"
#include "hand_domains.h"

#include <chrono>
#include <ctime>
#include <gtest/gtest.h>
#include <pthread.h>
#include <random>
#include <thread>

namespace bot2nurbs::test {
namespace {

struct Fit {
    SplineNetwork network;
    SurfaceSampleSet samples;
    FitResult result;
};

Fit fit(const fixtures::Domain& domain, SurfaceSampleSet samples, const FitOptions& options = {},
        unsigned threads = 0, SplineScheme scheme = SplineScheme::peters)
{
    Fit f;
    auto network = build_spline_network(domain.complex, scheme);
    if (!network)
        throw std::logic_error(network.error().message);
    f.network = std::move(*network);
    f.samples = std::move(samples);
    Context context;
    context.threads = threads;
    auto result = fit_network(f.network, f.samples, options, context);
    if (!result)
        throw std::logic_error(result.error().message);
    f.result = std::move(*result);
    return f;
}

Fit fit(const Target& target, const FitOptions& options = {}, unsigned threads = 0)
{
    return fit(target.domain, sample_target(target), options, threads);
}

double largest_difference(const SplineSurface& a, const SplineSurface& b)
{
    double largest = 0.0;
    for (std::size_t i = 0; i < a.bezier().size(); ++i)
        largest = std::max(largest, norm(a.bezier()[i] - b.bezier()[i]));
    return largest;
}

TEST(FitNetwork, satisfies_the_constraints_to_rounding_and_stays_g1)
{
    for (const SplineScheme scheme : {SplineScheme::peters, SplineScheme::eck_hoppe}) {
        // Far from the origin, so that moving the normalised solution back costs digits too.
        Target target = sphere_target(fixtures::radial_bipyramid(6));
        SurfaceSampleSet samples = sample_target(target);
        for (Vec3& p : samples.positions)
            p = p + Vec3{10.0, -20.0, 30.0};
        const Fit f = fit(target.domain, std::move(samples), {}, 0, scheme);
        const SparseRows& c = f.network.constraints;
        ASSERT_GT(c.row_count(), 0u);
        for (Index r = 0; r < c.row_count(); ++r) {
            Vec3 sum;
            for (std::size_t e = c.offset[r]; e < c.offset[r + 1]; ++e)
                sum += c.weight[e] * f.result.unknowns[c.column[e]];
            EXPECT_LT(norm(sum), 1e-13 * 36.0);
        }
        const Continuity g = measure_continuity(f.network.complex, f.result.surface);
        EXPECT_EQ(g.max_gap, 0.0);
        EXPECT_LT(g.max_g1_angle_deg, 1e-9);
    }
}

TEST(FitNetwork, reports_every_round)
{
    const Fit f = fit(sphere_target(1));
    const FitSummary& s = f.result.summary;
    EXPECT_EQ(s.unknowns, 384u);
    EXPECT_EQ(s.samples, 3456u);
    EXPECT_GE(s.rounds.size(), 5u);
    EXPECT_FALSE(s.used_fallback);
    EXPECT_GT(s.condition, 1.0);
    EXPECT_LT(s.condition, 1e10);
    EXPECT_TRUE(s.termination == "stalled" || s.termination == "round_limit");
    EXPECT_EQ(s.rounds[0].damping, 1.0);
    for (std::size_t r = 1; r < s.rounds.size(); ++r) {
        EXPECT_LE(s.rounds[r].fairness, s.rounds[r - 1].fairness);
        EXPECT_LE(s.rounds[r].rms, s.rounds[r].max);
    }
    // The last round is what the result is: measured again from its parameters.
    double largest = 0.0;
    for (std::size_t i = 0; i < f.samples.size(); ++i)
        largest = std::max(
            largest, norm(f.result.surface.position(f.samples.domain[i]) - f.samples.positions[i]));
    EXPECT_NEAR(largest, s.rounds.back().max, 1e-12);
}

TEST(FitNetwork, stops_when_a_round_gains_less_than_the_stall_share)
{
    FitOptions options;
    options.max_rounds = 40;
    options.stall = 0.2;
    const Fit f = fit(sphere_target(0), options);
    EXPECT_EQ(f.result.summary.termination, "stalled");
    EXPECT_LT(f.result.summary.rounds.size(), 20u);
}

TEST(FitNetwork, reproduces_planes_exactly)
{
    // Linear precision: samples of a plane, taken at their own parameters, leave nothing.
    const fixtures::Domain disk = fixtures::disk_grid(3, 2);
    const Target plane{disk,
                       [](const Vec3& p) {
                           return Vec3{p.x + 2, 0.5 * p.y, 0.3 * p.x - 0.1 * p.y};
                       },
                       {},
                       1.0};
    const Fit f = fit(plane);
    EXPECT_LT(f.result.summary.rounds.back().max, 1e-12);
}

TEST(FitNetwork, is_equivariant_under_similarities)
{
    const Target target = voxel_ring_target();
    const Fit f = fit(target);
    // A rotation by a rational angle, a scale and a move.
    const double c = 0.6, s = 0.8;
    const auto similar = [&](const Vec3& p) {
        return Vec3{c * p.x - s * p.y, s * p.x + c * p.y, p.z};
    };
    for (const double scale : {1e-6, 1.0, 1e6}) {
        SurfaceSampleSet samples = sample_target(target);
        for (std::size_t i = 0; i < samples.size(); ++i) {
            samples.positions[i] = scale * (similar(samples.positions[i]) + Vec3{1, 2, 3});
            samples.normals[i] = similar(samples.normals[i]);
            samples.weights[i] *= scale * scale;
        }
        const Fit g = fit(target.domain, std::move(samples));
        double largest = 0.0;
        for (std::size_t i = 0; i < f.result.surface.bezier().size(); ++i)
            largest = std::max(
                largest, norm(scale * (similar(f.result.surface.bezier()[i]) + Vec3{1, 2, 3}) -
                              g.result.surface.bezier()[i]));
        // Rounding is amplified by the softest directions, along the surface.
        EXPECT_LT(largest / scale, 1e-4) << scale;
        EXPECT_NEAR(g.result.summary.rounds.back().rms / scale / f.result.summary.rounds.back().rms,
                    1.0, 1e-4);
        EXPECT_EQ(g.result.summary.rounds.size(), f.result.summary.rounds.size());
    }
}

TEST(FitNetwork, gives_the_same_numbers_at_scales_that_are_powers_of_two)
{
    const Target target = sphere_target(0);
    const Fit f = fit(target);
    const double scale = std::ldexp(1.0, 20);
    SurfaceSampleSet samples = sample_target(target);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        samples.positions[i] *= scale;
        samples.weights[i] *= scale * scale;
    }
    const Fit g = fit(target.domain, std::move(samples));
    SplineSurface back = g.result.surface;
    back.transform(1.0 / scale, {});
    EXPECT_EQ(largest_difference(back, f.result.surface), 0.0);
}

TEST(FitNetwork, gives_the_same_bytes_for_1_2_and_8_threads)
{
    const Target target = sphere_target(fixtures::split_bipyramid(5));
    const Fit one = fit(target, {}, 1), two = fit(target, {}, 2), eight = fit(target, {}, 8);
    EXPECT_EQ(one.result.unknowns, two.result.unknowns);
    EXPECT_EQ(one.result.unknowns, eight.result.unknowns);
    for (std::size_t i = 0; i < one.samples.size(); ++i) {
        EXPECT_EQ(one.samples.domain[i].u, eight.samples.domain[i].u);
        EXPECT_EQ(one.samples.domain[i].quad, eight.samples.domain[i].quad);
    }
}

TEST(FitNetwork, follows_the_heavier_of_two_contradicting_samples)
{
    // Every place is sampled twice, on spheres of radius 1 and 1.1.
    const Target target = sphere_target(1);
    for (const double weight : {1.0, 99.0}) {
        SurfaceSampleSet samples = sample_target(target), outer = samples;
        for (std::size_t i = 0; i < outer.size(); ++i) {
            samples.positions.push_back(1.1 * outer.positions[i]);
            samples.normals.push_back(outer.normals[i]);
            samples.weights.push_back(weight * outer.weights[i]);
            samples.domain.push_back(outer.domain[i]);
        }
        const Fit f = fit(target.domain, std::move(samples));
        const double expected = (1.0 + 1.1 * weight) / (1.0 + weight);
        double mean = 0.0;
        for (Index q = 0; q < 24; ++q)
            mean += norm(f.result.surface.position({q, 0.4, 0.6})) / 24.0;
        EXPECT_NEAR(mean, expected, 1e-3) << weight;
    }
}

TEST(FitNetwork, emphasis_evens_out_the_distances_of_contradicting_samples)
{
    // Every place is sampled twice, on spheres of radius 1 and, nine times as heavy, 1.1.
    const Target target = sphere_target(1);
    SurfaceSampleSet samples = sample_target(target), outer = samples;
    for (std::size_t i = 0; i < outer.size(); ++i) {
        samples.positions.push_back(1.1 * outer.positions[i]);
        samples.normals.push_back(outer.normals[i]);
        samples.weights.push_back(9.0 * outer.weights[i]);
        samples.domain.push_back(outer.domain[i]);
    }
    FitOptions options;
    options.emphasis = 0.1;
    const Fit f = fit(target.domain, std::move(samples), options);
    // The radius at which the weights, multiplied by 1 + (distance / 0.1)^2, are in balance.
    double radius = 1.09;
    for (int i = 0; i < 100; ++i) {
        const double in = radius - 1.0, out = 1.1 - radius;
        const double a = 1.0 + 100.0 * in * in, b = 9.0 * (1.0 + 100.0 * out * out);
        radius = (a + 1.1 * b) / (a + b);
    }
    double mean = 0.0;
    for (Index q = 0; q < 24; ++q)
        mean += norm(f.result.surface.position({q, 0.4, 0.6})) / 24.0;
    EXPECT_LT(radius, 1.086);
    EXPECT_NEAR(mean, radius, 1e-3);
}

TEST(FitNetwork, robust_rounds_ignore_outliers)
{
    const Target target = sphere_target(1);
    SurfaceSampleSet samples = sample_target(target);
    // One sample in twenty, outward by up to half a radius.
    std::mt19937 generator(5);
    std::uniform_real_distribution<double> value(0.1, 0.5);
    for (std::size_t i = 0; i < samples.size(); i += 20)
        samples.positions[i] *= 1.0 + value(generator);
    FitOptions options;
    const Fit plain = fit(target.domain, samples, options);
    options.robust = true;
    options.max_rounds = 15;
    const Fit robust = fit(target.domain, samples, options);
    const double plain_error = target_error(target, plain.result.surface).rms;
    const double robust_error = target_error(target, robust.result.surface).rms;
    EXPECT_GT(plain_error, 0.3);
    EXPECT_LT(robust_error, 0.1 * plain_error);
}

TEST(FitNetwork, a_fit_that_knows_the_noise_does_not_follow_it)
{
    const Target target = sphere_target(2);
    SurfaceSampleSet samples = sample_target(target, 2); // four for each unknown
    constexpr double noise = 0.02;
    std::mt19937 generator(5);
    std::normal_distribution<double> step(0.0, noise);
    for (Vec3& p : samples.positions)
        p *= 1.0 + step(generator);
    FitOptions options;
    const Fit plain = fit(target.domain, samples, options);
    options.noise = noise;
    const Fit fair = fit(target.domain, samples, options);
    EXPECT_LT(target_error(target, fair.result.surface).rms,
              0.5 * target_error(target, plain.result.surface).rms);
    EXPECT_LT(plain.result.summary.rounds.back().rms, 0.8 * noise);
    EXPECT_NEAR(fair.result.summary.rounds.back().rms, noise, 0.25 * noise);
}

TEST(FitNetwork, noise_elsewhere_does_not_keep_the_surface_from_detail_that_is_no_noise)
{
    // A bump as wide as a quad, of a thousandth of the surface: all samples together are within the
    // noise without it.
    const Target target = sphere_target(3);
    SurfaceSampleSet samples = sample_target(target, 2);
    constexpr double noise = 0.01, width = 0.15;
    std::mt19937 generator(5);
    std::normal_distribution<double> step(0.0, noise);
    const auto from_pole = [](const Vec3& p) {
        return std::acos(std::clamp(p.z / norm(p), -1.0, 1.0));
    };
    for (Vec3& p : samples.positions) {
        const double off = from_pole(p) / width;
        p *= 1.0 + 8.0 * noise * std::exp(-off * off) + step(generator);
    }
    FitOptions options;
    options.noise = noise;
    const Fit f = fit(target.domain, samples, options);
    double sum = 0.0;
    Index count = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const Vec3& p = samples.positions[i];
        if (from_pole(p) > width)
            continue;
        const double miss = norm(f.result.surface.position(f.samples.domain[i]) - p);
        sum += miss * miss;
        ++count;
    }
    EXPECT_LT(std::sqrt(sum / count), 1.25 * noise); // 1.5 with one fairness for all quads
}

TEST(FitNetwork, noise_below_what_the_surface_can_meet_changes_nothing)
{
    const Target target = sphere_target(0);
    const Fit plain = fit(target);
    FitOptions options;
    options.noise = 1e-9;
    EXPECT_EQ(largest_difference(plain.result.surface, fit(target, options).result.surface), 0.0);
}

TEST(FitNetwork, robust_rounds_take_no_sample_within_the_least_deviation_for_an_outlier)
{
    const Target target = sphere_target(1);
    SurfaceSampleSet samples = sample_target(target);
    for (std::size_t i = 0; i < samples.size(); i += 20)
        samples.positions[i] *= 1.05;
    FitOptions options;
    const Fit plain = fit(target.domain, samples, options);
    options.robust = true;
    options.least_deviation = 1.0;
    const Fit same = fit(target.domain, samples, options);
    EXPECT_EQ(largest_difference(plain.result.surface, same.result.surface), 0.0);
}

TEST(FitNetwork, falls_back_to_qr_above_the_condition_limit)
{
    FitOptions options;
    options.rows = DistanceRows::point;
    const Target target = sphere_target(0);
    const Fit normal = fit(target, options);
    options.condition_limit = 1.0;
    const Fit forced = fit(target, options);
    EXPECT_FALSE(normal.result.summary.used_fallback);
    EXPECT_TRUE(forced.result.summary.used_fallback);
    EXPECT_LT(largest_difference(normal.result.surface, forced.result.surface), 1e-9);
    // Tangent rows, refused as well, end in point rows.
    options.rows = DistanceRows::tangent;
    const Fit tangent = fit(target, options);
    EXPECT_TRUE(tangent.result.summary.used_fallback);
    EXPECT_EQ(tangent.result.summary.rounds.back().damping, 1.0);
}

TEST(FitNetwork, fills_patches_without_samples_by_fairness)
{
    const Target target = sphere_target(1);
    SurfaceSampleSet all = sample_target(target), some;
    for (std::size_t i = 0; i < all.size(); ++i)
        if (all.domain[i].quad != 7) {
            some.positions.push_back(all.positions[i]);
            some.normals.push_back(all.normals[i]);
            some.weights.push_back(all.weights[i]);
            some.domain.push_back(all.domain[i]);
        }
    const Fit f = fit(target.domain, std::move(some));
    EXPECT_LT(target_error(target, f.result.surface).max, 3.0);
    EXPECT_LT(f.result.summary.rounds.back().rms, 1e-3);
}

TEST(FitNetwork, fits_a_surface_of_genus_2_through_its_charts)
{
    const HandDomain hand = genus2_voxels();
    ASSERT_FALSE(hand.charts.empty());
    SurfaceSampleSet samples;
    Box3 box = hand.mesh.box();
    for (Index q = 0; q < hand.charts.size(); ++q) {
        const QuadChart& chart = hand.charts[q];
        for (std::size_t t = 0; t < chart.triangles.size(); ++t) {
            const auto& corner = chart.triangles[t];
            const auto &a = chart.vertices[corner[0]], &b = chart.vertices[corner[1]],
                       &c = chart.vertices[corner[2]];
            const Vec3 area = cross(b.position - a.position, c.position - a.position);
            for (int k = 0; k < 4; ++k) {
                const double wa = k == 0 ? 0.6 : (k == 3 ? 1.0 / 3 : 0.2);
                const double wb = k == 1 ? 0.6 : (k == 3 ? 1.0 / 3 : 0.2);
                const double wc = 1.0 - wa - wb;
                samples.positions.push_back(wa * a.position + wb * b.position + wc * c.position);
                samples.normals.push_back(normalized(area));
                samples.weights.push_back(norm(area) / 8.0);
                samples.domain.push_back({q, wa * a.uv.x + wb * b.uv.x + wc * c.uv.x,
                                          wa * a.uv.y + wb * b.uv.y + wc * c.uv.y});
            }
        }
    }
    const fixtures::Domain domain{"genus2", hand.domain.complex, {}};
    const Fit f = fit(domain, std::move(samples));
    // The mesh is faceted; its facets are what remains.
    EXPECT_LT(f.result.summary.rounds.back().rms, 0.005 * box.diagonal());
    Index crossed = 0;
    for (const FitRound& r : f.result.summary.rounds)
        crossed += r.crossed;
    EXPECT_GT(crossed, 0u);
}

//! Processor seconds a thread has used: what it did, however loaded the machine is.
double thread_seconds(clockid_t clock)
{
    timespec t{};
    clock_gettime(clock, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

TEST(FitNetwork, is_cancelled_within_50_ms_and_leaves_the_samples_alone)
{
    // One factorisation of this size takes several times as long as a cancelled call may.
    const Target target = torus_target(28, 14);
    const auto network = build_spline_network(target.domain.complex, SplineScheme::peters);
    const SurfaceSampleSet before = sample_target(target);
    clockid_t clock;
    ASSERT_EQ(pthread_getcpuclockid(pthread_self(), &clock), 0);
    for (const double after : {0.001, 0.02, 0.1, 0.25, 0.5, 1.0}) {
        SurfaceSampleSet samples = before;
        Context context;
        context.threads = 1;
        FitOptions options;
        options.max_rounds = 1000;
        options.stall = 0.0;
        const double start = thread_seconds(clock);
        double asked = 0.0;
        std::thread canceller([&] {
            while (thread_seconds(clock) < start + after)
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
            // Asked first, then read: this thread may be kept waiting between the two.
            context.cancel();
            asked = thread_seconds(clock);
        });
        const auto result = fit_network(*network, samples, options, context);
        const double ended = thread_seconds(clock);
        canceller.join();
        ASSERT_FALSE(result.ok());
        EXPECT_EQ(result.error().code, ErrorCode::cancelled);
        EXPECT_LT(ended - asked, 0.05) << after;
        for (std::size_t i = 0; i < samples.size(); ++i) {
            ASSERT_EQ(samples.domain[i].u, before.domain[i].u);
            ASSERT_EQ(samples.domain[i].quad, before.domain[i].quad);
        }
    }
}

TEST(FitNetwork, names_what_is_wrong_with_options_and_samples)
{
    const Target target = sphere_target(0);
    const auto network = build_spline_network(target.domain.complex, SplineScheme::peters);
    Context context;
    const auto code = [&](SurfaceSampleSet samples, const FitOptions& options) {
        const auto result = fit_network(*network, samples, options, context);
        EXPECT_FALSE(result.ok());
        return result.ok() ? Error{} : result.error();
    };
    const SurfaceSampleSet good = sample_target(target);
    FitOptions options;
    options.max_rounds = 4;
    EXPECT_EQ(code(good, options).code, ErrorCode::bad_option);
    options = {};
    options.fairness_floor = 1.0;
    EXPECT_EQ(code(good, options).code, ErrorCode::bad_option);
    options = {};
    options.emphasis = -1.0;
    EXPECT_EQ(code(good, options).code, ErrorCode::bad_option);
    options = {};
    options.stall = 1.0;
    EXPECT_EQ(code(good, options).code, ErrorCode::bad_option);
    EXPECT_EQ(code({}, {}).code, ErrorCode::empty_input);
    SurfaceSampleSet bad = good;
    bad.positions[17].y = NAN;
    EXPECT_EQ(code(bad, {}).element, 17u);
    bad = good;
    bad.weights[3] = 0.0;
    EXPECT_EQ(code(bad, {}).element, 3u);
    bad = good;
    bad.domain[5].quad = 6;
    EXPECT_EQ(code(bad, {}).element, 5u);
    bad = good;
    bad.normals.pop_back();
    EXPECT_EQ(code(bad, {}).code, ErrorCode::bad_geometry);
    bad = good;
    for (Vec3& p : bad.positions)
        p = {1, 1, 1};
    EXPECT_EQ(code(bad, {}).code, ErrorCode::bad_geometry);
}

} // namespace
} // namespace bot2nurbs::test
