// SPDX-License-Identifier: MIT
#include "bot2nurbs/refine_domain.h"

#include "core/predicates.h"
#include "domain/quad_marks.h"
#include "domain_fixtures.h"

#include <gtest/gtest.h>

#include <random>

namespace bot2nurbs {
namespace {

using namespace fixtures;

using Marks = std::vector<char>;

std::vector<Domain> all_domains()
{
    std::vector<Domain> out = closed_domains();
    for (auto list : {open_domains(), feature_domains()})
        out.insert(out.end(), list.begin(), list.end());
    return out;
}

Marks random_marks(const QuadComplex& k, std::mt19937& random, unsigned one_in)
{
    Marks marks(k.edge_count(), 0);
    for (char& m : marks)
        m = random() % one_in == 0;
    return marks;
}

bool is_closed_marking(const QuadComplex& k, const Marks& marks)
{
    for (Index q = 0; q < k.quad_count(); ++q)
        if (marked_sides(k, marks, q) % 2 != 0)
            return false;
    return true;
}

//! Least cost of all markings that contain `marks` and leave no quad with one or three.
double least_cost(const QuadComplex& k, const Marks& marks, const MarkCosts& costs)
{
    std::vector<Index> open;
    for (Index e = 0; e < k.edge_count(); ++e)
        if (!marks[e])
            open.push_back(e);
    double best = 1e300;
    for (std::uint32_t set = 0; set < 1u << open.size(); ++set) {
        Marks all = marks;
        for (std::size_t i = 0; i < open.size(); ++i)
            all[open[i]] = static_cast<char>(set >> i & 1u);
        if (is_closed_marking(k, all))
            best = std::min(best, costs.total(k, all));
    }
    return best;
}

//! Random costs that satisfy the condition of MarkCosts.
MarkCosts random_costs(const QuadComplex& k, std::mt19937& random)
{
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    MarkCosts costs;
    costs.max_valence = 100;
    for (Index q = 0; q < k.quad_count(); ++q) {
        costs.halve.push_back({uniform(random), uniform(random)});
        std::array<double, 4> turn{};
        const double all = costs.halve[q][0] + costs.halve[q][1];
        for (Index i = 0; i < 2; ++i) {
            turn[i] = 2.0 * uniform(random);
            turn[i + 2] = std::max(0.0, all - turn[i]) + uniform(random);
        }
        costs.turn.push_back(turn);
    }
    return costs;
}

TEST(CloseMarks, leaves_every_quad_with_none_two_or_four_and_keeps_what_was_marked)
{
    std::mt19937 random(1);
    for (const Domain& d : all_domains())
        for (const unsigned one_in : {2u, 5u, 20u}) {
            const QuadComplex& k = d.complex;
            const Marks marks = random_marks(k, random, one_in);
            const Marks closed = close_marks(k, marks, MarkCosts::of_regularity(k));
            EXPECT_TRUE(is_closed_marking(k, closed)) << d.name;
            for (Index e = 0; e < k.edge_count(); ++e)
                EXPECT_LE(marks[e], closed[e]) << d.name;
        }
}

TEST(MarkCosts, make_a_turn_dear_where_a_corner_has_its_quads_and_cheap_where_it_lacks_one)
{
    // The corners of a cube with creases: each face has a quad there, and it is of 90 degrees.
    const Domain plain = fixtures::cube();
    const QuadComplex& k = plain.complex;
    std::vector<std::pair<Index, Index>> creases;
    for (Index e = 0; e < k.edge_count(); ++e)
        creases.emplace_back(k.from(k.halfedge_of_edge(e)), k.to(k.halfedge_of_edge(e)));
    const auto sharp = QuadComplex::build(k.vertex_count(), k.quads(), creases);
    ASSERT_TRUE(sharp.ok());
    const auto turn_at = [](const QuadComplex& complex, double angle) {
        return MarkCosts::of_regularity(complex,
                                        std::vector<double>(complex.halfedge_count(), angle))
            .turn[0][0];
    };
    const double right_angle = 0.5 * M_PI;
    EXPECT_LT(turn_at(k, right_angle), turn_at(*sharp, right_angle)); // 3 of 4 against 1 of 1
    EXPECT_LT(turn_at(*sharp, 2.0 * right_angle), turn_at(*sharp, right_angle));
    EXPECT_GT(turn_at(*sharp, 0.2 * right_angle), 0.0);
    EXPECT_GE(turn_at(*sharp, 4.0 * right_angle), 0.0);
}

TEST(CloseMarks, adds_nothing_to_no_marks_and_to_whole_strips)
{
    std::mt19937 random(4);
    for (const Domain& d : all_domains()) {
        const QuadComplex& k = d.complex;
        Marks marks(k.edge_count(), 0);
        EXPECT_EQ(close_marks(k, marks, MarkCosts::of_regularity(k)), marks) << d.name;
        // From a side across its quad to the opposite one, and on, both ways, until it is back.
        const Index start = random() % k.halfedge_count();
        for (const Index first : {start, k.twin(start)})
            for (Index h = first; h != invalid_index;) {
                marks[k.edge(h)] = 1;
                const Index opposite = QuadComplex::next(QuadComplex::next(h));
                marks[k.edge(opposite)] = 1;
                h = k.twin(opposite);
                if (h == first)
                    break;
            }
        EXPECT_EQ(close_marks(k, marks, MarkCosts::of_regularity(k)), marks) << d.name;
    }
}

TEST(CloseMarks, is_the_cheapest_of_all_on_small_complexes)
{
    std::mt19937 random(2);
    std::vector<Domain> small{cube(),          torus_grid(3, 3), disk_grid(2, 2),
                              disk_grid(3, 1), disk_grid(1, 1),  open_cylinder(3, 2),
                              star(5),         star(3)};
    for (const Domain& d : small) {
        ASSERT_LE(d.complex.edge_count(), 18u) << d.name;
        for (int trial = 0; trial < 12; ++trial) {
            const Marks marks = random_marks(d.complex, random, trial % 2 == 0 ? 3 : 8);
            const MarkCosts costs = trial % 3 == 0 ? MarkCosts::of_regularity(d.complex)
                                                   : random_costs(d.complex, random);
            const Marks closed = close_marks(d.complex, marks, costs);
            ASSERT_TRUE(is_closed_marking(d.complex, closed)) << d.name;
            EXPECT_NEAR(costs.total(d.complex, closed), least_cost(d.complex, marks, costs), 1e-9)
                << d.name << ", trial " << trial;
        }
    }
}

TEST(CloseMarks, runs_a_strip_along_a_regular_grid_to_the_boundary)
{
    // One mark in a grid without irregular vertices: straight on costs one quad each, a turn more.
    const Domain d = disk_grid(5, 4);
    Marks marks(d.complex.edge_count(), 0);
    marks[d.complex.edge(4 * 6)] = 1; // A side 0 in the second column.
    const Marks closed = close_marks(d.complex, marks, MarkCosts::of_regularity(d.complex));
    const auto refined = refine_complex(d.complex, closed);
    ASSERT_TRUE(refined.ok());
    EXPECT_EQ(refined->complex.quad_count(), d.complex.quad_count() + 4);
    EXPECT_EQ(refined->complex.extraordinary_count(), d.complex.extraordinary_count());
}

TEST(CloseMarks, gives_no_vertex_more_quads_than_the_limit)
{
    std::mt19937 random(3);
    Index at_limit = 0;
    for (const Domain& d : closed_domains()) {
        Domain current = d;
        for (int round = 0; round < 3; ++round) {
            const QuadComplex& k = current.complex;
            MarkCosts costs = MarkCosts::of_regularity(k);
            costs.max_valence = 5;
            const Marks closed = close_marks(k, random_marks(k, random, 6), costs);
            const auto refined = refine_complex(k, closed);
            ASSERT_TRUE(refined.ok());
            for (Index v = 0; v < refined->complex.vertex_count(); ++v) {
                const Index before = v < k.vertex_count() ? k.valence(v) : 0;
                EXPECT_LE(refined->complex.valence(v), std::max(before, 5u)) << d.name;
                at_limit += refined->complex.valence(v) == 5 && before == 4;
            }
            current.complex = refined->complex;
        }
    }
    EXPECT_GT(at_limit, 0u); // The limit was in the way.
}

//! Every pattern of marks of one quad, by itself.
class Templates : public ::testing::Test {
protected:
    void SetUp() override
    {
        const Domain d = disk_grid(1, 1);
        for (unsigned set = 0; set < 16; ++set) {
            Marks marks(4, 0);
            for (Index s = 0; s < 4; ++s)
                marks[d.complex.edge(s)] = static_cast<char>(set >> s & 1u);
            auto refined = refine_complex(d.complex, marks);
            ASSERT_EQ(refined.ok(), is_closed_marking(d.complex, marks)) << set;
            if (!refined) {
                EXPECT_EQ(refined.error().code, ErrorCode::bad_option);
                EXPECT_EQ(refined.error().element, 0u);
                continue;
            }
            sets_.push_back(set);
            refined_.push_back(std::move(*refined));
        }
        ASSERT_EQ(refined_.size(), 8u);
    }

