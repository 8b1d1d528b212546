// SPDX-License-Identifier: MIT
// Every rule of check_brep: a B-Rep that breaks this rule and no other, and the one complaint.
#include "bot2nurbs/brep.h"

#include "brep/brep_fixtures.h"

#include <gtest/gtest.h>

#include <set>

namespace bot2nurbs {
namespace {

using namespace fixtures;

std::set<std::string> names(const std::vector<BrepDefect>& defects)
{
    std::set<std::string> out;
    for (const BrepDefect& d : defects)
        out.insert(d.rule);
    return out;
}

struct Breakage {
    const char* rule;
    Index element; //!< Of the first defect.
    std::function<void(Brep&)> apply;
};

void PrintTo(const Breakage& b, std::ostream* out)
{
    *out << b.rule;
}

const Brep& sphere()
{
    static const Brep brep = sphere_brep(1, KnotForm::c1);
    return brep;
}

//! Exchanges the direction of a loop without a change to the faces' common edges.
void turn_loop(Brep& b, Index l)
{
    std::vector<Index>& trims = b.loops[l].trims;
    std::reverse(trims.begin(), trims.end());
    for (Index t : trims) {
        BrepTrim& trim = b.trims[t];
        std::swap(b.curves2[trim.curve].a, b.curves2[trim.curve].b);
        std::swap(trim.vertex[0], trim.vertex[1]);
        trim.reversed = !trim.reversed;
    }
    b.faces[b.loops[l].face].reversed = !b.faces[b.loops[l].face].reversed;
}

//! Adds a second face on the edges of face 0, with a surface of its own.
void add_fin(Brep& b)
{
    const Index f = static_cast<Index>(b.faces.size()), l = static_cast<Index>(b.loops.size()),
                s = static_cast<Index>(b.surfaces.size());
    BrepLoop loop = b.loops[0];
    loop.face = f;
    for (Index& t : loop.trims) {
        BrepTrim trim = b.trims[t];
        t = static_cast<Index>(b.trims.size());
        trim.loop = l;
        b.edges[trim.edge].trims.push_back(t);
        b.trims.push_back(trim);
    }
    BsplinePatch surface = b.surfaces[0];
    for (Index i = 1; i + 1 < surface.size; ++i) {
        for (Index j = 1; j + 1 < surface.size; ++j)
            surface.control[i * surface.size + j] *= 1.5;
    }
    b.surfaces.push_back(surface);
    b.loops.push_back(loop);
    b.faces.push_back({{l}, s, false});
    b.solid = false;
}

//! Adds the point reflection of the B-Rep at vertex 0, the two joined in that vertex alone.
void add_mirror_at_vertex(Brep& b)
{
    Brep mirror = b;
    transform(mirror, -1.0, 2.0 * b.vertices[0].point);
    for (BrepFace& f : mirror.faces)
        f.reversed = !f.reversed;
    const Index v = static_cast<Index>(b.vertices.size());
    append(b, mirror);
    b.vertices[0].edges.insert(b.vertices[0].edges.end(), b.vertices[v].edges.begin(),
                               b.vertices[v].edges.end());
    b.vertices.erase(b.vertices.begin() + v);
    const auto renumber = [&](Index& i) { i = i == v ? 0 : i > v ? i - 1 : i; };
    for (BrepEdge& e : b.edges) {
        renumber(e.vertex[0]);
        renumber(e.vertex[1]);
    }
    for (BrepTrim& t : b.trims) {
        renumber(t.vertex[0]);
        renumber(t.vertex[1]);
    }
}

//! Draws all of edge 0 into one point.
void collapse_edge(Brep& b)
{
    const Index e = 0, keep = b.edges[e].vertex[0], drop = b.edges[e].vertex[1];
    // All that touches the second vertex moves to the first: curve ends, patch corners and sides.
    const Vec3 from = b.vertices[drop].point, to = b.vertices[keep].point;
    std::vector<Vec3> old = b.curves3[b.edges[e].curve].control;
    const auto move = [&](Vec3& p) {
        if (p == from || std::find(old.begin(), old.end(), p) != old.end())
            p = to;
    };
    for (BsplinePatch& s : b.surfaces)
        std::for_each(s.control.begin(), s.control.end(), move);
    for (BrepCurve3& c : b.curves3)
        std::for_each(c.control.begin(), c.control.end(), move);
    b.vertices[drop].point = to;
}

std::string rule_name(const testing::TestParamInfo<Breakage>& test)
{
    return test.param.rule;
}

class CheckBrepRule : public testing::TestWithParam<Breakage> {};

TEST_P(CheckBrepRule, is_the_only_complaint_about_a_sphere_that_breaks_it)
{
    Brep brep = sphere();
    ASSERT_TRUE(check_brep(brep).solid);
    GetParam().apply(brep);
    const BrepReport report = check_brep(brep);
    EXPECT_EQ(names(report.defects), std::set<std::string>{GetParam().rule});
    ASSERT_FALSE(report.defects.empty());
    EXPECT_EQ(report.defects.front().element, GetParam().element) << report.defects.front().message;
    EXPECT_FALSE(report.defects.front().message.empty());
    EXPECT_FALSE(report.valid);
    EXPECT_FALSE(report.solid);
}

constexpr Index far = 1000000;

INSTANTIATE_TEST_SUITE_P(
    Ranges, CheckBrepRule,
    testing::Values(Breakage{"vertex_edge_range", 3, [](Brep& b) { b.vertices[3].edges[0] = far; }},
                    Breakage{"edge_curve_range", 4, [](Brep& b) { b.edges[4].curve = far; }},
                    Breakage{"edge_vertex_range", 5, [](Brep& b) { b.edges[5].vertex[1] = far; }},
                    Breakage{"edge_trim_range", 6, [](Brep& b) { b.edges[6].trims[1] = far; }},
                    Breakage{"trim_curve_range", 7, [](Brep& b) { b.trims[7].curve = far; }},
                    Breakage{"trim_edge_range", 8, [](Brep& b) { b.trims[8].edge = far; }},
                    Breakage{"trim_vertex_range", 9, [](Brep& b) { b.trims[9].vertex[0] = far; }},
                    Breakage{"trim_loop_range", 10, [](Brep& b) { b.trims[10].loop = far; }},
                    Breakage{"loop_trim_range", 11, [](Brep& b) { b.loops[11].trims[3] = far; }},
                    Breakage{"loop_face_range", 12, [](Brep& b) { b.loops[12].face = far; }},
                    Breakage{"face_loop_range", 13, [](Brep& b) { b.faces[13].loops[0] = far; }},
                    Breakage{"face_surface_range", 14, [](Brep& b) { b.faces[14].surface = far; }}),
    rule_name);

INSTANTIATE_TEST_SUITE_P(
    Splines, CheckBrepRule,
    testing::Values(Breakage{"curve_knots", 2, [](Brep& b) { b.curves3[2].knots[5] = 0.5; }},
                    Breakage{"curve_finite", 3, [](Brep& b) { b.curves3[3].control[4].z = NAN; }},
                    Breakage{"surface_knots", 4, [](Brep& b) { b.surfaces[4].knots.pop_back(); }},
                    Breakage{"surface_finite", 5,
                             [](Brep& b) { b.surfaces[5].control[7].x = INFINITY; }},
                    Breakage{"vertex_finite", 6, [](Brep& b) { b.vertices[6].point.y = NAN; }}),
    rule_name);

INSTANTIATE_TEST_SUITE_P(
    Lists, CheckBrepRule,
    testing::Values(Breakage{"no_faces", invalid_index, [](Brep& b) { b = {}; }},
                    Breakage{"vertex_edge_list", 2,
                             [](Brep& b) { b.vertices[2].edges.pop_back(); }},
                    Breakage{"edge_trim_list", 3, [](Brep& b) { b.edges[3].trims.pop_back(); }},
                    Breakage{"loop_trim_list", 4, [](Brep& b) { b.loops[4].trims.pop_back(); }},
                    Breakage{"face_loop_list", 5,
                             [](Brep& b) { std::swap(b.faces[5].loops, b.faces[6].loops); }},
                    Breakage{"vertex_unused", 26,
                             [](Brep& b) {
                                 b.vertices.push_back({{0.1, 0.2, 0.3}, {}});
                             }},
                    Breakage{"edge_unused", 48,
                             [](Brep& b) {
                                 BrepEdge edge = b.edges[0];
                                 edge.trims.clear();
                                 for (Index v : edge.vertex)
                                     b.vertices[v].edges.push_back(48);
                                 b.edges.push_back(edge);
                             }},
                    Breakage{"loop_empty", 24,
                             [](Brep& b) {
                                 b.loops.push_back({{}, 24});
                                 b.faces.push_back({{24}, 0, false});
                             }},
                    Breakage{"face_one_loop", 24,
                             [](Brep& b) {
                                 b.faces.push_back({{}, 0, false});
                             }}),
    rule_name);

INSTANTIATE_TEST_SUITE_P(
    Topology, CheckBrepRule,
    testing::Values(Breakage{"trim_type", 7, [](Brep& b) { b.trims[7].type = TrimType::boundary; }},
                    Breakage{
                        "trim_vertices", 8,
                        [](Brep& b) { std::swap(b.trims[8].vertex[0], b.trims[8].vertex[1]); }},
                    Breakage{"nonmanifold_edge", 0, add_fin},
                    Breakage{"mated_orientation", 0, [](Brep& b) { b.faces[0].reversed = true; }},
                    Breakage{"nonmanifold_vertex", 0, add_mirror_at_vertex}),
    rule_name);

INSTANTIATE_TEST_SUITE_P(
    Geometry, CheckBrepRule,
    testing::Values(Breakage{"edge_domain", 2, [](Brep& b) { b.edges[2].t1 = 5.0; }},
                    Breakage{"trim_domain", 3, [](Brep& b) { b.trims[3].t1 = b.trims[3].t0; }},
                    Breakage{"zero_length_trim", 4,
                             [](Brep& b) { b.curves2[4].b = b.curves2[4].a; }},
                    Breakage{"trim_outside_surface", 4,
                             [](Brep& b) {
                                 b.curves2[4].b.x = 4.5;
                                 b.curves2[5].a.x = 4.5;
                             }},
                    Breakage{"trim_iso", 5, [](Brep& b) { b.trims[5].iso = TrimIso::west; }},
                    Breakage{"loop_not_closed", 2, [](Brep& b) { b.curves2[8].b.x = 3.5; }},
                    Breakage{"loop_orientation", 3, [](Brep& b) { turn_loop(b, 3); }},
                    Breakage{"vertex_off_edge", 4, [](Brep& b) { b.vertices[4].point.x += 1e-9; }},
                    Breakage{"edge_off_surface", 0,
                             [](Brep& b) { b.curves3[b.trims[0].edge].control[4].y += 1e-6; }},
                    Breakage{"zero_length_edge", 0, collapse_edge},
                    Breakage{"inside_out", invalid_index,
                             [](Brep& b) {
                                 for (BrepFace& f : b.faces)
                                     f.reversed = true;
                             }}),
    rule_name);

TEST(CheckBrep, a_face_without_area_is_degenerate)
{
    const Brep brep = one_face([](Index, Index i, Index j) {
        return Vec3{i + 1.375 * j, 0.0, 0.0};
    });
    const BrepReport report = check_brep(brep);
    EXPECT_EQ(names(report.defects), std::set<std::string>{"degenerate_face"});
    EXPECT_EQ(report.defects.front().element, 0u);
}

TEST(CheckBrep, vertices_at_one_place_are_duplicates)
{
    // A sheet rolled up until two opposite corners meet.
    const Brep brep = one_face([](Index, Index i, Index j) {
        const double a = M_PI / 12 * (i + j);
        const bool last = i == 12 && j == 12;
        return last ? Vec3{1, 0, 0} : Vec3{std::cos(a), std::sin(a), (double(i) - double(j)) / 12};
    });
    const BrepReport report = check_brep(brep);
    EXPECT_EQ(names(report.defects), std::set<std::string>{"duplicate_vertices"});
}

TEST(CheckBrep, an_open_brep_that_is_called_solid_is_refused)
{
    Brep brep = brep_of(disk_grid(2, 2), KnotForm::c1);
    ASSERT_TRUE(check_brep(brep).valid);
    brep.solid = true;
    const BrepReport report = check_brep(brep);
    EXPECT_EQ(names(report.defects), std::set<std::string>{"solid_flag"});
    EXPECT_EQ(report.boundary_edges, 8u);
}

TEST(CheckBrep, a_gap_is_measured_where_control_points_differ)
{
    Brep brep = sphere();
    BrepCurve3& curve = brep.curves3[5];
    const Vec3 old = curve.control[4];
    curve.control[4] += Vec3{0, 0, 1e-3};
    // The basis function of control point 4 has its largest value below one.
    const double gap = check_brep(brep).max_edge_gap;
    EXPECT_GT(gap, 4e-4);
    EXPECT_LT(gap, 1e-3);
    curve.control[4] = old;
    EXPECT_EQ(check_brep(brep).max_edge_gap, 0.0);
}

TEST(CheckBrep, an_edge_with_other_knots_but_the_same_points_has_no_gap)
{
    // The paper's form of the same sphere has the same curves with more knots.
    Brep brep = sphere();
    brep.curves3 = sphere_brep(1, KnotForm::paper).curves3;
    const BrepReport report = check_brep(brep);
    EXPECT_TRUE(report.solid);
    EXPECT_LT(report.max_edge_gap, 1e-14);
}

TEST(CheckBrep, thin_faces_are_warned_about)
{
    const Brep brep = one_face([](Index, Index i, Index j) {
        return Vec3{double(i), j * 2e-6, 0.0};
    });
    const BrepReport report = check_brep(brep);
    EXPECT_TRUE(report.valid);
    EXPECT_EQ(names(report.warnings), std::set<std::string>{"face_aspect_ratio"});
}

TEST(CheckBrep, overlapping_parts_are_warned_about)
{
    Brep brep = sphere(), other = sphere();
    transform(other, 0.95, {0.01, 0.02, 0.03});
    append(brep, other);
    const BrepReport report = check_brep(brep);
    EXPECT_TRUE(report.valid);
    EXPECT_EQ(report.components, 2u);
    EXPECT_EQ(report.genus(), 0);
    EXPECT_EQ(names(report.warnings), std::set<std::string>{"possible_self_intersection"});
    EXPECT_TRUE(check_brep(sphere()).warnings.empty());
}

TEST(CheckBrep, a_face_that_meets_itself_has_a_seam)
{
    Brep brep = seam_tube();
    const BrepReport report = check_brep(brep);
    EXPECT_TRUE(report.valid) << (report.valid ? "" : report.defects.front().message);
    EXPECT_EQ(report.boundary_edges, 2u);
    EXPECT_EQ(report.max_edge_gap, 0.0);
    EXPECT_EQ(names(report.warnings), std::set<std::string>{"closed_edge"});
    brep.trims[1].type = TrimType::mated;
    EXPECT_EQ(names(check_brep(brep).defects), std::set<std::string>{"trim_type"});
}

} // namespace
} // namespace bot2nurbs
