// SPDX-License-Identifier: MIT
#include "fit/plane_quads.h"

#include "bot2nurbs/fit_network.h"
#include "bot2nurbs/spline_network.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace bot2nurbs {
namespace {

constexpr double pi = 3.14159265358979323846;

//! A floor, quad 0, and a slope, quad 1, that meet in a straight crease. The slope is corrugated
//! more finely than a patch can follow.
struct FloorAndSlope {
    QuadComplex complex;
    SurfaceSampleSet samples;

    FloorAndSlope()
    {
        auto built =
            QuadComplex::build(6, {{0, 1, 4, 3}, {1, 2, 5, 4}}, {{1, 4}}, {0, 1, 2, 3, 4, 5});
        if (!built)
            throw std::logic_error(built.error().message);
        complex = std::move(*built);
        constexpr int side = 16;
        const Vec3 up{0.0, 0.0, 1.0}, across = normalized(Vec3{-1.0, 0.0, 1.0});
        for (int i = 0; i < side; ++i)
            for (int j = 0; j < side; ++j) {
                const double u = (i + 0.5) / side, v = (j + 0.5) / side;
                add({u, v, 0.0}, up, {0, u, v}, false);
                const double wave = 0.05 * std::sin(11.0 * pi * v);
                add(Vec3{1.0 + u, v, u} + wave * across, across, {1, u, v}, false);
            }
        for (int j = 0; j < side; ++j) {
            const double v = (j + 0.5) / side;
            add({1.0, v, 0.0}, up, {0, 1.0, v}, true);
        }
    }

    void add(const Vec3& position, const Vec3& normal, const DomainPoint& place, bool on_curve)
    {
        samples.positions.push_back(position);
        samples.normals.push_back(normal);
        samples.weights.push_back(1.0);
        samples.source.push_back({});
        samples.domain.push_back(place);
        samples.on_curve.push_back(on_curve);
    }
};

//! The largest distance of the fitted floor from its plane.
double bend_of_floor(SurfaceSampleSet samples, const QuadComplex& complex)
{
    const auto network = build_spline_network(complex, SplineScheme::peters);
    if (!network)
        throw std::logic_error(network.error().message);
    Context context;
    const auto fit = fit_network(*network, samples, {}, context);
    if (!fit)
        throw std::logic_error(fit.error().message);
    double most = 0.0;
    for (int i = 0; i <= 32; ++i)
        for (int j = 0; j <= 32; ++j)
            most = std::max(most, std::fabs(fit->surface.position({0, i / 32.0, j / 32.0}).z));
    return most;
}

TEST(PlaneQuads, are_those_with_all_samples_and_normals_in_one_plane)
{
    const FloorAndSlope shape;
    const SurfaceSampleSet& s = shape.samples;
    const std::vector<char> found = in_plane_quads(2, s.positions, s.normals, s.domain, s.on_curve);
    for (std::size_t i = 0; i < s.size(); ++i)
        EXPECT_EQ(found[i] != 0, s.domain[i].quad == 0 && !s.on_curve[i]) << i;
}

TEST(PlaneQuads, one_sample_off_the_plane_or_turned_away_is_enough_to_bend_it)
{
    const FloorAndSlope shape;
    for (const bool turned : {false, true}) {
        SurfaceSampleSet s = shape.samples;
        if (turned)
            s.normals[40] = normalized(Vec3{1e-3, 0.0, 1.0});
        else
            s.positions[40].z += 1e-5;
        const std::vector<char> found =
            in_plane_quads(2, s.positions, s.normals, s.domain, s.on_curve);
        EXPECT_EQ(std::count(found.begin(), found.end(), 1), 0);
    }
}

TEST(PlaneQuads, without_normals_there_are_none)
{
    const FloorAndSlope shape;
    const SurfaceSampleSet& s = shape.samples;
    const std::vector<char> found = in_plane_quads(2, s.positions, {}, s.domain, s.on_curve);
    EXPECT_EQ(std::count(found.begin(), found.end(), 1), 0);
}

TEST(PlaneQuads, stay_plane_beside_a_face_that_cannot_follow_its_samples)
{
    const FloorAndSlope shape;
    // The same floor with a sample a little off, so that it counts as curved.
    SurfaceSampleSet curved = shape.samples;
    curved.positions[40].z += 1e-5;
    const double with = bend_of_floor(shape.samples, shape.complex),
                 without = bend_of_floor(curved, shape.complex);
    EXPECT_LT(with, 0.2 * without) << without;
}

} // namespace
} // namespace bot2nurbs
