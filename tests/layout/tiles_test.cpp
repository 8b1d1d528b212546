// SPDX-License-Identifier: MIT
#include "layout/tiles.h"

#include "mesh_fixtures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace bot2nurbs::fixtures {
namespace {

std::vector<double> uniform(const ManifoldMesh& mesh)
{
    return std::vector<double>(mesh.vertex_count(), 1.0);
}

// Tiles with the conditions satisfied, from `count` sites.
Tiles sound_tiles(const ManifoldMesh& mesh, Index count)
{
    Tiles tiles(mesh, uniform(mesh));
    tiles.grow({0});
    tiles.add_farthest(count);
    for (;;) {
        const auto missing = tiles.violations();
        if (missing.empty())
            return tiles;
        tiles.add(missing);
    }
}

TEST(Tiles, distances_on_a_sphere_are_within_three_percent_of_great_circles)
{
    const ManifoldMesh mesh = icosphere(4);
    Tiles tiles(mesh, uniform(mesh));
    tiles.grow({0});
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
        const double angle = std::atan2(norm(cross(mesh.position(0), mesh.position(v))),
                                        dot(mesh.position(0), mesh.position(v)));
        EXPECT_NEAR(tiles.distances()[v], angle, 0.03 * angle + 1e-12);
    }
}

TEST(Tiles, every_vertex_has_the_label_of_a_neighbour_nearer_to_the_site)
{
    // So tiles are connected.
    const ManifoldMesh mesh = torus(24, 12);
    Tiles tiles(mesh, uniform(mesh));
    tiles.grow({0, 50, 100, 200});
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
        if (tiles.distances()[v] == 0.0)
            continue;
        bool found = false;
        Index h = mesh.halfedge_at(v);
        const Index first = h;
        do {
            const Index u = mesh.to(h);
            found = found || (tiles.labels()[u] == tiles.labels()[v] &&
                              tiles.distances()[u] < tiles.distances()[v]);
            h = mesh.twin(ManifoldMesh::prev(h));
        } while (h != first);
        EXPECT_TRUE(found) << v;
    }
}

TEST(Tiles, added_sites_give_the_labels_of_growing_anew)
{
    const ManifoldMesh mesh = icosphere(3);
    Tiles later(mesh, uniform(mesh)), at_once(mesh, uniform(mesh));
    later.grow({3, 77});
    later.add({200, 411});
    at_once.grow({3, 77, 200, 411});
    Index different = 0;
    for (Index v = 0; v < mesh.vertex_count(); ++v)
        different += later.labels()[v] != at_once.labels()[v];
    // Distances across faces depend a little on the order of growth: at the borders only.
    EXPECT_LE(different, mesh.vertex_count() / 50);
}

TEST(Tiles, with_every_vertex_a_site_nothing_is_violated)
{
    for (const auto& [name, mesh, genus] : closed_meshes()) {
        Tiles tiles(mesh, uniform(mesh));
        std::vector<Index> all(mesh.vertex_count());
        for (Index v = 0; v < all.size(); ++v)
            all[v] = v;
        tiles.grow(all);
        EXPECT_TRUE(tiles.violations().empty()) << name;
    }
}

TEST(Tiles, conditions_hold_in_the_end_and_give_the_euler_characteristic)
{
    for (const auto& [name, mesh, genus] : closed_meshes())
        for (const Index count : {1u, 4u, 10u, 30u}) {
            const Tiles tiles = sound_tiles(mesh, std::min(count, mesh.vertex_count()));
            // Junctions are the dual's faces; each has three sides: V - F / 2 = 2 - 2 g.
            int junctions = 0;
            for (Index f = 0; f < mesh.face_count(); ++f) {
                const auto& t = mesh.triangle(f);
                const auto& l = tiles.labels();
                junctions += l[t[0]] != l[t[1]] && l[t[1]] != l[t[2]] && l[t[2]] != l[t[0]];
            }
            EXPECT_EQ(static_cast<int>(tiles.sites().size()) - junctions / 2, 2 - 2 * genus)
                << name << " from " << count << " sites";
        }
}

TEST(Tiles, one_site_on_a_torus_is_a_violation)
{
    const ManifoldMesh mesh = torus(16, 9);
    Tiles tiles(mesh, uniform(mesh));
    tiles.grow({0});
    EXPECT_FALSE(tiles.violations().empty());
}

TEST(Tiles, are_narrower_where_the_density_is_higher)
{
    const ManifoldMesh mesh = icosphere(4);
    std::vector<double> density(mesh.vertex_count());
    for (Index v = 0; v < mesh.vertex_count(); ++v)
        density[v] = mesh.position(v).z > 0.0 ? 2.0 : 1.0;
    Tiles tiles(mesh, density);
    tiles.grow({0});
    tiles.add_farthest(100);
    Index above = 0;
    for (const Index s : tiles.sites())
        above += mesh.position(s).z > 0.0;
    EXPECT_NEAR(static_cast<double>(above), 80.0, 6.0);
}

TEST(Tiles, end_on_needles_and_on_edges_without_length)
{
    for (const double flat : {1e-6, 0.0}) {
        const ManifoldMesh mesh = moved(icosphere(2), [flat](const Vec3& p) {
            return Vec3{p.x, flat * p.y, flat * p.z};
        });
        const Tiles tiles = sound_tiles(mesh, 8);
        for (const Index s : tiles.sites())
            EXPECT_LT(s, mesh.vertex_count());
        EXPECT_TRUE(tiles.violations().empty());
    }
}

} // namespace
} // namespace bot2nurbs::fixtures
