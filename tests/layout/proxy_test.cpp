// SPDX-License-Identifier: MIT
#include "layout/proxy.h"

#include "layout/base_complex.h"
#include "layout/crease_fixtures.h"
#include "layout/cut_mesh.h"
#include "layout/place_sites.h"

#include <gtest/gtest.h>

#include <map>

namespace bot2nurbs::fixtures {
namespace {

LayoutLevel level_of(const CutMesh& cut, const ManifoldMesh& mesh,
                     const std::vector<FeaturePath>& features)
{
    std::vector<Index> name;
    for (Index v = 0; v < cut.mesh().vertex_count(); ++v)
        name.push_back(cut.original(v));
    return LayoutLevel(
        cut.mesh(), name, mesh.vertex_count(), std::vector<double>(name.size(), 1.0),
        trace_curves(mesh, mark_edges(mesh, features), std::vector<char>(mesh.vertex_count(), 0)));
}

// The base complex of a few sites on a level.
PatchComplex triangles_on(const LayoutLevel& level, Index sites)
{
    SitePlan plan;
    plan.width = 1.0;
    plan.inner = sites;
    Tiles tiles(level.mesh(), level.density());
    Context context;
    place_sites(level, plan, tiles, context);
    auto complex = build_base_complex(tiles, context);
    EXPECT_TRUE(complex.ok()) << complex.error().message;
    straighten_triangles(*complex, context);
    return std::move(*complex);
}

struct Case {
    std::string name;
    ManifoldMesh mesh;
    std::vector<FeaturePath> features;
    double width;
};

std::vector<Case> cases()
{
    return {{"sphere", icosphere(4), {}, 0.25},
            {"torus", torus(60, 30), {}, 0.3},
            {"genus_two", genus_two(2), {}, 0.6},
            {"square", square(30), {}, 0.12},
            {"cube", cube(14), crease_paths(cube(14)), 0.3}};
}

TEST(Proxy, has_the_topology_of_the_mesh_and_fewer_faces)
{
    for (const Case& c : cases()) {
        const CutMesh cut(c.mesh, mark_edges(c.mesh, c.features));
        const LayoutLevel fine = level_of(cut, c.mesh, c.features);
        Context context;
        const auto proxy = Proxy::build(fine, c.width, context);
        ASSERT_TRUE(proxy.ok()) << c.name << ": " << proxy.error().message;
        const ManifoldMesh& coarse = proxy->level().mesh();
        EXPECT_LT(2 * coarse.face_count(), fine.mesh().face_count()) << c.name;
        const auto euler = [](const ManifoldMesh& m) {
            return static_cast<int>(m.vertex_count() + m.face_count()) -
                   static_cast<int>(m.edge_count());
        };
        EXPECT_EQ(euler(coarse), euler(fine.mesh())) << c.name;
        EXPECT_EQ(proxy->level().region_count(), fine.region_count());
        for (Index v = 0; v < coarse.vertex_count(); ++v)
            EXPECT_EQ(coarse.position(v), c.mesh.position(proxy->level().name(v)));
    }
}

TEST(Proxy, lifts_a_complex_to_one_that_covers_the_mesh_once)
{
    for (const Case& c : cases()) {
        const CutMesh cut(c.mesh, mark_edges(c.mesh, c.features));
        const LayoutLevel fine = level_of(cut, c.mesh, c.features);
        Context context;
        const auto proxy = Proxy::build(fine, c.width, context);
        ASSERT_TRUE(proxy.ok());
        const PatchComplex coarse = triangles_on(proxy->level(), 12);
        const auto lifted = proxy->lift(coarse, context);
        ASSERT_TRUE(lifted.ok()) << c.name << ": " << lifted.error().message;
        ASSERT_EQ(lifted->face_count(), coarse.face_count());
        OverlayBuilder builder(fine.mesh());
        double covered = 0.0, whole = 0.0;
        for (const auto& face : lifted->faces()) {
            const auto overlay = builder.disk(lifted->geometry(face.sides));
            ASSERT_TRUE(overlay) << c.name;
            ASSERT_TRUE(map_to_polygon(*overlay, regular_polygon(3))) << c.name;
            for (const auto& t : overlay->triangles)
                covered +=
                    0.5 * norm(cross(
                              overlay->vertices[t[1]].position - overlay->vertices[t[0]].position,
                              overlay->vertices[t[2]].position - overlay->vertices[t[0]].position));
        }
        for (Index f = 0; f < fine.mesh().face_count(); ++f)
            whole += 0.5 * norm(fine.mesh().area_vector(f));
        EXPECT_NEAR(covered, whole, 1e-9 * whole) << c.name;
        std::map<std::pair<Index, double>, int> crossings;
        for (const auto& path : lifted->paths())
            for (const PathNode& n : path.geometry.nodes)
                if (!n.is_vertex()) {
                    const std::pair<Index, double> place(fine.mesh().edge(n.halfedge), n.t);
                    EXPECT_EQ(++crossings[place], 1) << c.name;
                }
    }
}

} // namespace
} // namespace bot2nurbs::fixtures
