// SPDX-License-Identifier: MIT
#include "bot2nurbs/brep.h"

#include "brep/brep_fixtures.h"
#include "brep/bspline.h"

#include <gtest/gtest.h>

#include <set>

namespace bot2nurbs {
namespace {

using namespace fixtures;

constexpr std::array<KnotForm, 2> both_forms{KnotForm::paper, KnotForm::c1};

std::string rules(const std::vector<BrepDefect>& defects)
{
    std::string out;
    for (const BrepDefect& d : defects)
        out += d.rule + "(" + std::to_string(d.element) + ") ";
    return out;
}

TEST(AssembleBrep, closed_domains_become_valid_solids_of_their_genus)
{
    for (const Domain& d : closed_domains()) {
        for (KnotForm form : both_forms) {
            const Brep brep = brep_of(d, form);
            const BrepReport report = check_brep(brep);
            EXPECT_TRUE(report.valid) << d.name << " " << rules(report.defects);
            EXPECT_TRUE(report.solid) << d.name;
            EXPECT_TRUE(brep.solid);
            EXPECT_EQ(report.max_edge_gap, 0.0);
            EXPECT_EQ(report.boundary_edges, 0u);
            EXPECT_EQ(report.components, 1u);
            EXPECT_EQ(report.euler_characteristic, d.complex.euler_characteristic());
            EXPECT_EQ(report.genus(), 1 - d.complex.euler_characteristic() / 2);
            EXPECT_GT(report.volume, 0.0);
            EXPECT_EQ(brep.faces.size(), d.complex.quad_count());
            EXPECT_EQ(brep.edges.size(), d.complex.edge_count());
            EXPECT_EQ(brep.vertices.size(), d.complex.vertex_count());
            EXPECT_EQ(brep.trims.size(), 4 * d.complex.quad_count());
        }
    }
}

TEST(AssembleBrep, open_domains_have_boundary_trims_and_are_not_solid)
{
    for (const Domain& d : open_domains()) {
        for (KnotForm form : both_forms) {
            const Brep brep = brep_of(d, form);
            const BrepReport report = check_brep(brep);
            EXPECT_TRUE(report.valid) << d.name << " " << rules(report.defects);
            EXPECT_FALSE(report.solid);
            EXPECT_FALSE(brep.solid);
            EXPECT_EQ(report.volume, 0.0);
            EXPECT_EQ(report.boundary_edges, d.complex.boundary_edge_count());
            for (const BrepTrim& t : brep.trims) {
                EXPECT_EQ(t.type == TrimType::boundary, d.complex.is_boundary_edge(t.edge));
            }
        }
    }
}

TEST(AssembleBrep, curves_have_the_control_points_and_knots_of_the_form)
{
    for (KnotForm form : both_forms) {
        const Brep brep = sphere_brep(1, form);
        const std::size_t count = form == KnotForm::paper ? 12 : 10;
        for (const BrepCurve3& c : brep.curves3) {
            EXPECT_EQ(c.control.size(), count);
            EXPECT_EQ(c.knots, brep.surfaces[0].knots);
        }
        for (const BsplinePatch& s : brep.surfaces)
            EXPECT_EQ(s.control.size(), count * count);
        for (const BrepEdge& e : brep.edges) {
            EXPECT_EQ(e.t0, 0.0);
            EXPECT_EQ(e.t1, 4.0);
        }
    }
}

TEST(AssembleBrep, trims_of_an_edge_run_in_opposite_directions_along_the_same_points)
{
    const Brep brep = brep_of(genus2(), KnotForm::c1);
    for (const BrepEdge& edge : brep.edges) {
        ASSERT_EQ(edge.trims.size(), 2u);
        EXPECT_NE(brep.trims[edge.trims[0]].reversed, brep.trims[edge.trims[1]].reversed);
        const BrepCurve3& curve = brep.curves3[edge.curve];
        for (Index t : edge.trims) {
            const BrepTrim& trim = brep.trims[t];
            const BrepCurve2& line = brep.curves2[trim.curve];
            const BsplinePatch& patch = brep.surfaces[brep.loops[trim.loop].face];
            for (double s : {0.0, 0.1, 0.5, 0.77, 1.0}) {
                const Vec2 uv = line.a + s * (line.b - line.a);
                const double on_edge = trim.reversed ? 1.0 - s : s;
                EXPECT_LT(norm(evaluate_patch(patch, uv.x, uv.y).position -
                               evaluate_curve(curve, 4.0 * on_edge)),
                          1e-13);
            }
        }
    }
}

//! The domain with the first corner of every quad moved on by a number that depends on the quad.
Domain rotated_corners(const Domain& d)
{
    Quads quads = d.complex.quads();
    for (Index q = 0; q < quads.size(); ++q)
        std::rotate(quads[q].begin(), quads[q].begin() + (q * 7 + q / 3) % 4, quads[q].end());
    return make_domain(d.name + "_rotated", d.positions, quads);
}

TEST(AssembleBrep, every_pair_of_sides_can_be_neighbours)
{
    const Domain d = rotated_corners(sphere_cube(2));
    std::set<std::pair<Index, Index>> met;
    for (Index h = 0; h < d.complex.halfedge_count(); ++h)
        met.insert({QuadComplex::side_of(h), QuadComplex::side_of(d.complex.twin(h))});
    ASSERT_EQ(met.size(), 16u) << "the test does not cover all pairs";
    for (KnotForm form : both_forms) {
        const Brep brep = brep_of(d, form, to_unit_sphere);
        const BrepReport report = check_brep(brep), plain = check_brep(sphere_brep(2, form));
        EXPECT_TRUE(report.solid) << rules(report.defects);
        EXPECT_EQ(report.max_edge_gap, 0.0);
        EXPECT_NEAR(report.volume, plain.volume, 1e-10);
    }
}

TEST(AssembleBrep, two_quads_can_share_all_four_edges)
{
    // A pillow: two squares with a common border, one bulging up, one down.
    Result<QuadComplex> complex = QuadComplex::build(4, {{0, 1, 2, 3}, {0, 3, 2, 1}});
    ASSERT_TRUE(complex.ok());
    const auto inner = [](Index i) { return i > 0 && i < 12; };
    const SplineSurface surface = surface_of_points(2, [&](Index q, Index i, Index j) {
        const double bulge = inner(i) && inner(j) ? 3.0 : 0.0;
        return q == 0 ? Vec3{double(i), double(j), bulge} : Vec3{double(j), double(i), -bulge};
    });
    const Brep brep = must_assemble(*complex, surface, KnotForm::paper);
    const BrepReport report = check_brep(brep);
    EXPECT_TRUE(report.solid) << rules(report.defects);
    EXPECT_EQ(report.euler_characteristic, 2);
    EXPECT_EQ(report.max_edge_gap, 0.0);
    for (const BrepTrim& t : brep.trims)
        EXPECT_EQ(t.type, TrimType::mated);
}

TEST(AssembleBrep, two_quads_can_share_two_edges)
{
    // Two quads over the disk of four edges 0-1-2-3 with the vertex 4 inside: (0 1 4 3), (1 2 3 4)
    // share the edges 1-4 and 4-3.
    Result<QuadComplex> complex = QuadComplex::build(5, {{0, 1, 4, 3}, {1, 2, 3, 4}, {0, 3, 2, 1}});
    ASSERT_TRUE(complex.ok()) << complex.error().message;
    // Corners on the square with vertex 4 a quarter of the way along the diagonal from 0 to 2.
    const Vec3 corner[5] = {{0, 0, 0}, {24, 0, 0}, {24, 24, 0}, {0, 24, 0}, {12, 12, 12}};
    const auto bilinear = [&](Index q, Index i, Index j) {
        const auto& c = complex->quad(q);
        // In twelfths of the corners, so that shared sides come out the same to the bit.
        const auto sum = [&](int k) {
            const double a = corner[c[0]][k] / 12, b = corner[c[1]][k] / 12,
                         e = corner[c[2]][k] / 12, f = corner[c[3]][k] / 12;
            const double w = i * (12.0 - j), x = double(i) * j, y = (12.0 - i) * j,
                         z = (12.0 - i) * (12.0 - j);
            return (a * z + b * w + e * x + f * y) / 12;
        };
        return Vec3{sum(0), sum(1), sum(2)};
    };
    const Brep brep = must_assemble(*complex, surface_of_points(3, bilinear), KnotForm::c1);
    const BrepReport report = check_brep(brep);
    EXPECT_TRUE(report.solid) << rules(report.defects);
    EXPECT_EQ(brep.vertices[4].edges.size(), 2u);
    EXPECT_EQ(report.max_edge_gap, 0.0);
}

TEST(AssembleBrep, inward_domains_are_turned_by_reversing_all_faces)
{
    const Domain outward = sphere_cube(1);
    Quads quads = outward.complex.quads();
    for (auto& q : quads)
        std::reverse(q.begin(), q.end());
    const Domain inward = make_domain("inward", outward.positions, quads);
    const Brep brep = brep_of(inward, KnotForm::c1, to_unit_sphere);
    const BrepReport report = check_brep(brep);
    EXPECT_TRUE(report.solid) << rules(report.defects);
    EXPECT_NEAR(report.volume, check_brep(sphere_brep(1, KnotForm::c1)).volume, 1e-12);
    for (const BrepFace& f : brep.faces)
        EXPECT_TRUE(f.reversed);
}

TEST(AssembleBrep, works_at_every_scale_and_far_from_the_origin)
{
    const Domain d = sphere_cube(1);
    const SplineSurface unit = network_surface(d, to_unit_sphere);
    for (double scale : {1e-6, 1.0, 1e6}) {
        for (double offset : {0.0, 100.0}) {
            SplineSurface surface = unit;
            surface.transform(scale, {offset * scale, -offset * scale, 0.0});
            const BrepReport report =
                check_brep(must_assemble(d.complex, surface, KnotForm::paper));
            EXPECT_TRUE(report.solid) << scale << " " << offset << " " << rules(report.defects);
            EXPECT_EQ(report.max_edge_gap, 0.0);
        }
    }
}

TEST(AssembleBrep, patches_that_disagree_on_a_side_are_refused)
{
    const Domain d = sphere_cube(0);
    SplineSurface surface = network_surface(d, to_unit_sphere);
    // One ulp on one control point inside a side.
    Vec3& p = surface.bezier()[SplineNetwork::row(2, 4, 0)];
    p.x = std::nextafter(p.x, 10.0);
    const Result<Brep> brep = assemble_brep(d.complex, surface, KnotForm::paper);
    ASSERT_FALSE(brep.ok());
    EXPECT_EQ(brep.error().code, ErrorCode::brep_failed);
    EXPECT_EQ(brep.error().element, d.complex.edge(4 * 2 + 0));
}

TEST(AssembleBrep, a_surface_of_another_domain_is_refused)
{
    const SplineSurface surface = network_surface(sphere_cube(0), to_unit_sphere);
    const Result<Brep> brep = assemble_brep(sphere_cube(1).complex, surface, KnotForm::c1);
    ASSERT_FALSE(brep.ok());
    EXPECT_EQ(brep.error().code, ErrorCode::bad_option);
}

TEST(AssembleBrep, a_surface_that_is_not_finite_is_refused)
{
    const Domain d = sphere_cube(0);
    SplineSurface surface = network_surface(d, to_unit_sphere);
    surface.bezier()[SplineNetwork::row(3, 4, 4)].y = NAN;
    const Result<Brep> brep = assemble_brep(d.complex, surface, KnotForm::c1);
    ASSERT_FALSE(brep.ok());
    EXPECT_EQ(brep.error().code, ErrorCode::brep_failed);
    EXPECT_EQ(brep.error().element, 3u);
}

} // namespace
} // namespace bot2nurbs