    std::vector<unsigned> sets_;
    std::vector<RefinedComplex> refined_;
};

TEST_F(Templates, have_one_two_three_or_four_quads_as_the_paper_has)
{
    for (std::size_t i = 0; i < sets_.size(); ++i) {
        const unsigned set = sets_[i];
        const Index expected = set == 0 ? 1 : set == 15 ? 4 : set == 5 || set == 10 ? 2 : 3;
        EXPECT_EQ(refined_[i].complex.quad_count(), expected) << set;
        EXPECT_EQ(refined_[i].complex.euler_characteristic(), 1) << set;
        EXPECT_EQ(refined_[i].center[0] != invalid_index, expected > 2) << set;
    }
}

TEST_F(Templates, tile_the_unit_square_with_convex_pieces)
{
    for (std::size_t i = 0; i < sets_.size(); ++i) {
        double area = 0.0;
        for (const QuadPiece& piece : refined_[i].map.pieces) {
            const auto& c = piece.corners;
            area += 0.5 * (cross(c[1] - c[0], c[2] - c[0]) + cross(c[2] - c[0], c[3] - c[0]));
            for (int k = 0; k < 4; ++k)
                EXPECT_GT(orient2d(c[k], c[(k + 1) % 4], c[(k + 2) % 4]), 0) << sets_[i];
        }
        EXPECT_DOUBLE_EQ(area, 1.0) << sets_[i];
    }
}

TEST_F(Templates, keep_the_directions_of_u_and_v)
{
    for (std::size_t i = 0; i < sets_.size(); ++i)
        for (const QuadPiece& piece : refined_[i].map.pieces) {
            const auto& c = piece.corners;
            EXPECT_GT(c[1].x - c[0].x, 0.0) << sets_[i];
            EXPECT_GT(c[2].x - c[3].x, 0.0) << sets_[i];
            EXPECT_GT(c[3].y - c[0].y, 0.0) << sets_[i];
            EXPECT_GT(c[2].y - c[1].y, 0.0) << sets_[i];
        }
}

TEST_F(Templates, place_vertices_where_the_corners_of_the_pieces_are)
{
    const auto corner_place = [](const RefinedComplex& r, Index v) -> Vec2 {
        const std::array<Vec2, 4> corners{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
        const Domain d = disk_grid(1, 1);
        for (Index k = 0; k < 4; ++k) {
            if (d.complex.quad(0)[k] == v)
                return corners[k];
            if (r.middle[d.complex.edge(k)] == v)
                return 0.5 * (corners[k] + corners[(k + 1) % 4]);
        }
        EXPECT_EQ(r.center[0], v);
        return {0.5, 0.5};
    };
    for (const RefinedComplex& r : refined_)
        for (Index q = 0; q < r.complex.quad_count(); ++q)
            for (Index k = 0; k < 4; ++k)
                EXPECT_EQ(r.map.pieces[q].corners[k], corner_place(r, r.complex.quad(q)[k]));
}

TEST_F(Templates, carry_a_place_to_the_piece_it_is_on_and_back)
{
    for (const RefinedComplex& r : refined_)
        for (int i = 0; i <= 40; ++i)
            for (int j = 0; j <= 40; ++j) {
                const DomainPoint p{0, i / 40.0, j / 40.0};
                const DomainPoint piece = r.map.to_piece(p);
                ASSERT_LT(piece.quad, r.complex.quad_count());
                ASSERT_TRUE(piece.u >= 0.0 && piece.u <= 1.0 && piece.v >= 0.0 && piece.v <= 1.0);
                const DomainPoint back = r.map.to_parent(piece);
                EXPECT_EQ(back.quad, 0u);
                EXPECT_NEAR(back.u, p.u, 4e-16);
                EXPECT_NEAR(back.v, p.v, 4e-16);
            }
}

TEST_F(Templates, are_reached_in_every_piece_and_inverted_there)
{
    for (const RefinedComplex& r : refined_)
        for (Index q = 0; q < r.complex.quad_count(); ++q)
            for (int i = 1; i < 20; ++i)
                for (int j = 1; j < 20; ++j) {
                    const DomainPoint p{q, i / 20.0, j / 20.0};
                    const DomainPoint again = r.map.to_piece(r.map.to_parent(p));
                    EXPECT_EQ(again.quad, q);
                    EXPECT_NEAR(again.u, p.u, 1e-15);
                    EXPECT_NEAR(again.v, p.v, 1e-15);
                }
}

//! The vertices at the ends of the side that a place lies on, and how far along.
struct SidePlace {
    Index low, high;
    double t;
};

SidePlace side_place(const QuadComplex& k, const DomainPoint& p)
{
    Index s = 0;
    double t = p.u;
    if (p.u == 1.0)
        s = 1, t = p.v;
    else if (p.v == 1.0)
        s = 2, t = 1.0 - p.u;
    else if (p.u == 0.0)
        s = 3, t = 1.0 - p.v;
    else
        EXPECT_EQ(p.v, 0.0);
    const Index h = 4 * p.quad + s, a = k.from(h), b = k.to(h);
    return a < b ? SidePlace{a, b, t} : SidePlace{b, a, 1.0 - t};
}

TEST(RefineComplex, keeps_places_of_a_common_edge_together)
{
    std::mt19937 random(5);
    for (const Domain& d : all_domains()) {
        const QuadComplex& k = d.complex;
        const Marks closed =
            close_marks(k, random_marks(k, random, 4), MarkCosts::of_regularity(k));
        const auto refined = refine_complex(k, closed);
        ASSERT_TRUE(refined.ok()) << d.name;
        for (Index h = 0; h < k.halfedge_count(); ++h) {
            const Index g = k.twin(h);
            if (g == invalid_index)
                continue;
            for (const double t : {0.1, 0.25, 0.4, 0.7, 0.9}) {
                const auto place = [](Index side, double at) -> DomainPoint {
                    const std::array<DomainPoint, 4> on{{{side / 4, at, 0.0},
                                                         {side / 4, 1.0, at},
                                                         {side / 4, 1.0 - at, 1.0},
                                                         {side / 4, 0.0, 1.0 - at}}};
                    return on[side % 4];
                };
                const SidePlace a =
                    side_place(refined->complex, refined->map.to_piece(place(h, t)));
                const SidePlace b =
                    side_place(refined->complex, refined->map.to_piece(place(g, 1.0 - t)));
                EXPECT_EQ(a.low, b.low) << d.name;
                EXPECT_EQ(a.high, b.high) << d.name;
                EXPECT_NEAR(a.t, b.t, 1e-15) << d.name;
            }
        }
    }
}

TEST(RefineComplex, keeps_the_topology_over_five_rounds)
{
    std::mt19937 random(6);
    for (const Domain& d : all_domains()) {
        QuadComplex k = d.complex;
        for (int round = 0; round < 5; ++round) {
            const Marks closed =
                close_marks(k, random_marks(k, random, 12), MarkCosts::of_regularity(k));
            const auto refined = refine_complex(k, closed);
            ASSERT_TRUE(refined.ok()) << d.name << ": " << refined.error().message;
            const QuadComplex& r = refined->complex;
            EXPECT_EQ(r.euler_characteristic(), d.complex.euler_characteristic()) << d.name;
            EXPECT_EQ(r.closed(), d.complex.closed()) << d.name;
            EXPECT_GE(r.boundary_edge_count(), k.boundary_edge_count()) << d.name;
            for (Index v = 0; v < r.vertex_count(); ++v)
                if (r.twin(r.halfedge_at(v)) != invalid_index) {
                    EXPECT_GE(r.valence(v), 3u) << d.name;
                }
            // Vertices in the middle of edges are regular.
            for (Index e = 0; e < k.edge_count(); ++e)
                if (closed[e]) {
                    EXPECT_EQ(r.valence(refined->middle[e]), k.is_boundary_edge(e) ? 2u : 4u);
                }
            k = r;
        }
    }
}

TEST(RefineComplex, makes_halves_of_creases_creases_and_keeps_corners)
{
    std::mt19937 random(8);
    for (const Domain& d : feature_domains()) {
        const QuadComplex& k = d.complex;
        const Marks closed =
            close_marks(k, random_marks(k, random, 3), MarkCosts::of_regularity(k));
        const auto refined = refine_complex(k, closed);
        ASSERT_TRUE(refined.ok()) << d.name;
        const QuadComplex& r = refined->complex;
        Index expected = 0, found = 0;
        for (Index e = 0; e < k.edge_count(); ++e)
            expected += k.is_crease(e) ? (closed[e] ? 2 : 1) : 0;
        for (Index e = 0; e < r.edge_count(); ++e) {
            if (!r.is_crease(e))
                continue;
            ++found;
            // Each is an old edge or half of one.
            const Index h = r.halfedge_of_edge(e);
            const Index high = std::max(r.from(h), r.to(h)), low = std::min(r.from(h), r.to(h));
            bool known = false;
            for (Index o = 0; o < k.edge_count(); ++o) {
                const Index g = k.halfedge_of_edge(o), a = k.from(g), b = k.to(g);
                known = known || (k.is_crease(o) &&
                                  ((std::max(a, b) == high && std::min(a, b) == low) ||
                                   (refined->middle[o] == high && (a == low || b == low))));
            }
            EXPECT_TRUE(known) << d.name;
        }
        EXPECT_EQ(found, expected) << d.name;
        for (Index v = 0; v < r.vertex_count(); ++v)
            EXPECT_EQ(r.is_corner(v), v < k.vertex_count() && k.is_corner(v)) << d.name;
    }
}

} // namespace
} // namespace bot2nurbs
