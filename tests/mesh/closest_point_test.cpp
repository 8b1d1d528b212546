// SPDX-License-Identifier: MIT
#include "bot2nurbs/closest_point.h"

#include "mesh_fixtures.h"

#include <gtest/gtest.h>

#include <random>
#include <thread>

using namespace bot2nurbs;
namespace fx = bot2nurbs::fixtures;

namespace {

//! Distance to a triangle by projecting on the plane and on the three sides: another way than the
//! library's.
double distance_to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c)
{
    double best = INFINITY;
    const auto side = [&](const Vec3& q, const Vec3& r) {
        const Vec3 d = r - q;
        const double n = norm_squared(d);
        const double t = n > 0.0 ? std::min(1.0, std::max(0.0, dot(p - q, d) / n)) : 0.0;
        best = std::min(best, norm(q + t * d - p));
    };
    side(a, b), side(b, c), side(c, a);
    const Vec3 n = normalized(cross(b - a, c - a));
    const Vec3 q = p - dot(p - a, n) * n;
    if (dot(n, cross(b - a, q - a)) > 0.0 && dot(n, cross(c - b, q - b)) > 0.0 &&
        dot(n, cross(a - c, q - c)) > 0.0)
        best = std::min(best, norm(q - p));
    return best;
}

double brute_force(const ManifoldMesh& mesh, const Vec3& p)
{
    double best = INFINITY;
    for (const auto& t : mesh.triangles())
        best = std::min(best, distance_to_triangle(p, mesh.position(t[0]), mesh.position(t[1]),
                                                   mesh.position(t[2])));
    return best;
}

TEST(ClosestPoint, on_faces_that_turn_a_way_is_the_best_of_these_faces_alone)
{
    const ManifoldMesh mesh = fx::icosphere(1);
    const ClosestPoint closest(mesh);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> coordinate(-1.5, 1.5);
    const auto point = [&] {
        const double x = coordinate(random), y = coordinate(random), z = coordinate(random);
        return Vec3{x, y, z};
    };
    for (int i = 0; i < 50; ++i) {
        const Vec3 p = point(), direction = point();
        double least = INFINITY;
        for (Index f = 0; f < mesh.face_count(); ++f)
            if (dot(mesh.area_vector(f), direction) > 0.0)
                least = std::min(
                    least, ClosestPoint(mesh.positions(), {mesh.triangle(f)}).query(p).distance);
        const ClosestPoint::Hit hit = closest.query_facing(p, direction);
        EXPECT_EQ(hit.distance, least);
        EXPECT_GT(dot(mesh.area_vector(hit.where.face), direction), 0.0);
    }
    const ClosestPoint one(mesh.positions(), {mesh.triangle(0)});
    EXPECT_EQ(one.query_facing({}, -1.0 * mesh.area_vector(0)).where.face, invalid_index);
}

} // namespace

TEST(ClosestPoint, distance_agrees_with_brute_force)
{
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-3.0, 3.0);
    for (const auto& list : {fx::closed_meshes(), fx::open_meshes()})
        for (const auto& [name, mesh, genus] : list) {
            SCOPED_TRACE(name);
            const ClosestPoint closest(mesh);
            for (int i = 0; i < 300; ++i) {
                const Vec3 p{uniform(random), uniform(random), uniform(random)};
                const ClosestPoint::Hit hit = closest.query(p);
                ASSERT_NEAR(hit.distance, brute_force(mesh, p), 1e-12);
                ASSERT_NEAR(norm(hit.position - p), hit.distance, 1e-14);
                ASSERT_LT(norm(mesh.at(hit.where) - hit.position), 1e-13);
                double sum = 0.0;
                for (const double b : hit.where.bary) {
                    ASSERT_GE(b, -1e-15);
                    sum += b;
                }
                ASSERT_NEAR(sum, 1.0, 1e-14);
            }
        }
}

