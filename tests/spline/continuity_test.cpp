// SPDX-License-Identifier: MIT
#include "network_fixtures.h"

namespace bot2nurbs {
namespace {

using namespace fixtures;

//! Angles of random nets: their normals may be short by chance, so some rounding is amplified.
constexpr double random_angle_deg = 1e-9;
//! What every real surface must reach.
constexpr double smooth_angle_deg = 1e-8;

std::vector<Domain> all_domains()
{
    std::vector<Domain> out = closed_domains();
    for (auto list : {open_domains(), feature_domains()}) {
        out.insert(out.end(), list.begin(), list.end());
    }
    return out;
}

//! Largest |det(x_u, left, right)| over the product of lengths, along one smooth edge, from the
//! derivatives of the two surfaces alone.
double worst_determinant(const QuadComplex& k, const SplineSurface& s, Index e)
{
    const Index h = k.halfedge_of_edge(e), g = k.twin(h);
    const auto at = [&](Index halfedge, double t) {
        const auto q = QuadComplex::quad_of(halfedge);
        switch (QuadComplex::side_of(halfedge)) {
        case 0: return s.evaluate({q, t, 0.0});
        case 1: return s.evaluate({q, 1.0, t});
        case 2: return s.evaluate({q, 1.0 - t, 1.0});
        default: return s.evaluate({q, 0.0, 1.0 - t});
        }
    };
    const auto along = [](Index halfedge, const SurfacePoint& p) {
        return QuadComplex::side_of(halfedge) % 2 == 0 ? p.du : p.dv;
    };
    const auto across = [](Index halfedge, const SurfacePoint& p) {
        return QuadComplex::side_of(halfedge) % 2 == 0 ? p.dv : p.du;
    };
    double worst = 0.0;
    for (int i = 0; i <= 50; ++i) {
        const double t = i / 50.0;
        const SurfacePoint l = at(h, t), r = at(g, 1.0 - t);
        EXPECT_LE(norm(l.position - r.position), 1e-14);
        const Vec3 a = along(h, l), b = across(h, l), c = across(g, r);
        worst = std::max(worst, std::fabs(dot(cross(a, b), c)) / (norm(a) * norm(b) * norm(c)));
    }
    return worst;
}

TEST(Continuity, random_nets_of_valence_3_to_10_have_one_tangent_plane_along_every_smooth_edge)
{
    for (const Domain& d : all_domains()) {
        for (const SplineNetwork& network : networks_of(d)) {
            for (std::uint64_t seed : {1u, 2u, 3u}) {
                const SplineSurface s(network, random_unknowns(network, seed));
                const Continuity c = measure_continuity(d.complex, s, 13);
                EXPECT_EQ(c.max_gap, 0.0) << d.name;
                EXPECT_LE(c.max_g1_angle_deg, random_angle_deg)
                    << d.name << " edge " << c.worst_edge;
                EXPECT_LE(c.max_inner_angle_deg, random_angle_deg) << d.name;
                EXPECT_EQ(c.undefined_normals, 0u) << d.name;
            }
        }
    }
}

TEST(Continuity, derivatives_of_both_sides_are_coplanar_along_every_smooth_edge)
{
    for (const Domain& d : all_domains()) {
        for (const SplineNetwork& network : networks_of(d)) {
            const SplineSurface s(network, random_unknowns(network, 4));
            for (Index e = 0; e < d.complex.edge_count(); ++e) {
                if (d.complex.is_sharp(e))
                    continue;
                EXPECT_LE(worst_determinant(d.complex, s, e), 2e-13) << d.name << " edge " << e;
            }
        }
    }
}

TEST(Continuity, cross_derivatives_obey_the_quadratic_law_at_both_ends_of_every_edge)
{
    // d_v P + d_u P' = 2 c (1 - t)^2 x' on the first piece, as Bezier coefficients; 0 on the
    // second.
    for (const Domain& d : closed_domains()) {
        const QuadComplex& k = d.complex;
        for (const SplineNetwork& network : networks_of(d)) {
            const SplineSurface s(network, random_unknowns(network, 5));
            for (Index h = 0; h < k.halfedge_count(); ++h) {
                const Index g = k.twin(h);
                const double c = fan_cosine(k.valence(k.from(h)));
                std::array<Vec3, 7> x, rest;
                for (Index j = 0; j < 7; ++j) {
                    x[j] = local_bezier(s, h, j, 0);
                    rest[j] = local_bezier(s, h, j, 1) + local_bezier(s, g, 12 - j, 1) - 2.0 * x[j];
                }
                const Vec3 q1 = 1.5 * x[1] - 0.5 * x[0], q2 = x[3];
                rest[0] -= 4.0 * c / 3.0 * (q1 - x[0]);
                rest[1] -= 4.0 * c / 9.0 * (q2 - q1);
                for (const Vec3& r : rest)
                    EXPECT_LE(max_abs(r), 4e-15) << d.name << " halfedge " << h;
            }
        }
    }
}

TEST(Continuity, patches_are_c1_across_their_inner_knots)
{
    for (const Domain& d : all_domains()) {
        for (const SplineNetwork& network : networks_of(d)) {
            EXPECT_TRUE(network.c1_inside);
            const SplineSurface s(network, random_unknowns(network, 6));
            for (Index q = 0; q < s.patch_count(); ++q) {
                for (Index k : {3u, 6u, 9u}) {
                    for (Index j = 0; j < 13; ++j) {
                        EXPECT_LE(max_abs(s.bezier(q, k - 1, j) + s.bezier(q, k + 1, j) -
                                          2.0 * s.bezier(q, k, j)),
                                  3e-15);
                        EXPECT_LE(max_abs(s.bezier(q, j, k - 1) + s.bezier(q, j, k + 1) -
                                          2.0 * s.bezier(q, j, k)),
                                  3e-15);
                    }
                }
            }
        }
    }
}

TEST(Continuity, tangent_plane_is_the_same_all_around_a_dart)
{
    for (const Domain& d : feature_domains()) {
        if (d.name.rfind("dart", 0) != 0)
            continue;
        for (const SplineNetwork& network : networks_of(d)) {
            const SplineSurface s(network, random_unknowns(network, 7));
            const Index n = d.complex.max_valence();
            const std::vector<Index> sectors = sectors_at(d.complex, n);
            const Vec3 p = local_bezier(s, sectors[0], 0, 0);
            Vec3 first;
            for (Index h : sectors) {
                const Vec3 normal =
                    normalized(cross(local_bezier(s, h, 1, 0) - p, local_bezier(s, h, 0, 1) - p));
                if (h == sectors[0])
                    first = normal;
                EXPECT_LE(norm(cross(first, normal)), 1e-12) << d.name;
            }
        }
    }
}

TEST(Continuity, a_crease_breaks_the_tangent_plane_and_is_not_measured_as_a_join)
{
    const Domain plain = split_bipyramid(5);
    const Domain creased = feature_domains()[4]; // smooth crease through a vertex of valence 5
    ASSERT_EQ(creased.name, "smooth_crease_5");
    const SplineNetwork network = network_of(creased);
    const SplineSurface s(network, random_unknowns(network, 8));
    EXPECT_EQ(measure_continuity(creased.complex, s).crease_edges, 2u);
    EXPECT_LE(measure_continuity(creased.complex, s).max_g1_angle_deg, random_angle_deg);
    // The same surface judged by a domain that wants smoothness everywhere.
    EXPECT_GT(measure_continuity(plain.complex, s).max_g1_angle_deg, 1.0);
    EXPECT_EQ(measure_continuity(plain.complex, s).max_gap, 0.0);
}

TEST(Continuity, joins_stay_exact_at_any_scale_and_far_from_the_origin)
{
    std::vector<Domain> domains{sphere_cube(2), torus_grid(9, 7), genus2()};
    for (Index n = 5; n <= 10; ++n)
        domains.push_back(refine(split_bipyramid(n)));
    for (const Domain& d : domains) {
        for (SplineScheme scheme :
             {SplineScheme::peters, SplineScheme::eck_hoppe, SplineScheme::full}) {
            const SplineNetwork network = network_of(d, scheme);
            Box3 box;
            for (const Vec3& p : d.positions)
                box.add(p);
            for (double scale : {1e-6, 1.0, 1e6}) {
                SplineSurface s(network, bilinear_unknowns(network, d.positions));
                const double offset = 10.0 * scale * box.diagonal();
                s.transform(scale, {offset, -offset, 0.7 * offset});
                const Continuity c = measure_continuity(d.complex, s);
                EXPECT_EQ(c.max_gap, 0.0) << d.name;
                EXPECT_LE(c.max_g1_angle_deg, smooth_angle_deg) << d.name << " scale " << scale;
                EXPECT_LE(c.max_inner_angle_deg, smooth_angle_deg) << d.name << " scale " << scale;
                EXPECT_EQ(c.undefined_normals, 0u) << d.name << " scale " << scale;
            }
        }
    }
}

TEST(Continuity, a_dropped_even_valence_constraint_shows_as_a_kink)
{
    for (SplineScheme scheme : {SplineScheme::peters, SplineScheme::eck_hoppe}) {
        for (Index n : {6u, 8u, 10u}) {
            const Domain d = split_bipyramid(n);
            const SplineNetwork network = network_of(d, scheme);
            const SplineSurface s(network, random_unknowns(network, 9, false));
            EXPECT_GT(measure_continuity(d.complex, s).max_g1_angle_deg, 0.1) << n;
        }
    }
}

//! Index of the weight of largest size in a stencil row.
std::size_t largest_entry(const SparseRows& rows, Index row)
{
    std::size_t best = rows.offset[row];
    for (std::size_t i = best; i < rows.offset[row + 1]; ++i) {
        if (std::fabs(rows.weight[i]) > std::fabs(rows.weight[best]))
            best = i;
    }
    return best;
}

TEST(Continuity, a_mask_with_one_weight_off_by_a_percent_shows_as_a_kink_at_its_vertex)
{
    for (SplineScheme scheme :
         {SplineScheme::peters, SplineScheme::eck_hoppe, SplineScheme::full}) {
        const Domain d = split_bipyramid(5);
        SplineNetwork network = network_of(d, scheme);
        const Index h = d.complex.halfedge_at(5);
        const auto [i, j] = from_side(QuadComplex::side_of(h), 1, 1, 12);
        const Index row = SplineNetwork::row(QuadComplex::quad_of(h), i, j);
        network.stencils.weight[largest_entry(network.stencils, row)] *= 1.01;
        const SplineSurface s(network, random_unknowns(network, 10));
        const Continuity c = measure_continuity(d.complex, s);
        EXPECT_GT(c.max_g1_angle_deg, 0.01);
        EXPECT_EQ(c.max_gap, 0.0);
        const Index worst = d.complex.halfedge_of_edge(c.worst_edge);
        EXPECT_TRUE(d.complex.from(worst) == 5 || d.complex.to(worst) == 5);
    }
}

TEST(Continuity, a_missing_twist_correction_shows_as_a_kink)
{
    // The plain quadratic spline with the same legs, which is what one gets by forgetting
    // section 3.
    const Domain d = split_bipyramid(5);
    const SplineNetwork network = network_of(d);
    SplineSurface s(network, random_unknowns(network, 11));
    for (Index h : sectors_at(d.complex, 5)) {
        const auto [i, j] = from_side(QuadComplex::side_of(h), 1, 1, 12);
        const Index q = QuadComplex::quad_of(h);
        // b11 of a raised quadratic follows from the other coefficients of its first two rows.
        const auto b = [&](Index a, Index c) { return local_bezier(s, h, a, c); };
        const Vec3 row0 = 1.5 * b(1, 0) - 0.5 * b(0, 0), row3 = 1.5 * b(1, 3) - 0.5 * b(0, 3);
        const Vec3 row2 = 1.5 * b(1, 2) - 0.5 * b(0, 2), middle = 1.5 * row2 - 0.5 * row3;
        s.bezier()[169 * q + 13 * i + j] =
            (b(0, 0) + 2.0 * row0 + 2.0 * (1.5 * b(0, 1) - 0.5 * b(0, 0)) + 4.0 * middle) / 9.0;
    }
    EXPECT_GT(measure_continuity(d.complex, s).max_g1_angle_deg, 0.01);
    EXPECT_EQ(measure_continuity(d.complex, s).max_gap, 0.0);
}

TEST(Continuity, a_border_that_differs_by_one_bit_shows_as_a_gap)
{
    const Domain d = cube();
    const SplineNetwork network = network_of(d);
    SplineSurface s(network, random_unknowns(network, 12));
    double& x = s.bezier()[13 * 6].x; // patch 0, coefficient (6, 0)
    x = std::nextafter(x, 10.0);
    EXPECT_GT(measure_continuity(d.complex, s).max_gap, 0.0);
    x = std::nan("");
    EXPECT_EQ(measure_continuity(d.complex, s).max_gap, INFINITY);
}

TEST(Continuity, collapsed_patches_are_counted_and_not_judged)
{
    const Domain d = cube();
    const SplineNetwork network = network_of(d);
    std::vector<Vec3> same(network.unknown_count);
    for (Index i = 0; i < network.unknown_count; ++i)
        same[i] = network.is_point[i] * Vec3{1, 2, 3};
    const Continuity c = measure_continuity(d.complex, SplineSurface(network, same), 5);
    EXPECT_EQ(c.max_g1_angle_deg, 0.0);
    EXPECT_EQ(c.undefined_normals, 12u * 4 * 5 + 6u * 6 * 4 * 5);
}

} // namespace
} // namespace bot2nurbs
