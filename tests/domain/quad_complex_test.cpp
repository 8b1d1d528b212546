// SPDX-License-Identifier: MIT
#include "domain_fixtures.h"

#include <gtest/gtest.h>

namespace bot2nurbs {
namespace {

using namespace fixtures;

std::vector<Domain> all_domains()
{
    std::vector<Domain> out = closed_domains();
    for (auto list : {open_domains(), feature_domains()}) {
        out.insert(out.end(), list.begin(), list.end());
    }
    return out;
}

void expect_invalid(Index vertices, Quads quads, const std::string& words, Index element,
                    VertexPairs creases = {}, std::vector<Index> corners = {})
{
    const auto built =
        QuadComplex::build(vertices, std::move(quads), std::move(creases), std::move(corners));
    ASSERT_FALSE(built.ok()) << words;
    EXPECT_EQ(built.error().code, ErrorCode::invalid_domain);
    EXPECT_NE(built.error().message.find(words), std::string::npos) << built.error().message;
    EXPECT_EQ(built.error().element, element) << words;
}

TEST(QuadComplex, twins_run_in_opposite_directions_and_share_an_edge)
{
    for (const Domain& d : all_domains()) {
        const QuadComplex& k = d.complex;
        Index boundary = 0;
        for (Index h = 0; h < k.halfedge_count(); ++h) {
            const Index g = k.twin(h);
            if (g == invalid_index) {
                ++boundary;
                EXPECT_TRUE(k.is_boundary_edge(k.edge(h)));
                continue;
            }
            EXPECT_EQ(k.twin(g), h);
            EXPECT_EQ(k.from(g), k.to(h));
            EXPECT_EQ(k.to(g), k.from(h));
            EXPECT_EQ(k.edge(g), k.edge(h));
            EXPECT_EQ(k.halfedge_of_edge(k.edge(h)), std::min(g, h));
        }
        EXPECT_EQ(boundary, k.boundary_edge_count()) << d.name;
        EXPECT_EQ(k.closed(), boundary == 0) << d.name;
    }
}

TEST(QuadComplex, edges_are_numbered_in_order_of_first_use)
{
    for (const Domain& d : all_domains()) {
        Index next = 0;
        for (Index h = 0; h < d.complex.halfedge_count(); ++h) {
            const Index e = d.complex.edge(h);
            EXPECT_LE(e, next) << d.name;
            if (e == next) {
                EXPECT_EQ(d.complex.halfedge_of_edge(next++), h);
            }
        }
        EXPECT_EQ(next, d.complex.edge_count());
    }
}

TEST(QuadComplex, turning_from_halfedge_at_visits_every_quad_of_a_vertex_once)
{
    for (const Domain& d : all_domains()) {
        const QuadComplex& k = d.complex;
        for (Index v = 0; v < k.vertex_count(); ++v) {
            std::set<Index> quads;
            Index h = k.halfedge_at(v);
            do {
                EXPECT_EQ(k.from(h), v);
                EXPECT_TRUE(quads.insert(QuadComplex::quad_of(h)).second);
                h = k.rotate_ccw(h);
            } while (h != invalid_index && h != k.halfedge_at(v));
            EXPECT_EQ(quads.size(), k.valence(v)) << d.name << " vertex " << v;
        }
    }
}

TEST(QuadComplex, counts_match_the_known_shapes)
{
    EXPECT_EQ(cube().complex.euler_characteristic(), 2);
    EXPECT_EQ(cube().complex.extraordinary_count(), 8u);
    EXPECT_EQ(torus_grid(5, 4).complex.euler_characteristic(), 0);
    EXPECT_EQ(torus_grid(5, 4).complex.extraordinary_count(), 0u);
    EXPECT_EQ(genus2().complex.euler_characteristic(), -2);
    EXPECT_EQ(genus2().complex.max_valence(), 5u);
    EXPECT_EQ(disk_grid(3, 2).complex.euler_characteristic(), 1);
    EXPECT_EQ(disk_grid(3, 2).complex.extraordinary_count(), 4u);
    EXPECT_EQ(open_cylinder(5, 2).complex.boundary_edge_count(), 10u);
    for (Index n = 5; n <= 10; ++n) {
        const QuadComplex split = split_bipyramid(n).complex, radial = radial_bipyramid(n).complex;
        EXPECT_EQ(split.euler_characteristic(), 2);
        EXPECT_EQ(split.valence(n), n);
        EXPECT_EQ(split.max_valence(), n);
        EXPECT_EQ(radial.quad_count(), 3 * n);
        EXPECT_EQ(radial.extraordinary_count(), 2 * n + 2);
    }
}

TEST(QuadComplex, creases_and_corners_are_where_they_were_put)
{
    const Domain d = with_features(cube(), "creased", {{5, 4}, {4, 5}, {1, 2}}, {4});
    Index creases = 0;
    for (Index e = 0; e < d.complex.edge_count(); ++e) {
        const Index h = d.complex.halfedge_of_edge(e);
        const Index a = std::min(d.complex.from(h), d.complex.to(h));
        const Index b = std::max(d.complex.from(h), d.complex.to(h));
        const bool expected = (a == 4 && b == 5) || (a == 1 && b == 2);
        EXPECT_EQ(d.complex.is_crease(e), expected);
        EXPECT_EQ(d.complex.is_sharp(e), expected);
        creases += d.complex.is_crease(e);
    }
    EXPECT_EQ(creases, 2u);
    EXPECT_TRUE(d.complex.is_corner(4));
    EXPECT_FALSE(d.complex.is_corner(5));
}

TEST(QuadComplex, refinement_keeps_the_topology_and_the_creases)
{
    const Domain coarse = with_features(cube(), "creased", {{4, 5}}, {4});
    const Domain fine = refine(coarse);
    EXPECT_EQ(fine.complex.quad_count(), 24u);
    EXPECT_EQ(fine.complex.euler_characteristic(), 2);
    EXPECT_EQ(fine.complex.extraordinary_count(), 8u);
    Index creases = 0;
    for (Index e = 0; e < fine.complex.edge_count(); ++e)
        creases += fine.complex.is_crease(e);
    EXPECT_EQ(creases, 2u);
    EXPECT_TRUE(fine.complex.is_corner(4));
}

TEST(QuadComplex, invalid_domains_are_refused_by_name)
{
    expect_invalid(4, {}, "at least one quad", invalid_index);
    expect_invalid(4, {{0, 1, 2, 4}}, "uses vertex 4, but", 0);
    expect_invalid(4, {{0, 1, 2, 3}, {0, 1, 2, 1}}, "uses vertex 1 twice", 1);
    expect_invalid(8, {{0, 1, 2, 3}, {1, 0, 4, 5}, {0, 1, 6, 7}}, "edge 0-1 has 3 quads", 2);
    expect_invalid(6, {{0, 1, 2, 3}, {0, 1, 4, 5}}, "in the same direction", 1);
    expect_invalid(7, {{0, 1, 2, 3}, {0, 4, 5, 6}}, "more than one fan", 0);
    expect_invalid(5, {{0, 1, 2, 3}}, "vertex 4 is not used", 4);
    expect_invalid(4, {{0, 1, 2, 3}}, "crease 0-2 is not an edge", invalid_index, {{0, 2}});
    expect_invalid(4, {{0, 1, 2, 3}}, "corner 9 is not a vertex", 9, {}, {9});
}

TEST(QuadComplex, two_closed_fans_at_one_vertex_are_refused)
{
    const Domain d = cube();
    Quads quads = d.complex.quads();
    for (auto q : d.complex.quads()) {
        for (Index& v : q)
            v = v == 0 ? 0 : v + 7;
        quads.push_back(q);
    }
    expect_invalid(15, quads, "quads at vertex 0 form more than one fan", 0);
}

} // namespace
} // namespace bot2nurbs