TEST(ClosestPoint, is_exact_on_needles_and_caps)
{
    // A strip whose triangles have heights from 1e-3 down to 1e-15, and one of no area.
    std::vector<Vec3> positions;
    std::vector<std::array<Index, 3>> triangles;
    double y = 0.0;
    for (int i = 0; i < 16; ++i) {
        positions.push_back({0.0, y, 0.0});
        positions.push_back({0.3 + 0.02 * i, y, 0.1});
        positions.push_back({1.0, y, 0.0});
        if (i > 0) {
            const Index a = 3 * static_cast<Index>(i) - 3;
            for (const Index k : {a, a + 1}) {
                triangles.push_back({k, k + 1, k + 4});
                triangles.push_back({k, k + 4, k + 3});
            }
        }
        y += i < 14 ? std::pow(10.0, -3 - i) : 0.0;
    }
    const ManifoldMesh mesh = fx::must_build(positions, triangles);
    const ClosestPoint closest(mesh);
    std::mt19937 random(8);
    std::uniform_real_distribution<double> uniform(-1.0, 2.0);
    for (int i = 0; i < 2000; ++i) {
        const double shrink = std::pow(10.0, -(i % 7));
        const Vec3 p{uniform(random), uniform(random) * shrink, uniform(random) * shrink};
        ASSERT_NEAR(closest.query(p).distance, brute_force(mesh, p), 1e-11);
    }
}

TEST(ClosestPoint, ties_go_to_the_smallest_face)
{
    const ManifoldMesh mesh = fx::icosphere(2);
    const ClosestPoint closest(mesh);
    std::vector<Index> smallest(mesh.vertex_count(), invalid_index);
    for (Index h = 0; h < mesh.halfedge_count(); ++h)
        smallest[mesh.from(h)] = std::min(smallest[mesh.from(h)], ManifoldMesh::face(h));
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
        const ClosestPoint::Hit hit = closest.query(mesh.position(v));
        ASSERT_EQ(hit.distance, 0.0);
        ASSERT_EQ(hit.where.face, smallest[v]);
        ASSERT_EQ(hit.position, mesh.position(v));
    }
}

TEST(ClosestPoint, limit_finds_nothing_beyond_and_the_same_within)
{
    const ManifoldMesh mesh = fx::torus(20, 12);
    const ClosestPoint closest(mesh);
    std::mt19937 random(9);
    std::uniform_real_distribution<double> uniform(-2.0, 2.0);
    for (int i = 0; i < 500; ++i) {
        const Vec3 p{uniform(random), uniform(random), uniform(random)};
        const ClosestPoint::Hit all = closest.query(p);
        const ClosestPoint::Hit within = closest.query(p, all.distance * 1.0001);
        EXPECT_EQ(within.where.face, all.where.face);
        EXPECT_EQ(within.distance, all.distance);
        const ClosestPoint::Hit beyond = closest.query(p, all.distance * 0.9999);
        EXPECT_EQ(beyond.where.face, invalid_index);
    }
}

TEST(ClosestPoint, is_scale_free)
{
    const ManifoldMesh mesh = fx::genus_two();
    for (const double scale : {1e-6, 1e6}) {
        const ManifoldMesh scaled = fx::moved(mesh, [&](const Vec3& p) { return scale * p; });
        const ClosestPoint a(mesh), b(scaled);
        std::mt19937 random(10);
        std::uniform_real_distribution<double> uniform(-1.0, 6.0);
        for (int i = 0; i < 200; ++i) {
            const Vec3 p{uniform(random), uniform(random), uniform(random)};
            ASSERT_NEAR(b.query(scale * p).distance / scale, a.query(p).distance, 1e-12);
        }
    }
}

TEST(ClosestPoint, queries_from_many_threads_agree)
{
    const ClosestPoint closest(fx::icosphere(3));
    const auto run = [&closest](std::vector<Index>& faces) {
        std::mt19937 random(11);
        std::uniform_real_distribution<double> uniform(-2.0, 2.0);
        for (int i = 0; i < 2000; ++i) {
            const double x = uniform(random), y = uniform(random), z = uniform(random);
            faces.push_back(closest.query({x, y, z}).where.face);
        }
    };
    std::vector<Index> faces[4];
    std::vector<std::thread> threads;
    for (auto& f : faces)
        threads.emplace_back([&run, &f] { run(f); });
    for (auto& t : threads)
        t.join();
    for (const auto& f : faces)
        EXPECT_EQ(f, faces[0]);
}
