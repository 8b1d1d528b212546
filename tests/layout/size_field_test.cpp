// SPDX-License-Identifier: MIT
#include "layout/size_field.h"

#include "mesh_fixtures.h"

#include <gtest/gtest.h>

#include <cmath>

namespace bot2nurbs::fixtures {
namespace {

double bending(const ManifoldMesh& mesh)
{
    return measure_size_field(mesh, 0.015 * mesh.box().diagonal(), Context()).bending;
}

TEST(SizeField, bending_of_a_sphere_is_eight_pi_at_any_scale)
{
    for (const double scale : {1e-6, 1.0, 1e6})
        EXPECT_NEAR(bending(moved(icosphere(4), [scale](const Vec3& p) { return scale * p; })),
                    8.0 * pi, 0.02 * 8.0 * pi);
}

TEST(SizeField, bending_of_a_torus_is_its_integral)
{
    // k = 1 / r across the tube, cos(t) / (R + r cos(t)) along it; area element (R + r cos t) r.
    const double R = 1.0, r = 0.4;
    const double across = 4.0 * pi * pi * R / r;
    const double along = 4.0 * pi * pi / r * (R / std::sqrt(R * R - r * r) - 1.0) * R;
    EXPECT_NEAR(across + along, 108.0, 0.5); // As the default number of patches quotes it.
    EXPECT_NEAR(bending(torus(120, 60, R, r)), across + along, 0.03 * (across + along));
}

TEST(SizeField, density_is_even_on_a_sphere_and_higher_where_an_ellipsoid_bends_more)
{
    for (const double d : measure_size_field(icosphere(3), 0.05, Context()).density)
        EXPECT_NEAR(d, 1.0, 0.05);
    const ManifoldMesh egg = moved(icosphere(4), [](const Vec3& p) {
        return Vec3{p.x, p.y, 3.0 * p.z};
    });
    const auto density = measure_size_field(egg, 0.05, Context()).density;
    for (Index v = 0; v < egg.vertex_count(); ++v) {
        EXPECT_TRUE(std::isfinite(density[v]));
        if (std::fabs(egg.position(v).z) > 2.9) {
            EXPECT_GT(density[v], 1.2);
        }
    }
}

TEST(SizeField, is_finite_on_faces_without_area)
{
    const ManifoldMesh flat = moved(icosphere(2), [](const Vec3& p) {
        return Vec3{p.x, 0.0, 0.0};
    });
    for (const double d : measure_size_field(flat, 0.05, Context()).density)
        EXPECT_TRUE(std::isfinite(d) && d > 0.0);
}

} // namespace
} // namespace bot2nurbs::fixtures
