// SPDX-License-Identifier: MIT
#include "bot2nurbs/refine_domain.h"

#include "bot2nurbs/domain_file.h"
#include "bot2nurbs/validate_domain.h"
#include "hand_domains.h"

#include <gtest/gtest.h>

#include <random>
#include <string>

namespace bot2nurbs {
namespace {

using test::HandDomain;
using Marks = std::vector<char>;

struct Case {
    std::string name;
    HandDomain hand;
};

//! The same domain with every third edge a crease, and a corner where creases meet.
HandDomain with_creases(HandDomain hand)
{
    const QuadComplex& k = hand.domain.complex;
    std::vector<std::pair<Index, Index>> creases;
    for (Index e = 0; e < k.edge_count(); e += 3) {
        creases.emplace_back(hand.domain.edges[e].a, hand.domain.edges[e].b);
        hand.domain.edges[e].crease = true;
    }
    hand.domain.complex = *QuadComplex::build(k.vertex_count(), k.quads(), creases, {0});
    return hand;
}

std::vector<Case> all_cases()
{
    return {{"sphere", test::sphere_cube(0, 8)},
            {"coarse sphere", test::sphere_cube(0, 2)},
            {"sphere with creases", with_creases(test::sphere_cube(1, 4))},
            {"torus", test::torus_grid()},
            {"askew torus", test::torus_askew()},
            {"genus 2", test::genus2_voxels(0, 2)},
            {"cylinder", test::open_cylinder()},
            {"refined carrier", test::with_refined_carrier(test::torus_askew())}};
}

Marks random_marks(const QuadComplex& k, std::mt19937& random, unsigned one_in)
{
    Marks marks(k.edge_count(), 0);
    for (char& m : marks)
        m = random() % one_in == 0;
    return close_marks(k, marks, MarkCosts::of_regularity(k));
}

Marks all_marks(const QuadComplex& k)
{
    return Marks(k.edge_count(), 1);
}

Result<RefinedDomain> refined(const HandDomain& hand, const Marks& marks, unsigned threads = 0)
{
    Context context;
    context.threads = threads;
    return refine_domain(hand.mesh, hand.domain, marks, context);
}

::testing::AssertionResult is_valid(const ManifoldMesh& source, const QuadDomain& domain)
{
    Context context;
    const Result<DomainValidation> validation = validate_domain(source, domain, context);
    if (!validation)
        return ::testing::AssertionFailure() << validation.error().message;
    if (validation->valid())
        return ::testing::AssertionSuccess();
    const DomainDefect& first = validation->defects.front();
    return ::testing::AssertionFailure()
           << validation->defect_count << " defects, first " << first.rule << ": " << first.message;
}

Vec3 position(const ManifoldMesh& mesh, const PathPoint& p)
{
    return p.is_vertex() ? mesh.position(p.from)
                         : (1.0 - p.t) * mesh.position(p.from) + p.t * mesh.position(p.to);
}

//! The edge as a polyline.
std::vector<Vec3> polyline(const QuadDomain& domain, Index e)
{
    const DomainEdge& edge = domain.edges[e];
    const ManifoldMesh& mesh = domain.carrier.mesh;
    std::vector<Vec3> line{mesh.position(domain.vertices[edge.a])};
    for (const PathPoint& p : edge.path)
        line.push_back(position(mesh, p));
    line.push_back(mesh.position(domain.vertices[edge.b]));
    return line;
}

double length_of(const std::vector<Vec3>& line)
{
    double sum = 0.0;
    for (std::size_t i = 1; i < line.size(); ++i)
        sum += norm(line[i] - line[i - 1]);
    return sum;
}

double distance_to(const std::vector<Vec3>& line, const Vec3& p)
{
    double least = norm(p - line[0]);
    for (std::size_t i = 1; i < line.size(); ++i) {
        const Vec3 d = line[i] - line[i - 1];
        const double n = norm_squared(d);
        const double t = n > 0.0 ? std::clamp(dot(p - line[i - 1], d) / n, 0.0, 1.0) : 0.0;
        least = std::min(least, norm(p - line[i - 1] - t * d));
    }
    return least;
}

//! The edge of a complex between two vertices.
Index find_edge(const QuadComplex& k, Index a, Index b)
{
    for (Index e = 0; e < k.edge_count(); ++e) {
        const Index h = k.halfedge_of_edge(e);
        if (std::minmax(k.from(h), k.to(h)) == std::minmax(a, b))
            return e;
    }
    return invalid_index;
}

TEST(RefineDomain, gives_a_valid_domain_for_any_closed_marking)
{
    std::mt19937 random(1);
    for (const Case& c : all_cases()) {
        ASSERT_TRUE(is_valid(c.hand.mesh, c.hand.domain)) << c.name;
        for (unsigned trial = 0; trial < 4; ++trial) {
            const Marks marks = random_marks(c.hand.domain.complex, random, 1 + 2 * trial);
            const auto result = refined(c.hand, marks);
            ASSERT_TRUE(result.ok()) << c.name << ": " << result.error().message;
            EXPECT_TRUE(is_valid(c.hand.mesh, result->domain)) << c.name << ", trial " << trial;
        }
    }
}

TEST(RefineDomain, stays_valid_over_rounds_with_a_carrier_in_proportion_to_the_quads)
{
    // About forty faces a quad, and more where it is long and thin.
    constexpr std::size_t most_faces_per_quad = 80;
    std::mt19937 random(2);
    for (const Case& c : all_cases()) {
        HandDomain current = c.hand;
        for (int round = 0; round < 5; ++round) {
            auto result = refined(current, random_marks(current.domain.complex, random, 20));
            ASSERT_TRUE(result.ok()) << c.name << ": " << result.error().message;
            current.domain = std::move(result->domain);
            ASSERT_TRUE(is_valid(c.hand.mesh, current.domain)) << c.name << ", round " << round;
        }
        EXPECT_LE(current.domain.carrier.mesh.face_count(),
                  c.hand.domain.carrier.mesh.face_count() +
                      most_faces_per_quad * current.domain.complex.quad_count())
            << c.name;
    }
}

TEST(RefineDomain, keeps_vertices_and_the_course_of_all_paths)
{
    // Where paths are close together on an edge they are moved apart, by up to a fiftieth of it.
    constexpr double moved = 0.02;
    std::mt19937 random(3);
    for (const Case& c : all_cases()) {
        const QuadDomain& old = c.hand.domain;
        const Marks marks = random_marks(old.complex, random, 4);
        const auto result = refined(c.hand, marks);
        ASSERT_TRUE(result.ok()) << c.name;
        const QuadDomain& now = result->domain;
        for (Index v = 0; v < old.complex.vertex_count(); ++v)
            EXPECT_EQ(now.vertices[v], old.vertices[v]) << c.name;
        Index middle = old.complex.vertex_count();
        for (Index e = 0; e < old.complex.edge_count(); ++e) {
            const Index a = old.edges[e].a, b = old.edges[e].b;
            const std::vector<Vec3> before = polyline(old, e);
            const double length = length_of(before);
            std::vector<std::vector<Vec3>> after;
            if (marks[e]) {
                for (const Index end : {a, b}) {
                    const Index half = find_edge(now.complex, end, middle);
                    ASSERT_NE(half, invalid_index) << c.name;
                    after.push_back(polyline(now, half));
                    EXPECT_EQ(now.edges[half].crease, old.edges[e].crease);
                }
                const double share =
                    length_of(after[0]) / (length_of(after[0]) + length_of(after[1]));
                EXPECT_NEAR(share, 0.5, 0.1 + moved) << c.name << ", edge " << e;
                ++middle;
            } else {
                const Index same = find_edge(now.complex, a, b);
                ASSERT_NE(same, invalid_index) << c.name;
                after.push_back(polyline(now, same));
                EXPECT_EQ(now.edges[same].crease, old.edges[e].crease);
            }
            for (const std::vector<Vec3>& line : after)
                for (const Vec3& p : line)
                    EXPECT_LE(distance_to(before, p), moved * length) << c.name << ", edge " << e;
        }
    }
}

TEST(RefineDomain, makes_pieces_that_are_the_pieces_of_the_old_charts)
{
    // A cylinder can be laid flat, so its charts are linear, and those of the pieces nearly, since
    // paths that meet a carrier vertex pass beside it: a point of a piece is where the old chart
    // has it.
    const HandDomain hand = test::open_cylinder(4, 2, 8);
    const auto result = refined(hand, all_marks(hand.domain.complex));
    ASSERT_TRUE(result.ok());
    Context context;
    const auto before = compute_charts(hand.mesh, hand.domain, context);
    const auto after = compute_charts(hand.mesh, result->domain, context);
    ASSERT_TRUE(before.ok() && after.ok());
    ASSERT_EQ(after->size(), 4 * before->size());
    double worst = 0.0;
    Index common = 0;
    for (Index q = 0; q < after->size(); ++q)
        for (const QuadChart::Vertex& v : (*after)[q].vertices) {
            const DomainPoint old = result->map.to_parent({q, v.uv.x, v.uv.y});
            for (const QuadChart::Vertex& w : (*before)[old.quad].vertices)
                if (norm(w.position - v.position) < 1e-12) {
                    worst = std::max(worst, norm(w.uv - Vec2{old.u, old.v}));
                    ++common;
                }
        }
    EXPECT_GT(common, hand.mesh.vertex_count());
    EXPECT_LT(worst, 0.06);
}

TEST(RefineDomain, refines_a_carrier_that_is_too_coarse)
{
    // Two triangles a quad to begin with.
    const HandDomain hand = test::sphere_cube(1, 2);
    ASSERT_EQ(hand.mesh.face_count(), 2 * hand.domain.complex.quad_count());
    const auto result = refined(hand, all_marks(hand.domain.complex));
    ASSERT_TRUE(result.ok());
    EXPECT_TRUE(result->domain.carrier.refined);
    EXPECT_TRUE(is_valid(hand.mesh, result->domain));
    Context context;
    const auto charts = compute_charts(hand.mesh, result->domain, context);
    ASSERT_TRUE(charts.ok());
    for (const QuadChart& chart : *charts)
        EXPECT_GE(chart.triangles.size(), 16u);
}

TEST(RefineDomain, leaves_a_domain_without_marks_as_it_is)
{
    for (const Case& c : all_cases()) {
        const QuadDomain& old = c.hand.domain;
        const auto result = refined(c.hand, Marks(old.complex.edge_count(), 0));
        ASSERT_TRUE(result.ok()) << c.name;
        EXPECT_EQ(result->domain.vertices, old.vertices) << c.name;
        EXPECT_EQ(result->domain.complex.quads(), old.complex.quads()) << c.name;
        EXPECT_EQ(result->domain.carrier.mesh.triangles(), old.carrier.mesh.triangles()) << c.name;
        for (Index e = 0; e < old.complex.edge_count(); ++e) {
            const auto before = polyline(old, e), after = polyline(result->domain, e);
            ASSERT_EQ(before.size(), after.size()) << c.name;
            for (std::size_t i = 0; i < before.size(); ++i)
                EXPECT_LT(norm(before[i] - after[i]), 1e-15) << c.name;
        }
    }
}

TEST(RefineDomain, is_the_same_for_any_number_of_threads_and_comes_back_from_its_file)
{
    std::mt19937 random(4);
    for (const Case& c : all_cases()) {
        const Marks marks = random_marks(c.hand.domain.complex, random, 3);
        const auto one = refined(c.hand, marks, 1), four = refined(c.hand, marks, 4);
        ASSERT_TRUE(one.ok() && four.ok()) << c.name;
        const std::string text = domain_to_json(one->domain);
        EXPECT_EQ(domain_to_json(four->domain), text) << c.name;
        const auto read = domain_from_json(text, c.hand.mesh);
        ASSERT_TRUE(read.ok()) << c.name << ": " << read.error().message;
        EXPECT_EQ(domain_to_json(*read), text) << c.name;
        EXPECT_TRUE(is_valid(c.hand.mesh, *read)) << c.name;
    }
}

TEST(RefineDomain, refuses_odd_marks_and_can_be_cancelled)
{
    const HandDomain hand = test::torus_grid();
    Marks marks(hand.domain.complex.edge_count(), 0);
    marks[hand.domain.complex.edge(4 * 5)] = 1;
    const auto odd = refined(hand, marks);
    ASSERT_FALSE(odd.ok());
    EXPECT_EQ(odd.error().code, ErrorCode::bad_option);
    EXPECT_NE(odd.error().element, invalid_index);

    Context context;
    context.cancel();
    const auto cancelled =
        refine_domain(hand.mesh, hand.domain, all_marks(hand.domain.complex), context);
    ASSERT_FALSE(cancelled.ok());
    EXPECT_EQ(cancelled.error().code, ErrorCode::cancelled);
}

} // namespace
} // namespace bot2nurbs
