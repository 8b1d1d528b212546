// SPDX-License-Identifier: MIT
#include "mesh/self_intersection.h"

#include "mesh_fixtures.h"

#include <gtest/gtest.h>

#include <random>

using namespace bot2nurbs;
namespace fx = bot2nurbs::fixtures;

namespace {

using Triangle = std::array<Vec3, 3>;
__extension__ using Wide = __int128;
using Whole = std::array<Wide, 3>;

Whole whole(const Vec3& p)
{
    return {static_cast<Wide>(p.x), static_cast<Wide>(p.y), static_cast<Wide>(p.z)};
}
Whole minus(const Whole& a, const Whole& b)
{
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Whole times(const Whole& a, const Whole& b)
{
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Wide inner(const Whole& a, const Whole& b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

struct Fraction {
    Wide p, q; // q > 0
};
bool less(const Fraction& a, const Fraction& b)
{
    return a.p * b.q < b.p * a.q;
}

//! Open interval that a triangle cuts out of the common line; false when it does not straddle.
bool interval(const Triangle& t, const std::array<Wide, 3>& d, const Whole& line, Fraction& low,
              Fraction& high)
{
    std::vector<Fraction> ends;
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3;
        const Wide x = inner(line, whole(t[i])), y = inner(line, whole(t[j]));
        if (d[i] == 0)
            ends.push_back({x, 1});
        if ((d[i] > 0 && d[j] < 0) || (d[i] < 0 && d[j] > 0)) {
            Fraction f{x * (d[i] - d[j]) + (y - x) * d[i], d[i] - d[j]};
            if (f.q < 0)
                f = {-f.p, -f.q};
            ends.push_back(f);
        }
    }
    const bool up = d[0] > 0 || d[1] > 0 || d[2] > 0, down = d[0] < 0 || d[1] < 0 || d[2] < 0;
    if (!up || !down || ends.size() != 2)
        return false;
    low = less(ends[0], ends[1]) ? ends[0] : ends[1];
    high = less(ends[0], ends[1]) ? ends[1] : ends[0];
    return true;
}

//! Area of the intersection of two triangles in one plane, by clipping in doubles.
double common_area(const Triangle& t, const Triangle& s, const Vec3& normal)
{
    std::vector<Vec3> polygon(t.begin(), t.end());
    if (dot(normal, cross(t[1] - t[0], t[2] - t[0])) < 0)
        std::reverse(polygon.begin(), polygon.end());
    Triangle clip = s;
    if (dot(normal, cross(s[1] - s[0], s[2] - s[0])) < 0)
        std::swap(clip[1], clip[2]);
    for (int i = 0; i < 3; ++i) {
        const Vec3 a = clip[i], in = cross(normal, clip[(i + 1) % 3] - a);
        std::vector<Vec3> kept;
        for (std::size_t k = 0; k < polygon.size(); ++k) {
            const Vec3 p = polygon[k], q = polygon[(k + 1) % polygon.size()];
            const double dp = dot(in, p - a), dq = dot(in, q - a);
            if (dp >= 0)
                kept.push_back(p);
            if ((dp > 0 && dq < 0) || (dp < 0 && dq > 0))
                kept.push_back(p + (dp / (dp - dq)) * (q - p));
        }
        polygon = kept;
    }
    Vec3 area;
    for (std::size_t k = 2; k < polygon.size(); ++k)
        area += 0.5 * cross(polygon[k - 1] - polygon[0], polygon[k] - polygon[0]);
    return norm(area);
}

//! The definition in whole numbers: intervals on the common line compared as fractions.
bool cross_by_fractions(const Triangle& t, const Triangle& s)
{
    const Whole n = times(minus(whole(t[1]), whole(t[0])), minus(whole(t[2]), whole(t[0])));
    const Whole m = times(minus(whole(s[1]), whole(s[0])), minus(whole(s[2]), whole(s[0])));
    if (inner(n, n) == 0 || inner(m, m) == 0)
        return false;
    std::array<Wide, 3> d{}, e{};
    bool coplanar = true;
    for (int i = 0; i < 3; ++i) {
        d[i] = inner(m, minus(whole(t[i]), whole(s[0])));
        e[i] = inner(n, minus(whole(s[i]), whole(t[0])));
        coplanar = coplanar && d[i] == 0;
    }
    if (coplanar)
        return common_area(t, s, normalized(cross(t[1] - t[0], t[2] - t[0]))) > 1e-9;
    const Whole line = times(n, m);
    Fraction a, b, c, f;
    return interval(t, d, line, a, b) && interval(s, e, line, c, f) && less(a, f) && less(c, b);
}

} // namespace

TEST(TrianglesCross, agrees_with_exact_fractions_on_small_grids_full_of_degeneracies)
{
    std::mt19937 random(3);
    int crossing = 0;
    for (const int size : {2, 3, 5, 20}) {
        std::uniform_int_distribution<int> coordinate(0, size);
        const auto point = [&] {
            const double x = coordinate(random), y = coordinate(random), z = coordinate(random);
            return Vec3{x, y, z};
        };
        for (int i = 0; i < 60000; ++i) {
            const Triangle t{point(), point(), point()};
            Triangle s{point(), point(), point()};
            if (i % 4 == 1)
                s[0] = t[1];
            if (i % 4 == 2)
                s[2] = t[0], s[1] = t[1];
            const bool expected = cross_by_fractions(t, s);
            crossing += expected;
            ASSERT_EQ(triangles_cross(t, s), expected)
                << size << ": " << t[0].x << t[0].y << t[0].z << " " << t[1].x << t[1].y << t[1].z
                << " " << t[2].x << t[2].y << t[2].z << " | " << s[0].x << s[0].y << s[0].z << " "
                << s[1].x << s[1].y << s[1].z << " " << s[2].x << s[2].y << s[2].z;
            ASSERT_EQ(triangles_cross(s, t), expected);
        }
    }
    EXPECT_GT(crossing, 10000);
}

TEST(TrianglesCross, in_a_flat_grid_overlaps_are_found_in_every_plane)
{
    std::mt19937 random(4);
    std::uniform_int_distribution<int> coordinate(0, 4);
    int crossing = 0;
    for (int i = 0; i < 30000; ++i) {
        Triangle t, s;
        for (Triangle* triangle : {&t, &s})
            for (Vec3& p : *triangle) {
                const double a = coordinate(random), b = coordinate(random);
                p = i % 4 == 0   ? Vec3{a, b, 1}
                    : i % 4 == 1 ? Vec3{1, a, b}
                    : i % 4 == 2 ? Vec3{b, 1, a}
                                 : Vec3{a, b, a + 2 * b};
            }
        const bool expected = cross_by_fractions(t, s);
        crossing += expected;
        ASSERT_EQ(triangles_cross(t, s), expected);
    }
    EXPECT_GT(crossing, 3000);
}

TEST(SelfIntersections, fixtures_have_none)
{
    Context context;
    for (const auto& list : {fx::closed_meshes(), fx::open_meshes()})
        for (const auto& [name, mesh, genus] : list) {
            SCOPED_TRACE(name);
            const SelfIntersections found =
                find_self_intersections(mesh.positions(), mesh.triangles(), 10, context);
            EXPECT_EQ(found.count, 0u);
            EXPECT_TRUE(found.complete);
        }
}

TEST(SelfIntersections, agree_with_all_pairs_and_do_not_depend_on_threads)
{
    std::mt19937 random(5);
    std::normal_distribution<double> noise(0.0, 0.08);
    const ManifoldMesh mesh = fx::moved(fx::icosphere(3), [&](const Vec3& p) {
        const double x = noise(random), y = noise(random), z = noise(random);
        return p + Vec3{x, y, z};
    });
    const auto& positions = mesh.positions();
    const auto& triangles = mesh.triangles();
    std::vector<std::array<Index, 2>> expected;
    for (Index f = 0; f < mesh.face_count(); ++f)
        for (Index g = f + 1; g < mesh.face_count(); ++g) {
            const auto corners = [&](Index i) {
                return Triangle{positions[triangles[i][0]], positions[triangles[i][1]],
                                positions[triangles[i][2]]};
            };
            if (triangles_cross(corners(f), corners(g)))
                expected.push_back({f, g});
        }
    ASSERT_GT(expected.size(), 20u);
    for (const unsigned threads : {1u, 2u, 5u}) {
        Context context;
        context.threads = threads;
        const SelfIntersections found =
            find_self_intersections(positions, triangles, 1000000, context);
        EXPECT_EQ(found.pairs, expected);
        EXPECT_EQ(found.count, expected.size());
        const SelfIntersections few = find_self_intersections(positions, triangles, 7, context);
        EXPECT_EQ(few.count, expected.size());
        EXPECT_EQ(few.pairs, decltype(expected)(expected.begin(), expected.begin() + 7));
    }
}

TEST(SelfIntersections, a_hopeless_soup_is_cut_short)
{
    // 6000 triangles through one point: 18 million candidate pairs.
    std::mt19937 random(6);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    std::vector<Vec3> positions;
    std::vector<std::array<Index, 3>> triangles;
    for (Index i = 0; i < 6000; ++i) {
        const auto point = [&] {
            const double x = uniform(random), y = uniform(random), z = uniform(random);
            return Vec3{x, y, z};
        };
        const Vec3 a = point(), b = point();
        positions.insert(positions.end(), {a, b, -1.0 * (a + b)});
        triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    Context context;
    const SelfIntersections found = find_self_intersections(positions, triangles, 10, context);
    EXPECT_FALSE(found.complete);
    EXPECT_GT(found.count, 100000u);
}
