// SPDX-License-Identifier: MIT
#include "maps/find_route.h"

#include "mesh_fixtures.h"

#include <gtest/gtest.h>

#include <random>

namespace bot2nurbs::fixtures {
namespace {

const std::vector<Index> no_chain;

// A route between two sites in the sectors behind their last path ends, towards each other.
std::optional<PathWeb::Route> route_between(const PathWeb& web, RouteFinder& finder, Index a,
                                            Index b, const std::vector<Index>& chain = no_chain)
{
    const auto last = [&web](Index site) {
        return web.ends(site).empty() ? invalid_index : web.ends(site).back();
    };
    const Vec3 from = web.mesh().position(a), to = web.mesh().position(b);
    const Vec3 up = std::fabs((to - from).z) < 1e-12 ? Vec3{0, 0, 1} : from + to;
    return finder.find(a, web.sector(a, last(a)), b, web.sector(b, last(b)),
                       {from, normalized(cross(to - from, up))}, chain);
}

// Where a point of a path lies on the rim of a face, from 0 to 3 around it.
double rim(const ManifoldMesh& mesh, Index face, const SurfacePath& path, std::size_t i)
{
    const auto corner = [&](Index v) {
        for (Index k = 0; k < 3; ++k)
            if (mesh.triangle(face)[k] == v)
                return double(k);
        return -1.0;
    };
    if (i == 0)
        return corner(path.a);
    if (i > path.nodes.size())
        return corner(path.b);
    const PathNode& n = path.nodes[i - 1];
    if (n.is_vertex())
        return corner(n.vertex);
    for (Index k = 0; k < 3; ++k)
        if (mesh.edge(3 * face + k) == mesh.edge(n.halfedge))
            return k + (mesh.edge(3 * face + k) == 3 * face + k ? n.t : 1.0 - n.t);
    return -1.0;
}

// Independent of the web's own order: pieces of paths in one face are chords between points of its
// rim, which must not alternate.
std::size_t crossings(const ManifoldMesh& mesh, const std::vector<SurfacePath>& paths)
{
    std::vector<std::vector<std::pair<double, double>>> chords(mesh.face_count());
    for (const SurfacePath& path : paths)
        for (std::size_t i = 0; i <= path.nodes.size(); ++i)
            for (Index f = 0; f < mesh.face_count(); ++f) {
                const double a = rim(mesh, f, path, i), b = rim(mesh, f, path, i + 1);
                const bool inside = a >= 0.0 && b >= 0.0 && a != b;
                const bool leaves = i == path.nodes.size() || path.nodes[i].is_vertex() ||
                                    path.nodes[i].halfedge / 3 == f;
                if (inside && leaves)
                    chords[f].emplace_back(std::min(a, b), std::max(a, b));
            }
    std::size_t count = 0;
    for (const auto& face : chords)
        for (std::size_t i = 0; i < face.size(); ++i)
            for (std::size_t j = 0; j < i; ++j) {
                const auto [a, b] = face[i];
                const auto [c, d] = face[j];
                count += (a < c && c < b && b < d) || (c < a && a < d && d < b);
            }
    return count;
}

TEST(RouteFinder, a_route_over_a_flat_mesh_is_straight)
{
    const ManifoldMesh mesh = square(8);
    const Index a = 9, b = 8 + 9 * 4; // (0, 1/8) and (1, 1/2)
    PathWeb web(mesh, {a, b});
    RouteFinder finder(web);
    const auto route = route_between(web, finder, a, b);
    ASSERT_TRUE(route);
    web.add(*route);
    EXPECT_NEAR(length(mesh, web.paths()[0]), norm(mesh.position(a) - mesh.position(b)), 1e-12);
}

TEST(RouteFinder, goes_along_a_chain_of_edges_where_it_is_open)
{
    const ManifoldMesh mesh = square(4);
    const std::vector<Index> chain{11, 12, 13};
    PathWeb web(mesh, {11, 13, 7, 17});
    RouteFinder finder(web);
    const auto open = route_between(web, finder, 11, 13, chain);
    ASSERT_TRUE(open);
    EXPECT_EQ(open->along, chain);

    const auto across = route_between(web, finder, 7, 17);
    ASSERT_TRUE(across);
    EXPECT_TRUE(across->along.empty()) << "there is no edge from 7 to 17";
    web.add(*across);
    // From the one side of the new path to the other there is a way only around its ends.
    const auto around = route_between(web, finder, 11, 13, chain);
    ASSERT_TRUE(around);
    EXPECT_TRUE(around->along.empty());
    web.add(*around);
    EXPECT_GT(length(mesh, web.paths()[1]), 0.5);
    EXPECT_EQ(crossings(mesh, web.paths()), 0u);
}

TEST(PathWeb, a_path_that_is_taken_away_leaves_nothing)
{
    const ManifoldMesh mesh = square(4);
    PathWeb web(mesh, {6, 18, 11, 13, 8, 16});
    RouteFinder finder(web);
    web.add(*route_between(web, finder, 6, 18));
    const auto before = web.paths();
    const auto answer = route_between(web, finder, 11, 13);
    ASSERT_TRUE(answer);
    for (const std::vector<Index>& chain : {no_chain, std::vector<Index>{11, 12, 13}}) {
        const auto route = route_between(web, finder, 11, 13, chain);
        ASSERT_TRUE(route);
        web.add(*route);
        web.remove_last();
        EXPECT_EQ(web.path_count(), 1u);
        EXPECT_TRUE(web.ends(11).empty());
        const auto after = web.paths();
        ASSERT_EQ(after[0].nodes.size(), before[0].nodes.size());
        for (std::size_t i = 0; i < after[0].nodes.size(); ++i)
            EXPECT_EQ(after[0].nodes[i].t, before[0].nodes[i].t);
        const auto again = route_between(web, finder, 11, 13);
        ASSERT_TRUE(again);
        EXPECT_EQ(again->t, answer->t);
    }
}

TEST(PathWeb, paths_laid_at_random_never_cross)
{
    const ManifoldMesh mesh = icosphere(2);
    std::mt19937 random(5);
    std::vector<Index> sites;
    for (Index v = 0; v < mesh.vertex_count(); v += 7)
        sites.push_back(v);
    PathWeb web(mesh, sites);
    RouteFinder finder(web);
    std::size_t laid = 0;
    for (int i = 0; i < 60; ++i) {
        const Index a = sites[random() % sites.size()], b = sites[random() % sites.size()];
        if (a == b)
            continue;
        if (const auto route = route_between(web, finder, a, b)) {
            web.add(*route);
            ++laid;
        }
    }
    EXPECT_GT(laid, 10u);
    EXPECT_EQ(crossings(mesh, web.paths()), 0u);
}

} // namespace
} // namespace bot2nurbs::fixtures
