// SPDX-License-Identifier: MIT
#include "maps/retile.h"

#include "maps/patches.h"
#include "mesh_fixtures.h"

#include <gtest/gtest.h>

namespace bot2nurbs::fixtures {
namespace {

// The three great-circle quarters that bound one octant of the sphere, as edge paths of an
// octahedron split in four `levels` times, walked through the vertices of one coordinate plane.
SurfacePath quarter(const ManifoldMesh& mesh, Index from, Index to)
{
    std::vector<Index> walk{from};
    while (walk.back() != to) {
        Index best = invalid_index;
        double best_distance = norm(mesh.position(walk.back()) - mesh.position(to));
        const Vec3 n = cross(mesh.position(from), mesh.position(to));
        Index h = mesh.halfedge_at(walk.back());
        const Index first = h;
        do {
            const Vec3 p = mesh.position(mesh.to(h));
            if (std::fabs(dot(n, p)) < 1e-9 && norm(p - mesh.position(to)) < best_distance) {
                best = mesh.to(h);
                best_distance = norm(p - mesh.position(to));
            }
            h = mesh.twin(ManifoldMesh::prev(h));
        } while (h != first);
        walk.push_back(best);
    }
    return edge_path(walk);
}

struct Octants {
    ManifoldMesh mesh = split_in_four(split_in_four(split_in_four(octahedron())));
    Index x, y, z, minus_x;
    Octants()
    {
        const auto at = [this](const Vec3& p) {
            Index best = 0;
            for (Index v = 0; v < mesh.vertex_count(); ++v)
                if (norm(mesh.position(v) - p) < norm(mesh.position(best) - p))
                    best = v;
            return best;
        };
        x = at({1, 0, 0}), y = at({0, 1, 0}), z = at({0, 0, 1}), minus_x = at({-1, 0, 0});
    }
};

// Faces of consecutive points agree, and no edge is crossed forth and back.
void expect_sound(const ManifoldMesh& mesh, const SurfacePath& path)
{
    for (std::size_t i = 0; i + 1 < path.nodes.size(); ++i) {
        const PathNode &p = path.nodes[i], &q = path.nodes[i + 1];
        ASSERT_FALSE(p.is_vertex() || q.is_vertex());
        EXPECT_EQ(ManifoldMesh::face(mesh.twin(p.halfedge)), ManifoldMesh::face(q.halfedge));
        EXPECT_NE(mesh.twin(p.halfedge), q.halfedge);
        EXPECT_GT(p.t, 0.0);
        EXPECT_LT(p.t, 1.0);
    }
    if (!path.nodes.empty()) {
        EXPECT_EQ(mesh.from(ManifoldMesh::prev(path.nodes.front().halfedge)), path.a);
        EXPECT_EQ(mesh.from(ManifoldMesh::prev(mesh.twin(path.nodes.back().halfedge))), path.b);
    }
}

TEST(Retile, the_diagonal_of_two_octants_divides_them_into_two_disks_of_equal_area)
{
    const Octants o;
    OverlayBuilder builder(o.mesh);
    // Octants x y z and y -x z: a square with corners x, y, -x, z; the diagonal x .. -x is new.
    const SurfacePath xy = quarter(o.mesh, o.x, o.y), yx = quarter(o.mesh, o.y, o.minus_x);
    const SurfacePath xz = quarter(o.mesh, o.minus_x, o.z), zx = quarter(o.mesh, o.z, o.x);
    const std::vector<PathSide> border{{&xy, false}, {&yx, false}, {&xz, false}, {&zx, false}};
    const auto whole = builder.disk(border);
    ASSERT_TRUE(whole);
    const auto disk = map_disk(builder, border);
    ASSERT_TRUE(disk);
    const auto paths = retile(o.mesh, *disk, {{0, 2}});
    ASSERT_TRUE(paths);
    expect_sound(o.mesh, paths->front());
    const SurfacePath& d = paths->front();
    const auto low = builder.disk({{&xy, false}, {&yx, false}, {&d, true}});
    const auto high = builder.disk({{&d, false}, {&xz, false}, {&zx, false}});
    ASSERT_TRUE(low && high);
    EXPECT_NEAR(area_in_space(*low) + area_in_space(*high), area_in_space(*whole), 1e-12);
    EXPECT_NEAR(area_in_space(*low), area_in_space(*high), 0.05 * area_in_space(*whole));
}

TEST(Retile, spokes_to_a_centre_divide_a_disk_into_disjoint_sectors)
{
    const Octants o;
    OverlayBuilder builder(o.mesh);
    const SurfacePath xy = quarter(o.mesh, o.x, o.y), yx = quarter(o.mesh, o.y, o.minus_x);
    const SurfacePath xz = quarter(o.mesh, o.minus_x, o.z), zx = quarter(o.mesh, o.z, o.x);
    const std::vector<SurfacePath> ring{xy, yx, xz, zx};
    std::vector<PathSide> border;
    for (const SurfacePath& p : ring)
        border.push_back({&p, false});
    const auto whole = builder.disk(border);
    ASSERT_TRUE(whole);
    int tried = 0;
    for (std::size_t v = whole->boundary_count; v < whole->vertices.size(); v += 3) {
        const Index center = whole->vertices[v].mesh_vertex;
        if (center == invalid_index)
            continue;
        const Index none = invalid_index;
        const auto disk = map_disk(builder, border);
        ASSERT_TRUE(disk);
        const auto spokes =
            retile(o.mesh, *disk, {{0, none}, {1, none}, {2, none}, {3, none}}, center);
        ASSERT_TRUE(spokes);
        double area = 0.0;
        for (std::size_t s = 0; s < 4; ++s) {
            expect_sound(o.mesh, (*spokes)[s]);
            const auto sector = builder.disk(
                {{&ring[s], false}, {&(*spokes)[(s + 1) % 4], false}, {&(*spokes)[s], true}});
            ASSERT_TRUE(sector) << "centre " << center;
            ASSERT_TRUE(map_to_polygon(*sector, regular_polygon(3)));
            area += area_in_space(*sector);
        }
        EXPECT_NEAR(area, area_in_space(*whole), 1e-12);
        ++tried;
    }
    EXPECT_GT(tried, 5);
}

TEST(Retile, several_chords_from_one_corner_keep_their_order_on_every_edge)
{
    const Octants o;
    OverlayBuilder builder(o.mesh);
    // The star of an octant's corner, divided by a fan from one of its border vertices.
    std::vector<Index> ring;
    Index h = o.mesh.halfedge_at(o.x);
    const Index first = h;
    do {
        ring.push_back(o.mesh.to(h));
        h = o.mesh.twin(ManifoldMesh::prev(h));
    } while (h != first);
    std::vector<SurfacePath> sides;
    for (std::size_t i = 0; i < ring.size(); ++i)
        sides.push_back(edge_path({ring[i], ring[(i + 1) % ring.size()]}));
    std::vector<PathSide> border;
    for (const SurfacePath& p : sides)
        border.push_back({&p, false});
    std::vector<std::pair<Index, Index>> chords;
    for (Index k = 2; k + 1 < ring.size(); ++k)
        chords.emplace_back(0, k);
    const auto disk = map_disk(builder, border);
    ASSERT_TRUE(disk);
    const auto paths = retile(o.mesh, *disk, chords);
    ASSERT_TRUE(paths);
    std::vector<std::pair<Index, double>> crossings;
    for (const SurfacePath& p : *paths) {
        expect_sound(o.mesh, p);
        for (const PathNode& n : p.nodes)
            crossings.emplace_back(o.mesh.edge(n.halfedge), n.t);
    }
    std::sort(crossings.begin(), crossings.end());
    EXPECT_EQ(std::adjacent_find(crossings.begin(), crossings.end()), crossings.end());
    // Each triangle of the fan is a disk.
    const Index n = static_cast<Index>(ring.size());
    for (Index k = 1; k + 1 < n; ++k) {
        const PathSide in = k == 1 ? PathSide{&sides[0], false} : PathSide{&(*paths)[k - 2], false};
        const PathSide out =
            k + 2 == n ? PathSide{&sides[n - 1], false} : PathSide{&(*paths)[k - 1], true};
        EXPECT_TRUE(builder.disk({in, {&sides[k], false}, out}));
    }
}

TEST(SurfacePath, reduction_removes_detours_that_hold_no_vertex)
{
    const ManifoldMesh mesh = icosphere(1);
    SurfacePath path = crossing_path(mesh, 0, 0.5);
    const PathNode node = path.nodes[0];
    PathNode back = node;
    back.halfedge = mesh.twin(node.halfedge);
    path.nodes = {node, back, node};
    reduce(mesh, path);
    ASSERT_EQ(path.nodes.size(), 1u);
    EXPECT_EQ(path.nodes[0].halfedge, node.halfedge);
    // Leaving a vertex across an edge that starts there.
    SurfacePath turned = crossing_path(mesh, 0, 0.5);
    PathNode around;
    around.halfedge = mesh.halfedge_at(turned.a);
    around.t = 0.5;
    turned.nodes.insert(turned.nodes.begin(), around);
    reduce(mesh, turned);
    EXPECT_EQ(turned.nodes.size(), 1u);
}

TEST(SurfacePath, reduction_keeps_paths_side_by_side_in_order_whichever_way_they_run)
{
    // Two paths side by side cross an edge forth, back and forth again, in the bends of an S.
    const ManifoldMesh mesh = icosphere(1);
    const PathNode crossing = crossing_path(mesh, 0, 0.5).nodes[0];
    const auto s_shaped = [&](const std::array<double, 3>& t, bool turned) {
        SurfacePath path = crossing_path(mesh, 0, 0.5);
        path.nodes.clear();
        for (std::size_t i = 0; i < 3; ++i) {
            PathNode node = crossing;
            if ((i == 1) != turned)
                node.halfedge = mesh.twin(crossing.halfedge);
            node.t = t[turned ? 2 - i : i];
            path.nodes.push_back(node);
        }
        if (turned)
            std::swap(path.a, path.b);
        reduce(mesh, path);
        EXPECT_EQ(path.nodes.size(), 1u);
        return path.nodes[0].t;
    };
    const std::array<double, 3> outer{0.1, 0.5, 0.6}, inner{0.2, 0.4, 0.7};
    for (const bool outer_turned : {false, true})
        for (const bool inner_turned : {false, true})
            EXPECT_LT(s_shaped(outer, outer_turned), s_shaped(inner, inner_turned))
                << outer_turned << inner_turned;
}

TEST(SurfacePath, reduction_sees_that_a_detour_within_a_detour_is_of_the_same_edge)
{
    const ManifoldMesh mesh = icosphere(1);
    SurfacePath path = crossing_path(mesh, 0, 0.5);
    PathNode forth = path.nodes[0], back = forth, aside = forth, aside_back = forth;
    back.halfedge = mesh.twin(forth.halfedge);
    // Back in the first face, the path leaves it by another edge and returns.
    aside.halfedge = mesh.next(forth.halfedge);
    aside_back.halfedge = mesh.twin(aside.halfedge);
    forth.t = 0.3;
    back.t = 0.2;
    PathNode again = forth;
    again.t = 0.4;
    for (const bool turned : {false, true}) {
        path.nodes = {forth, back, aside, aside_back, again};
        if (turned) {
            std::reverse(path.nodes.begin(), path.nodes.end());
            for (PathNode& n : path.nodes)
                n.halfedge = mesh.twin(n.halfedge);
        }
        reduce(mesh, path);
        ASSERT_EQ(path.nodes.size(), 1u);
        EXPECT_EQ(path.nodes[0].t, 0.2);
    }
}

} // namespace
} // namespace bot2nurbs::fixtures
