// SPDX-License-Identifier: MIT
#include "bot2nurbs/fit_network.h"

#include "analytic_targets.h"

#include <gtest/gtest.h>

namespace bot2nurbs::test {
namespace {

//! Samples of a sphere, none of half of its first patch.
SurfaceSampleSet samples_with_a_hole(const Target& sphere)
{
    const SurfaceSampleSet all = sample_target(sphere);
    SurfaceSampleSet samples;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (all.domain[i].quad == 0 && all.domain[i].u > 0.5)
            continue;
        samples.positions.push_back(all.positions[i]);
        samples.normals.push_back(all.normals[i]);
        samples.weights.push_back(all.weights[i]);
        samples.domain.push_back(all.domain[i]);
    }
    return samples;
}

std::optional<NearPlace> on_unit_sphere(const Vec3& point, const Vec3& along)
{
    const Vec3 normal = normalized(point);
    if (!(dot(normal, along) > 0.0))
        return std::nullopt;
    return NearPlace{normal, normal};
}

SplineSurface fitted(const Target& target, SurfaceSampleSet samples, const NearestPlace& nearest,
                     unsigned threads = 0)
{
    const auto network = build_spline_network(target.domain.complex, SplineScheme::peters);
    Context context;
    context.threads = threads;
    const std::size_t count = samples.size();
    Result<FitResult> fit = fit_network(*network, samples, {}, context, nearest);
    EXPECT_TRUE(fit);
    EXPECT_EQ(samples.domain.size(), count); // Those that were added are not the caller's.
    return std::move(fit->surface);
}

TEST(FillGaps, where_samples_are_missing_the_surface_keeps_to_the_source_all_the_same)
{
    const Target sphere = sphere_target(0);
    const SurfaceSampleSet samples = samples_with_a_hole(sphere);
    const double without = target_error(sphere, fitted(sphere, samples, {})).max;
    const double with = target_error(sphere, fitted(sphere, samples, on_unit_sphere)).max;
    const double whole = target_error(sphere, fitted(sphere, sample_target(sphere), {})).max;
    EXPECT_LT(with, 0.2 * without);
    EXPECT_LT(with, 2.0 * whole);
}

TEST(FillGaps, places_that_are_not_there_or_far_away_change_nothing)
{
    const Target sphere = sphere_target(0);
    const SurfaceSampleSet samples = samples_with_a_hole(sphere);
    const std::vector<Vec3> without = fitted(sphere, samples, {}).bezier();
    EXPECT_EQ(
        fitted(sphere, samples, [](const Vec3&, const Vec3&) { return std::nullopt; }).bezier(),
        without);
    EXPECT_EQ(fitted(sphere, samples,
                     [](const Vec3& p, const Vec3& along) {
                         return std::optional<NearPlace>({p + 100.0 * along, along});
                     })
                  .bezier(),
              without);
}

TEST(FillGaps, the_surface_does_not_depend_on_the_number_of_threads)
{
    const Target sphere = sphere_target(0);
    const SurfaceSampleSet samples = samples_with_a_hole(sphere);
    EXPECT_EQ(fitted(sphere, samples, on_unit_sphere, 1).bezier(),
              fitted(sphere, samples, on_unit_sphere, 2).bezier());
}

} // namespace
} // namespace bot2nurbs::test
