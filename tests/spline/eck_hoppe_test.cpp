// SPDX-License-Identifier: MIT
#include "network_fixtures.h"
#include "spline/bernstein.h"

namespace bot2nurbs {
namespace {

using namespace fixtures;

constexpr SplineScheme eck_hoppe = SplineScheme::eck_hoppe;

TEST(EckHoppe, random_nets_of_valence_3_to_10_have_one_tangent_plane_along_every_join)
{
    for (const Domain& d : closed_domains()) {
        const SplineNetwork network = network_of(d, eck_hoppe);
        EXPECT_FALSE(network.c1_inside);
        for (std::uint64_t seed : {1u, 2u, 3u}) {
            const SplineSurface s(network, random_unknowns(network, seed));
            const Continuity c = measure_continuity(d.complex, s, 13);
            EXPECT_EQ(c.max_gap, 0.0) << d.name;
            EXPECT_LE(c.max_g1_angle_deg, 1e-9) << d.name << " edge " << c.worst_edge;
            EXPECT_LE(c.max_inner_angle_deg, 1e-9) << d.name << " patch " << c.worst_patch;
            EXPECT_EQ(c.undefined_normals, 0u) << d.name;
        }
    }
}

TEST(EckHoppe, every_control_is_an_unknown_and_a_point)
{
    for (const Domain& d : closed_domains()) {
        const SplineNetwork network = network_of(d, eck_hoppe);
        EXPECT_EQ(network.unknown_count, 16 * d.complex.quad_count());
        for (char point : network.is_point)
            EXPECT_EQ(point, 1);
        for (Index r = 0; r < network.stencils.row_count(); ++r) {
            double sum = 0.0;
            for (std::size_t i = network.stencils.offset[r]; i < network.stencils.offset[r + 1];
                 ++i) {
                sum += network.stencils.weight[i];
            }
            EXPECT_NEAR(sum, 1.0, 1e-14) << d.name;
        }
    }
}

TEST(EckHoppe, cross_derivatives_obey_the_linear_law_at_both_ends_of_every_edge)
{
    // d_v P + d_u P' = 2 c (1 - t) x' on the first piece, 0 on the second.
    for (const Domain& d : closed_domains()) {
        const QuadComplex& k = d.complex;
        const SplineNetwork network = network_of(d, eck_hoppe);
        const SplineSurface s(network, random_unknowns(network, 5));
        for (Index h = 0; h < k.halfedge_count(); ++h) {
            const double c = fan_cosine(k.valence(k.from(h)));
            std::array<Vec3, 7> x, rest;
            for (Index j = 0; j < 7; ++j) {
                x[j] = local_bezier(s, h, j, 0);
                rest[j] =
                    local_bezier(s, h, j, 1) + local_bezier(s, k.twin(h), 12 - j, 1) - 2.0 * x[j];
            }
            for (Index j = 0; j < 3; ++j) {
                rest[j] -= 2.0 * c * (3 - j) / 3.0 * (x[j + 1] - x[j]);
            }
            for (const Vec3& r : rest)
                EXPECT_LE(max_abs(r), 1e-14) << d.name << " halfedge " << h;
        }
    }
}

TEST(EckHoppe, the_first_inner_knot_is_only_geometrically_smooth)
{
    // x_J(1-, K) = (1 + a (1 - K)) x_J(1+, K) + a K (1 - K) x_K(1, K) with a = c / (1 - c).
    for (const Domain& d : closed_domains()) {
        const QuadComplex& k = d.complex;
        const SplineNetwork network = network_of(d, eck_hoppe);
        const SplineSurface s(network, random_unknowns(network, 6));
        for (Index h = 0; h < k.halfedge_count(); ++h) {
            const double c = fan_cosine(k.valence(k.from(h))), a = c / (1.0 - c);
            for (bool along_first : {true, false}) {
                const auto b = [&](Index i, Index j) {
                    return along_first ? local_bezier(s, h, i, j) : local_bezier(s, h, j, i);
                };
                for (double t : {0.0, 0.2, 0.5, 0.9, 1.0}) {
                    const Cubic value = bernstein(t), slope = bernstein_d(t);
                    Vec3 before, after, across;
                    for (Index j = 0; j < 4; ++j) {
                        before += 3.0 * value[j] * (b(3, j) - b(2, j));
                        after += 3.0 * value[j] * (b(4, j) - b(3, j));
                        across += slope[j] * b(3, j);
                    }
                    EXPECT_LE(
                        max_abs(before - (1 + a * (1 - t)) * after - a * t * (1 - t) * across),
                        2e-14)
                        << d.name;
                    if (t == 0.0 && c != 0.0) {
                        EXPECT_GT(max_abs(before - after), 1e-4) << d.name;
                    }
                }
            }
        }
    }
}

TEST(EckHoppe, middle_knot_is_c1)
{
    for (const Domain& d : closed_domains()) {
        const SplineNetwork network = network_of(d, eck_hoppe);
        const SplineSurface s(network, random_unknowns(network, 7));
        for (Index q = 0; q < s.patch_count(); ++q) {
            for (Index j = 0; j < 13; ++j) {
                EXPECT_LE(max_abs(s.bezier(q, 5, j) + s.bezier(q, 7, j) - 2.0 * s.bezier(q, 6, j)),
                          2e-15);
                EXPECT_LE(max_abs(s.bezier(q, j, 5) + s.bezier(q, j, 7) - 2.0 * s.bezier(q, j, 6)),
                          2e-15);
            }
        }
    }
}

TEST(EckHoppe, a_regular_domain_gives_the_surfaces_of_the_default_scheme)
{
    // Without extraordinary vertices both are the quadratic tensor spline.
    const Domain d = torus_grid(5, 4);
    const SplineNetwork a = network_of(d), b = network_of(d, eck_hoppe);
    EXPECT_EQ(a.unknown_count, b.unknown_count);
    const SplineSurface sa(a, bilinear_unknowns(a, d.positions));
    const SplineSurface sb(b, bilinear_unknowns(b, d.positions));
    for (std::size_t i = 0; i < sa.bezier().size(); ++i) {
        EXPECT_LE(max_abs(sa.bezier()[i] - sb.bezier()[i]), 1e-12);
    }
}

TEST(EckHoppe, boundaries_and_creases_are_refused_by_name)
{
    const Domain disk = disk_grid(2, 2);
    const Domain creased = with_features(cube(), "creased", {{4, 5}});
    for (const auto& [d, vertex] : {std::pair{disk, 0u}, std::pair{creased, 4u}}) {
        const auto built = build_spline_network(d.complex, eck_hoppe);
        ASSERT_FALSE(built.ok());
        EXPECT_EQ(built.error().code, ErrorCode::invalid_domain);
        EXPECT_EQ(built.error().element, vertex);
        EXPECT_NE(built.error().message.find("closed smooth"), std::string::npos);
    }
}

} // namespace
} // namespace bot2nurbs
