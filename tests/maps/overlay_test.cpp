// SPDX-License-Identifier: MIT
#include "maps/overlay.h"

#include "maps/patches.h"
#include "mesh_fixtures.h"

#include <gtest/gtest.h>

namespace bot2nurbs::fixtures {
namespace {

// The three edges of a face as paths.
std::vector<SurfacePath> face_edges(const ManifoldMesh& mesh, Index f)
{
    const auto& t = mesh.triangle(f);
    return {edge_path({t[0], t[1]}), edge_path({t[1], t[2]}), edge_path({t[2], t[0]})};
}

TEST(Overlay, of_one_face_is_that_face)
{
    const ManifoldMesh mesh = icosahedron();
    OverlayBuilder builder(mesh);
    const auto edges = face_edges(mesh, 5);
    const auto overlay = builder.disk({{&edges[0], false}, {&edges[1], false}, {&edges[2], false}});
    ASSERT_TRUE(overlay);
    EXPECT_EQ(overlay->triangles.size(), 1u);
    EXPECT_EQ(overlay->face[0], 5u);
    EXPECT_EQ(overlay->boundary_count, 3u);
}

TEST(Overlay, walked_the_other_way_round_is_all_the_rest)
{
    const ManifoldMesh mesh = icosahedron();
    OverlayBuilder builder(mesh);
    const auto edges = face_edges(mesh, 5);
    const auto overlay = builder.disk({{&edges[2], true}, {&edges[1], true}, {&edges[0], true}});
    ASSERT_TRUE(overlay);
    EXPECT_NEAR(area_in_space(*overlay), surface_area(mesh) * 19.0 / 20.0, 1e-12);
}

TEST(Overlay, cuts_faces_along_a_path_into_pieces_that_add_up)
{
    // Two faces of an edge, cut by the other diagonal: each half holds a part of both faces.
    const ManifoldMesh mesh = icosphere(2);
    OverlayBuilder builder(mesh);
    for (Index h = 0; h < mesh.halfedge_count(); h += 7) {
        const SurfacePath across = crossing_path(mesh, h, 0.3);
        const SurfacePath up = edge_path({across.b, mesh.to(h)});
        const SurfacePath back = edge_path({mesh.to(h), across.a});
        const auto half = builder.disk({{&across, false}, {&up, false}, {&back, false}});
        const SurfacePath down = edge_path({across.a, mesh.from(h)});
        const SurfacePath forth = edge_path({mesh.from(h), across.b});
        const auto other = builder.disk({{&across, true}, {&down, false}, {&forth, false}});
        ASSERT_TRUE(half && other);
        const double both = 0.5 * norm(mesh.area_vector(ManifoldMesh::face(h))) +
                            0.5 * norm(mesh.area_vector(ManifoldMesh::face(mesh.twin(h))));
        EXPECT_NEAR(area_in_space(*half) + area_in_space(*other), both, 1e-14);
        const double t = mesh.edge(h) == h ? 0.3 : 0.7; // From from(h).
        EXPECT_NEAR(area_in_space(*half), (1.0 - t) * both, 1e-14);
    }
}

TEST(Overlay, vertices_lie_where_their_weights_say)
{
    const ManifoldMesh mesh = icosphere(1);
    OverlayBuilder builder(mesh);
    const SurfacePath across = crossing_path(mesh, 0, 0.25);
    const SurfacePath up = edge_path({across.b, mesh.to(0)});
    const SurfacePath back = edge_path({mesh.to(0), across.a});
    const auto overlay = builder.disk({{&back, true}, {&up, true}, {&across, true}});
    ASSERT_TRUE(overlay);
    for (std::size_t t = 0; t < overlay->triangles.size(); ++t)
        for (const Index v : overlay->triangles[t]) {
            const SourcePoint p{overlay->face[t], overlay->bary_in(mesh, v, overlay->face[t])};
            EXPECT_NEAR(p.bary[0] + p.bary[1] + p.bary[2], 1.0, 1e-15);
            EXPECT_LT(norm(mesh.at(p) - overlay->vertices[v].position), 1e-15);
        }
}

TEST(Overlay, of_a_region_with_a_handle_is_refused)
{
    // On a torus, what lies outside one face is no disk.
    const ManifoldMesh mesh = torus(8, 6);
    OverlayBuilder builder(mesh);
    const auto edges = face_edges(mesh, 0);
    EXPECT_FALSE(builder.disk({{&edges[2], true}, {&edges[1], true}, {&edges[0], true}}));
}

TEST(Overlay, splits_edges_that_join_two_points_of_one_side)
{
    // Where a side runs over three vertices of a star, no triangle may have all its corners on it:
    // on the straight side of a polygon it would collapse.
    const ManifoldMesh mesh = icosphere(1);
    OverlayBuilder builder(mesh);
    const Index v = 0;
    std::vector<Index> ring;
    Index h = mesh.halfedge_at(v);
    const Index first = h;
    do {
        ring.push_back(mesh.to(h));
        h = mesh.twin(ManifoldMesh::prev(h));
    } while (h != first);
    // Three sides around the star of v, the first of them through three vertices of the ring.
    ASSERT_GE(ring.size(), 5u);
    std::vector<Index> last(ring.begin() + 3, ring.end());
    last.push_back(ring[0]);
    const SurfacePath a = edge_path({ring[0], ring[1], ring[2]}), b = edge_path({ring[2], ring[3]}),
                      c = edge_path(last);
    const auto overlay = builder.disk({{&a, false}, {&b, false}, {&c, false}});
    ASSERT_TRUE(overlay);
    for (const auto& t : overlay->triangles) {
        int on_first = 0;
        for (const Index w : t)
            on_first += w <= 2;
        EXPECT_LT(on_first, 3);
    }
}

TEST(Overlay, tiles_of_any_labelling_into_disks_cover_the_mesh_once)
{
    const ManifoldMesh mesh = icosphere(2);
    OverlayBuilder builder(mesh);
    // Label by nearest of six axis points: each tile is a cap.
    std::vector<Index> label(mesh.vertex_count());
    const Vec3 axis[6] = {{1, .1, .2},  {-1, .1, .1}, {.1, 1, .2},
                          {.2, -1, .1}, {.1, .2, 1},  {0, 0, -1}};
    for (Index v = 0; v < mesh.vertex_count(); ++v)
        for (Index k = 1; k < 6; ++k)
            if (dot(mesh.position(v), axis[k]) > dot(mesh.position(v), axis[label[v]]))
                label[v] = k;
    double area = 0.0;
    for (Index k = 0; k < 6; ++k) {
        std::vector<Index> members, neighbour;
        for (Index v = 0; v < mesh.vertex_count(); ++v)
            if (label[v] == k)
                members.push_back(v);
        const auto tile = builder.tile(label, members, members.front(), neighbour);
        ASSERT_TRUE(tile);
        EXPECT_EQ(neighbour.size(), tile->side_count());
        EXPECT_GE(tile->side_count(), 3u);
        area += area_in_space(*tile);
    }
    EXPECT_NEAR(area, surface_area(mesh), 1e-12);
}

} // namespace
} // namespace bot2nurbs::fixtures
