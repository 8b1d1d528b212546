// SPDX-License-Identifier: MIT
#include "brep/bspline.h"
#include "brep/volume.h"

#include "brep/brep_fixtures.h"

#include <gtest/gtest.h>

namespace bot2nurbs {
namespace {

using namespace fixtures;

//! Textbook recursion for one basis function, knots with an extra one at each end.
double recursive_basis(const std::vector<double>& knots, int i, int degree, double t)
{
    if (degree == 0)
        return knots[i] <= t && t < knots[i + 1] ? 1.0 : 0.0;
    double sum = 0.0;
    if (knots[i + degree] > knots[i])
        sum += (t - knots[i]) / (knots[i + degree] - knots[i]) *
               recursive_basis(knots, i, degree - 1, t);
    if (knots[i + degree + 1] > knots[i + 1])
        sum += (knots[i + degree + 1] - t) / (knots[i + degree + 1] - knots[i + 1]) *
               recursive_basis(knots, i + 1, degree - 1, t);
    return sum;
}

const std::vector<double> paper_knots{0, 0, 0, 1, 1, 1, 2, 2, 3, 3, 3, 4, 4, 4};
const std::vector<double> c1_knots{0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4};

TEST(BsplineBasis, agrees_with_the_recursion_of_the_textbook)
{
    for (const auto& knots : {paper_knots, c1_knots}) {
        const Index count = static_cast<Index>(knots.size()) - 2;
        std::vector<double> full = knots;
        full.insert(full.begin(), knots.front());
        full.push_back(knots.back());
        for (double t = 0.0; t < 4.0; t += 0.0625) {
            const BasisValues b = bspline_basis(knots, 4, count, t);
            for (Index i = 0; i < count; ++i) {
                const double value = i >= b.first && i < b.first + 4 ? b.value[i - b.first] : 0.0;
                EXPECT_NEAR(value, recursive_basis(full, static_cast<int>(i), 3, t), 1e-15);
            }
        }
    }
}

TEST(BsplineBasis, derivative_agrees_with_differences_inside_spans)
{
    constexpr double h = 1e-6;
    for (double t : {0.1, 0.9, 1.3, 2.5, 3.7}) {
        const BasisValues b = bspline_basis(c1_knots, 4, 10, t);
        const BasisValues low = bspline_basis(c1_knots, 4, 10, t - h),
                          high = bspline_basis(c1_knots, 4, 10, t + h);
        for (int i = 0; i < 4; ++i)
            EXPECT_NEAR(b.derivative[i], (high.value[i] - low.value[i]) / (2 * h), 1e-8);
    }
}

TEST(BsplineBasis, ends_interpolate_exactly_and_outside_is_clamped)
{
    for (double t : {4.0, 5.0}) {
        const BasisValues b = bspline_basis(paper_knots, 4, 12, t);
        EXPECT_EQ(b.first, 8u);
        EXPECT_EQ(b.value[3], 1.0);
    }
    EXPECT_EQ(bspline_basis(paper_knots, 4, 12, -1.0).value[0], 1.0);
}

TEST(BsplinePatch, both_forms_are_the_spline_surface)
{
    const Domain d = sphere_cube(1);
    const SplineSurface surface = network_surface(d, to_unit_sphere);
    for (KnotForm form : {KnotForm::paper, KnotForm::c1}) {
        for (Index q : {0u, 7u, 23u}) {
            const BsplinePatch patch = bspline_patch(surface, q, form);
            for (int i = 0; i <= 16; ++i) {
                for (int j = 0; j <= 16; ++j) {
                    const SurfacePoint s = surface.evaluate({q, i / 16.0, j / 16.0});
                    const PatchPoint p = evaluate_patch(patch, i / 4.0, j / 4.0);
                    EXPECT_LT(norm(p.position - s.position), 1e-14);
                    // The patch's parameters run four times as far.
                    EXPECT_LT(norm(4.0 * p.du - s.du), 1e-12);
                    EXPECT_LT(norm(4.0 * p.dv - s.dv), 1e-12);
                }
            }
        }
    }
}

TEST(BsplinePatch, sides_run_counter_clockwise)
{
    const BsplinePatch patch =
        bspline_patch(surface_of_points(1,
                                        [](Index, Index i, Index j) {
                                            return Vec3{double(i), double(j), 0.0};
                                        }),
                      0, KnotForm::c1);
    const Vec3 corner[4] = {{0, 0, 0}, {12, 0, 0}, {12, 12, 0}, {0, 12, 0}};
    for (Index s = 0; s < 4; ++s) {
        EXPECT_EQ(patch.control[side_control(patch.size, s, 0)], corner[s]);
        EXPECT_EQ(patch.control[side_control(patch.size, s, patch.size - 1)], corner[(s + 1) % 4]);
    }
}

//! The cube [0, 12]^3 with flat faces of uneven parameters inside; borders are integer and exact.
Brep box_brep(KnotForm form)
{
    const Domain d = cube();
    const auto at = [&](Index q, Index i, Index j) {
        const auto& c = d.complex.quad(q);
        const double u = i / 12.0, v = j / 12.0;
        return 6.0 * ((1 - u) * ((1 - v) * d.positions[c[0]] + v * d.positions[c[3]]) +
                      u * ((1 - v) * d.positions[c[1]] + v * d.positions[c[2]])) +
               Vec3{6, 6, 6};
    };
    return must_assemble(
        d.complex,
        surface_of_points(6,
                          [&](Index q, Index i, Index j) {
                              const Vec3 p = at(q, i, j);
                              return Vec3{std::round(p.x), std::round(p.y), std::round(p.z)};
                          }),
        form);
}

TEST(SignedVolume, of_a_box_is_exact)
{
    for (KnotForm form : {KnotForm::paper, KnotForm::c1}) {
        const Brep box = box_brep(form);
        EXPECT_NEAR(signed_volume(box), 1728.0, 1e-11);
        EXPECT_NEAR(patch_area(box.surfaces[0]), 144.0, 1e-12);
    }
}

TEST(SignedVolume, of_a_polynomial_bump_is_exact)
{
    // One cubic piece with inner coefficients 1: z = f(u) f(v), f = 3 t (1 - t), whose integral
    // over the unit square is 1 / 4.
    Brep brep;
    BsplinePatch patch;
    patch.size = 4;
    patch.knots = {0, 0, 0, 1, 1, 1};
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) {
            const bool inner = (i == 1 || i == 2) && (j == 1 || j == 2);
            patch.control.push_back({i / 3.0, j / 3.0, inner ? 1.0 : 0.0});
        }
    }
    brep.surfaces.push_back(patch);
    brep.faces.push_back({{}, 0, false});
    const double about_origin = signed_volume(brep, {0}, {0, 0, 0});
    const double about_far = signed_volume(brep, {0}, {0, 0, -30});
    // Moving the origin by h along -z adds h / 3 times the projected area, 1.
    EXPECT_NEAR(about_far - about_origin, 10.0, 1e-13);
    // Integral of (z - x z_x - y z_y) / 3 = (V + V + V) / 3 by parts, V = 1/4.
    EXPECT_NEAR(about_origin, 0.25, 1e-14);
}

TEST(SignedVolume, does_not_depend_on_place_and_scales_with_the_cube)
{
    const Brep sphere = sphere_brep(1, KnotForm::c1);
    const double volume = signed_volume(sphere);
    // The control points, not the surface, are near the unit sphere: the surface is a little
    // inside.
    EXPECT_NEAR(volume, 4.0 / 3.0 * M_PI, 5e-2);
    Brep moved = sphere;
    transform(moved, 1.0, {1000, -2000, 500});
    EXPECT_NEAR(signed_volume(moved), volume, 1e-11);
    for (double scale : {1e-6, 1e6}) {
        Brep scaled = sphere;
        transform(scaled, scale, {});
        EXPECT_NEAR(signed_volume(scaled) / (scale * scale * scale), volume, 1e-13);
    }
}

} // namespace
} // namespace bot2nurbs
