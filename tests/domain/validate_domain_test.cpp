// SPDX-License-Identifier: MIT
#include "bot2nurbs/validate_domain.h"

#include "hand_domains.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <map>
#include <set>

namespace bot2nurbs::test {
namespace {

using Rules = std::set<std::string>;

DomainValidation validated(const HandDomain& hand, const ValidateOptions& options = {})
{
    Context context;
    auto validation = validate_domain(hand.mesh, hand.domain, context, options);
    EXPECT_TRUE(validation.ok());
    return validation.ok() ? *validation : DomainValidation{};
}

Rules rules(const std::vector<DomainDefect>& defects)
{
    Rules result;
    for (const DomainDefect& d : defects) {
        EXPECT_FALSE(d.message.empty());
        result.insert(d.rule);
    }
    return result;
}

Rules broken_rules(const HandDomain& hand, const ValidateOptions& options = {})
{
    return rules(validated(hand, options).defects);
}

using Paths = std::map<std::pair<Index, Index>, std::vector<PathPoint>>;

std::vector<PathPoint> reversed(std::vector<PathPoint> path)
{
    std::reverse(path.begin(), path.end());
    return path;
}

//! The domain with other quads over the same vertices: paths are taken from the old edges and from
//! `more`, by their ends.
void set_quads(QuadDomain& domain, const std::vector<std::array<Index, 4>>& quads,
               const Paths& more = {}, const std::vector<std::pair<Index, Index>>& creases = {})
{
    Paths paths = more;
    for (const DomainEdge& edge : domain.edges)
        paths[{edge.a, edge.b}] = edge.path;
    auto complex = QuadComplex::build(static_cast<Index>(domain.vertices.size()), quads, creases);
    ASSERT_TRUE(complex.ok()) << complex.error().message;
    domain.complex = *complex;
    domain.edges.clear();
    for (Index e = 0; e < complex->edge_count(); ++e) {
        const Index a = complex->from(complex->halfedge_of_edge(e));
        const Index b = complex->to(complex->halfedge_of_edge(e));
        DomainEdge edge{a, b, {}, complex->is_crease(e)};
        if (paths.count({a, b}))
            edge.path = paths.at({a, b});
        else
            edge.path = reversed(paths.at({b, a}));
        domain.edges.push_back(edge);
    }
}

void set_mesh(HandDomain& hand, const std::vector<Vec3>& positions,
              const std::vector<std::array<Index, 3>>& triangles)
{
    auto mesh = ManifoldMesh::build(positions, triangles);
    ASSERT_TRUE(mesh.ok()) << mesh.error().message;
    hand.mesh = *mesh;
    hand.domain.carrier = CarrierMesh::from_source(hand.mesh);
    hand.domain.source_signature = signature(hand.mesh);
    hand.charts.clear();
}

//! The first crossing of any path: its edge and place in the path.
std::pair<std::size_t, std::size_t> first_crossing(const QuadDomain& domain)
{
    for (std::size_t e = 0; e < domain.edges.size(); ++e)
        for (std::size_t i = 0; i < domain.edges[e].path.size(); ++i)
            if (!domain.edges[e].path[i].is_vertex())
                return {e, i};
    return {};
}

TEST(ValidateDomain, accepts_every_hand_made_domain_with_its_charts)
{
    for (const HandDomain& hand :
         {sphere_cube(0, 8), sphere_cube(2, 8), torus_grid(), torus_askew(2, 2), torus_askew(3, 1),
          genus2_voxels(), open_cylinder(), with_refined_carrier(sphere_cube(1, 8)),
          with_refined_carrier(torus_askew(2, 2))}) {
        const DomainValidation v = validated(hand);
        for (const DomainDefect& d : v.defects)
            ADD_FAILURE() << d.rule << ": " << d.message;
        EXPECT_TRUE(v.valid());
        EXPECT_EQ(v.quads, hand.domain.complex.quad_count());
        EXPECT_EQ(v.vertices, hand.domain.complex.vertex_count());
        EXPECT_EQ(v.edges, hand.domain.complex.edge_count());
        EXPECT_EQ(v.euler_characteristic, hand.domain.complex.euler_characteristic());
        EXPECT_GT(v.charts.min_jacobian, 0.0);
        EXPECT_LE(v.charts.min_jacobian, 1.0);
        EXPECT_GE(v.charts.max_jacobian, 1.0);
        EXPECT_GE(v.charts.mean_stretch, 1.0);
        EXPECT_GE(v.charts.max_stretch, v.charts.mean_stretch);
        EXPECT_LT(v.charts.worst_quad, v.quads);
    }
}

TEST(ValidateDomain, counts_loops_valences_and_distortion)
{
    DomainValidation v = validated(open_cylinder(5, 2));
    EXPECT_EQ(v.boundary_loops, 2u);
    EXPECT_EQ(v.euler_characteristic, 0);
    v = validated(genus2_voxels());
    EXPECT_EQ(v.boundary_loops, 0u);
    EXPECT_EQ(v.euler_characteristic, -2);
    EXPECT_EQ(v.max_valence, 5u);
    EXPECT_EQ(v.extraordinary, 24u);
    // A face of the cube on the sphere is nearly a square: equal areas, corners of 120 degrees.
    v = validated(sphere_cube(0, 16));
    EXPECT_NEAR(v.charts.max_area, v.charts.min_area, 1e-12);
    EXPECT_NEAR(v.charts.max_area, 4 * M_PI / 6, 0.02 * 4 * M_PI / 6);
    EXPECT_LT(v.charts.max_stretch, 1.5);
}

TEST(ValidateDomain, rule_signature)
{
    HandDomain hand = sphere_cube(0, 4);
    hand.domain.source_signature = "0123456789abcdef";
    EXPECT_EQ(broken_rules(hand), Rules{"signature"});
}

TEST(ValidateDomain, rule_index)
{
    HandDomain hand = sphere_cube(0, 4);
    hand.domain.vertices.pop_back();
    EXPECT_EQ(broken_rules(hand), Rules{"index"});
    hand = sphere_cube(0, 4);
    hand.domain.edges[3].path[0].to = 1u << 20;
    EXPECT_EQ(broken_rules(hand), Rules{"index"});
    EXPECT_EQ(validated(hand).defects[0].element, 3u);
    hand = sphere_cube(0, 4);
    hand.domain.carrier.face_source[7] = invalid_index;
    EXPECT_EQ(broken_rules(hand), Rules{"index"});
    hand = sphere_cube(0, 4);
    hand.domain = {};
    EXPECT_EQ(broken_rules(hand), (Rules{"index", "signature"}));
}

TEST(ValidateDomain, rule_edge_ends)
{
    HandDomain hand = sphere_cube(0, 4);
    DomainEdge& edge = hand.domain.edges[5];
    std::swap(edge.a, edge.b);
    edge.path = reversed(edge.path);
    const DomainValidation v = validated(hand);
    EXPECT_EQ(rules(v.defects), Rules{"edge_ends"});
    EXPECT_EQ(v.defects[0].element, 5u);
}

TEST(ValidateDomain, rule_crease)
{
    HandDomain hand = sphere_cube(0, 4);
    hand.domain.edges[2].crease = true;
    EXPECT_EQ(broken_rules(hand), Rules{"crease"});
}

TEST(ValidateDomain, rule_vertex_distinct)
{
    HandDomain hand = sphere_cube(0, 4);
    hand.domain.vertices[6] = hand.domain.vertices[1];
    EXPECT_EQ(broken_rules(hand), Rules{"vertex_distinct"});
    EXPECT_EQ(validated(hand).defects[0].element, 6u);
}

TEST(ValidateDomain, rule_valence_two_quads_around_an_inner_vertex)
{
    HandDomain hand = sphere_cube(0, 4);
    QuadDomain& domain = hand.domain;
    // Quad 0 is cut in two from corner 0 to corner 2, over the mesh edges of its diagonal.
    const auto [a, b, c, d] = domain.complex.quad(0);
    const auto grid = [&](int i, int j) { // Mesh vertex at a cell corner of coarse quad 0.
        return hand.mesh.triangle(static_cast<Index>(2 * (4 * j + i)))[0];
    };
    const Index m = static_cast<Index>(domain.vertices.size());
    domain.vertices.push_back(grid(2, 2));
    auto quads = domain.complex.quads();
    quads[0] = {a, b, c, m};
    quads.push_back({a, m, c, d});
    set_quads(domain, quads,
              {{{a, m}, {{grid(1, 1), grid(1, 1), 0}}}, {{m, c}, {{grid(3, 3), grid(3, 3), 0}}}});
    const DomainValidation v = validated(hand);
    EXPECT_EQ(rules(v.defects), Rules{"valence"});
    EXPECT_EQ(v.defects[0].element, m);
}

TEST(ValidateDomain, of_two_quads_between_two_creases_breaks_no_rule)
{
    HandDomain hand = sphere_cube(0, 4);
    const auto [a, b, c, d] = hand.domain.complex.quad(0);
    const auto grid = [&](int i, int j) {
        return hand.mesh.triangle(static_cast<Index>(2 * (4 * j + i)))[0];
    };
    const Index m = static_cast<Index>(hand.domain.vertices.size());
    hand.domain.vertices.push_back(grid(2, 2));
    auto quads = hand.domain.complex.quads();
    quads[0] = {a, b, c, m};
    quads.push_back({a, m, c, d});
    set_quads(hand.domain, quads,
              {{{a, m}, {{grid(1, 1), grid(1, 1), 0}}}, {{m, c}, {{grid(3, 3), grid(3, 3), 0}}}},
              {{a, m}, {m, c}});
    EXPECT_EQ(rules(validated(hand).defects), Rules{});
}

TEST(ValidateDomain, rule_valence_above_the_limit)
{
    ValidateOptions options;
    options.max_valence = 4;
    EXPECT_EQ(broken_rules(sphere_cube(0, 4), options), Rules{});
    const DomainValidation v = validated(genus2_voxels(), options);
    EXPECT_EQ(rules(v.defects), Rules{"valence"});
    EXPECT_EQ(v.defect_count, 16u);
}

TEST(ValidateDomain, rule_topology)
{
    // Two spheres in one source: each needs a domain of its own.
    HandDomain hand = sphere_cube(0, 4);
    std::vector<Vec3> positions = hand.mesh.positions();
    auto triangles = hand.mesh.triangles();
    auto quads = hand.domain.complex.quads();
    const Index n = hand.mesh.vertex_count(), k = hand.domain.complex.vertex_count();
    for (Index v = 0; v < n; ++v)
        positions.push_back(positions[v] + Vec3{5, 0, 0});
    for (Index f = 0; f < hand.mesh.face_count(); ++f)
        triangles.push_back({triangles[f][0] + n, triangles[f][1] + n, triangles[f][2] + n});
    for (Index q = 0; q < 6; ++q)
        quads.push_back({quads[q][0] + k, quads[q][1] + k, quads[q][2] + k, quads[q][3] + k});
    for (Index v = 0; v < k; ++v)
        hand.domain.vertices.push_back(hand.domain.vertices[v] + n);
    Paths more;
    for (const DomainEdge& edge : hand.domain.edges) {
        auto& path = more[{edge.a + k, edge.b + k}] = edge.path;
        for (PathPoint& p : path)
            p.from += n, p.to += n;
    }
    set_mesh(hand, positions, triangles);
    set_quads(hand.domain, quads, more);
    EXPECT_EQ(broken_rules(hand), Rules{"topology"});
}

TEST(ValidateDomain, rule_region_a_handle_inside_a_quad)
{
    HandDomain hand = sphere_cube(0, 8);
    // Two faces well inside quad 2 are joined by a tube: genus 1, and the domain does not see it.
    auto triangles = hand.mesh.triangles();
    const Index first = 2 * 64 * 2;
    const Index f = first + 2 * (8 * 2 + 2), g = first + 2 * (8 * 5 + 5);
    const auto a = triangles[f], b = triangles[g];
    triangles[f] = {a[0], a[1], b[0]};
    triangles[g] = {a[1], b[2], b[0]};
    triangles.push_back({a[1], a[2], b[2]});
    triangles.push_back({a[2], b[1], b[2]});
    triangles.push_back({a[2], a[0], b[1]});
    triangles.push_back({a[0], b[0], b[1]});
    set_mesh(hand, hand.mesh.positions(), triangles);
    ASSERT_EQ(hand.mesh.genus(), 1);
    const DomainValidation v = validated(hand);
    EXPECT_EQ(rules(v.defects), (Rules{"topology", "region"}));
    for (const DomainDefect& d : v.defects)
        if (d.rule == "region") {
            EXPECT_EQ(d.element, 2u);
        }
}

TEST(ValidateDomain, rule_carrier_vertex)
{
    HandDomain hand = with_refined_carrier(sphere_cube(0, 4));
    auto& places = hand.domain.carrier.vertex_source;
    const auto good = places;
    places.back().bary = {0.5, 0.25 + 0x1p-30, 0.25 - 0x1p-30};
    EXPECT_EQ(broken_rules(hand), Rules{"carrier_vertex"});
    EXPECT_EQ(validated(hand).defects[0].element, places.size() - 1);
    places = good;
    places.back().bary = {1.25, 0.25, -0.5};
    EXPECT_EQ(broken_rules(hand), Rules{"carrier_vertex"});
    places = good;
    std::swap(places[3], places[4]);
    EXPECT_EQ(broken_rules(hand), Rules{"carrier_vertex"});
}

TEST(ValidateDomain, rule_carrier_face)
{
    HandDomain hand = with_refined_carrier(sphere_cube(0, 4));
    hand.domain.carrier.face_source[30] = 0;
    const DomainValidation v = validated(hand);
    EXPECT_EQ(rules(v.defects), Rules{"carrier_face"});
    EXPECT_EQ(v.defects[0].element, 30u);
}

TEST(ValidateDomain, rule_carrier_tiling)
{
    HandDomain hand = with_refined_carrier(sphere_cube(0, 4));
    hand.domain.carrier.refined = false;
    EXPECT_EQ(broken_rules(hand), Rules{"carrier_tiling"});

    // A hole in the carrier, which the paths see too.
    hand = with_refined_carrier(sphere_cube(0, 4));
    CarrierMesh& carrier = hand.domain.carrier;
    auto triangles = carrier.mesh.triangles();
    triangles.erase(triangles.begin() + 30);
    carrier.face_source.erase(carrier.face_source.begin() + 30);
    auto mesh = ManifoldMesh::build(carrier.mesh.positions(), triangles);
    ASSERT_TRUE(mesh.ok());
    carrier.mesh = *mesh;
    EXPECT_EQ(broken_rules(hand), (Rules{"carrier_tiling", "boundary"}));
}

TEST(ValidateDomain, rule_path_point)
{
    for (const double t : {0.0, 1.0, -0.5, 1.5, double(NAN)}) {
        HandDomain hand = torus_askew(2, 2);
        const auto [e, i] = first_crossing(hand.domain);
        hand.domain.edges[e].path[i].t = t;
        const DomainValidation v = validated(hand);
        EXPECT_EQ(rules(v.defects), Rules{"path_point"});
        EXPECT_EQ(v.defects[0].element, e);
    }
    HandDomain hand = torus_askew(2, 2);
    const auto [e, i] = first_crossing(hand.domain);
    hand.domain.edges[e].path[i].to = hand.mesh.vertex_count() - 7;
    EXPECT_EQ(broken_rules(hand), Rules{"path_point"});
}

TEST(ValidateDomain, rule_path_step)
{
    HandDomain hand = sphere_cube(0, 4); // A vertex is left out.
    hand.domain.edges[4].path.erase(hand.domain.edges[4].path.begin() + 1);
    const DomainValidation v = validated(hand);
    EXPECT_EQ(rules(v.defects), Rules{"path_step"});
    EXPECT_EQ(v.defects[0].element, 4u);

    hand = torus_askew(2, 2); // A crossing is left out.
    const auto [e, i] = first_crossing(hand.domain);
    auto& path = hand.domain.edges[e].path;
    const PathPoint crossing = path[i];
    path.erase(path.begin() + static_cast<std::ptrdiff_t>(i));
    EXPECT_EQ(broken_rules(hand), Rules{"path_step"});

    // A crossing is crossed back at once: its edge twice in a row.
    path.insert(path.begin() + static_cast<std::ptrdiff_t>(i), 2, crossing);
    path[i + 1].t *= 0.5;
    EXPECT_EQ(broken_rules(hand), Rules{"path_step"});

    // An edge is only touched: the path goes on in the face it came from.
    hand = sphere_cube(0, 4);
    DomainEdge& edge = hand.domain.edges[0];
    const Index v0 = hand.domain.vertices[edge.a], v1 = edge.path[0].from;
    const Index h = hand.mesh.find_halfedge(v0, v1);
    const Index apex = hand.mesh.to(ManifoldMesh::next(h));
    edge.path.insert(edge.path.begin(), {v1, apex, 0.5});
    EXPECT_EQ(broken_rules(hand), Rules{"path_step"});
}

TEST(ValidateDomain, rule_path_crossing_at_a_vertex)
{
    HandDomain hand = sphere_cube(0, 4);
    // Edge 0 goes back and forth over its own first vertex.
    auto& path = hand.domain.edges[0].path;
    const std::vector<PathPoint> twice{path[0], path[1], path[0], path[1]};
    path.erase(path.begin(), path.begin() + 2);
    path.insert(path.begin(), twice.begin(), twice.end());
    EXPECT_EQ(broken_rules(hand), Rules{"path_crossing"});

    // Through the end of another edge.
    hand = sphere_cube(1, 4);
    DomainEdge& edge = hand.domain.edges[0];
    for (const DomainEdge& other : hand.domain.edges)
        if (other.a == edge.b && other.b != edge.a) {
            const Index corner = hand.domain.vertices[edge.b];
            edge.path.push_back({corner, corner, 0});
            edge.path.push_back(other.path[0]);
            break;
        }
    EXPECT_EQ(broken_rules(hand), Rules{"path_crossing"});
}

//! Lets the first path that crosses a mesh edge w - x wind once around w after that and cross w - x
//! again, at `last`.
void add_loop(HandDomain& hand, const std::function<PathPoint(const PathPoint&)>& last)
{
    const ManifoldMesh& mesh = hand.mesh;
    const auto [e, i] = first_crossing(hand.domain);
    auto& path = hand.domain.edges[e].path;
    const PathPoint crossing = path[i];
    const Index w = crossing.from;
    // The turn that leads on: away from the face that the path comes from.
    PathPoint before;
    before.from = before.to = hand.domain.vertices[hand.domain.edges[e].a];
    if (i > 0)
        before = path[i - 1];
    const Index start = mesh.find_halfedge(w, crossing.to);
    const Index left = mesh.to(ManifoldMesh::next(start));
    const bool from_left = before.from == left || before.to == left;
    std::vector<PathPoint> loop;
    Index h = start;
    do {
        h = from_left ? ManifoldMesh::next(mesh.twin(h)) : mesh.twin(ManifoldMesh::prev(h));
        loop.push_back({w, mesh.to(h), 0.01});
    } while (h != start);
    loop.back() = last(crossing);
    path.insert(path.begin() + static_cast<std::ptrdiff_t>(i) + 1, loop.begin(), loop.end());
}

TEST(ValidateDomain, rule_path_crossing_inside_a_face)
{
    HandDomain hand = torus_askew(2, 2);
    add_loop(hand, [](const PathPoint& p) { return PathPoint{p.from, p.to, 0.5 * p.t}; });
    const DomainValidation v = validated(hand);
    EXPECT_EQ(rules(v.defects), Rules{"path_crossing"});
    EXPECT_NE(v.defects[0].message.find("inside carrier face"), std::string::npos)
        << v.defects[0].message;
}

TEST(ValidateDomain, rule_path_crossing_at_one_point_of_a_mesh_edge)
{
    // However the place is written: from one end of the mesh edge or from the other.
    for (const bool turned : {false, true}) {
        HandDomain hand = torus_askew(2, 2);
        add_loop(hand, [&](const PathPoint& p) {
            return turned ? PathPoint{p.to, p.from, 1 - p.t} : p;
        });
        const DomainValidation v = validated(hand);
        EXPECT_EQ(rules(v.defects), Rules{"path_crossing"});
        EXPECT_NE(v.defects[0].message.find("at the same point"), std::string::npos)
            << v.defects[0].message;
    }
}

TEST(ValidateDomain, tells_crossings_apart_that_differ_by_less_than_a_rounding)
{
    // 1 - 2^-60 rounds to 1, so only an exact comparison sees that these places differ.
    HandDomain hand = torus_askew(2, 2);
    add_loop(hand, [](const PathPoint& p) { return PathPoint{p.from, p.to, 0x1p-60}; });
    const auto [e, i] = first_crossing(hand.domain);
    PathPoint& first = hand.domain.edges[e].path[i];
    first = {first.to, first.from, 1 - 0x1p-53};
    const DomainValidation v = validated(hand);
    EXPECT_EQ(rules(v.defects), Rules{"path_crossing"});
    EXPECT_NE(v.defects[0].message.find("inside carrier face"), std::string::npos)
        << v.defects[0].message;
}

TEST(ValidateDomain, rule_vertex_order)
{
    HandDomain hand = sphere_cube(0, 4);
    auto quads = hand.domain.complex.quads();
    for (auto& quad : quads)
        std::swap(quad[1], quad[3]);
    set_quads(hand.domain, quads);
    const DomainValidation v = validated(hand);
    EXPECT_EQ(rules(v.defects), Rules{"vertex_order"});
    EXPECT_EQ(v.defect_count, 8u);
}

TEST(ValidateDomain, rule_boundary)
{
    HandDomain hand = open_cylinder(4, 2, 4);
    QuadDomain& domain = hand.domain;
    for (Index e = 0; e < domain.complex.edge_count(); ++e) {
        if (!domain.complex.is_boundary_edge(e))
            continue;
        // Cuts the corner off: from the first inner vertex of the path through the vertex inside.
        auto& path = domain.edges[e].path;
        Index h = hand.mesh.find_halfedge(path[0].from, path[1].from);
        ASSERT_NE(h, invalid_index);
        const Index inside = hand.mesh.to(ManifoldMesh::next(h));
        path.insert(path.begin() + 1, {inside, inside, 0});
        break;
    }
    EXPECT_EQ(broken_rules(hand), Rules{"boundary"});

    // A domain that ends where the mesh does not.
    hand = sphere_cube(0, 4);
    auto quads = hand.domain.complex.quads();
    quads.pop_back();
    set_quads(hand.domain, quads);
    EXPECT_EQ(broken_rules(hand), (Rules{"topology", "boundary"}));
}

TEST(ValidateDomain, lists_at_most_100_defects_of_a_rule_and_counts_all)
{
    HandDomain hand = sphere_cube(2, 4);
    for (DomainEdge& edge : hand.domain.edges)
        edge.crease = true;
    const DomainValidation v = validated(hand);
    EXPECT_EQ(v.defects.size(), 100u);
    EXPECT_EQ(v.defect_count, hand.domain.edges.size());
    EXPECT_FALSE(v.valid());
}

TEST(ValidateDomain, can_be_cancelled)
{
    const HandDomain hand = sphere_cube(0, 4);
    Context context;
    context.cancel();
    const auto v = validate_domain(hand.mesh, hand.domain, context);
    ASSERT_FALSE(v.ok());
    EXPECT_EQ(v.error().code, ErrorCode::cancelled);
}

//! Charts of the sphere's cube, changed by `spoil`.
template <class Spoil> std::vector<DomainDefect> spoilt_charts(const Spoil& spoil)
{
    HandDomain hand = sphere_cube(0, 4);
    spoil(hand.charts);
    ChartStatistics statistics;
    return check_charts(hand.mesh, hand.domain.complex, hand.charts, statistics);
}

TEST(CheckCharts, accepts_charts_known_by_construction)
{
    EXPECT_EQ(rules(spoilt_charts([](auto&) {})), Rules{});
}

TEST(CheckCharts, rule_chart_source)
{
    const auto defects = spoilt_charts([](auto& charts) { charts[3].source_face[5] = 0; });
    EXPECT_EQ(rules(defects), Rules{"chart_source"});
    EXPECT_EQ(defects[0].element, 3u);
}

TEST(CheckCharts, rule_chart_fold)
{
    const auto defects = spoilt_charts([](auto& charts) { // An inner vertex leaves its star.
        charts[2].vertices[2 * 5 + 2].uv = {0.8, 0.8};
    });
    EXPECT_EQ(rules(defects), Rules{"chart_fold"});
    EXPECT_EQ(defects[0].element, 2u);
    // Collinear to the bit.
    EXPECT_EQ(rules(spoilt_charts([](auto& charts) {
                  auto& v = charts[1].vertices;
                  v[0].uv = {0, 0}, v[1].uv = {0.25, 0}, v[6].uv = {0.25, 0};
              })),
              Rules{"chart_fold"});
}

TEST(CheckCharts, rule_chart_side)
{
    const auto defects = spoilt_charts([](auto& charts) { // A border vertex leaves the border.
        charts[4].vertices[2].uv.y = 0x1p-40;
    });
    EXPECT_EQ(rules(defects), Rules{"chart_side"});
    EXPECT_EQ(defects[0].element, 4u);
}

TEST(CheckCharts, rule_chart_continuity)
{
    const auto defects = spoilt_charts([](auto& charts) { // Still on the side, but shifted.
        charts[0].vertices[2].uv.x += 0.01;
    });
    ASSERT_EQ(defects.size(), 1u);
    EXPECT_EQ(defects[0].rule, "chart_continuity");
}

TEST(CheckCharts, measures_the_distortion_of_a_known_map)
{
    // A flat rectangle of 3 by 1, as one quad.
    const auto mesh =
        ManifoldMesh::build({{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}});
    const auto complex = QuadComplex::build(4, {{0, 1, 2, 3}});
    ASSERT_TRUE(mesh.ok() && complex.ok());
    QuadChart chart;
    for (int k = 0; k < 4; ++k)
        chart.vertices.push_back(
            {mesh->position(Index(k)), {k == 1 || k == 2 ? 1.0 : 0.0, k >= 2 ? 1.0 : 0.0}});
    chart.triangles = mesh->triangles();
    chart.source_face = {0, 1};
    chart.bary.assign(2, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}});
    ChartStatistics s;
    EXPECT_TRUE(check_charts(*mesh, *complex, {chart}, s).empty());
    EXPECT_DOUBLE_EQ(s.mean_stretch, 3.0);
    EXPECT_DOUBLE_EQ(s.max_stretch, 3.0);
    EXPECT_EQ(s.worst_quad, 0u);
    EXPECT_DOUBLE_EQ(s.min_jacobian, 1.0);
    EXPECT_DOUBLE_EQ(s.max_jacobian, 1.0);
    EXPECT_DOUBLE_EQ(s.min_area, 3.0);
}

} // namespace
} // namespace bot2nurbs::test
