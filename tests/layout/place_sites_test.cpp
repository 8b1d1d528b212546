// SPDX-License-Identifier: MIT
#include "layout/place_sites.h"

#include "layout/tiles.h"
#include "mesh_fixtures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace bot2nurbs::fixtures {
namespace {

//! A torus whose vertices crowd on one side: there they have a twentieth of the area of those
//! opposite.
ManifoldMesh crowded_torus()
{
    return moved(torus(96, 32), [](const Vec3& p) {
        const double a = std::atan2(p.y, p.x), r = std::hypot(p.x, p.y);
        const double b = a + 0.9 * std::sin(a);
        return Vec3{-r * std::cos(b), -r * std::sin(b), p.z};
    });
}

LayoutLevel level_of(const ManifoldMesh& mesh)
{
    std::vector<Index> names(mesh.vertex_count());
    std::iota(names.begin(), names.end(), Index{0});
    return {mesh,
            std::move(names),
            mesh.vertex_count(),
            std::vector<double>(mesh.vertex_count(), 1.0),
            {}};
}

TEST(PlaceSites, sites_are_spread_by_area_where_others_have_more_than_a_share_each)
{
    const ManifoldMesh mesh = crowded_torus();
    const LayoutLevel level = level_of(mesh);
    double total = 0.0;
    std::vector<double> area(mesh.vertex_count(), 0.0);
    for (Index f = 0; f < mesh.face_count(); ++f)
        for (const Index v : mesh.triangle(f)) {
            area[v] += norm(mesh.area_vector(f)) / 6.0;
            total += norm(mesh.area_vector(f)) / 6.0;
        }
    SitePlan plan;
    plan.spread = true;
    plan.inner = 1500;
    Tiles tiles(mesh, level.density());
    const Context context;
    const Index added = place_sites(level, plan, tiles, context);
    // Vertices with much less than a share have as many sites as their area asks for.
    const double share = total / plan.inner;
    double wanted = 0.0;
    for (const double a : area)
        wanted += a < 0.25 * share ? a / share : 0.0;
    int sites = 0;
    for (std::size_t i = 0; i + added < tiles.sites().size(); ++i)
        sites += area[tiles.sites()[i]] < 0.25 * share;
    ASSERT_GT(wanted, 100.0);
    EXPECT_NEAR(sites, wanted, 0.1 * wanted);
}

} // namespace
} // namespace bot2nurbs::fixtures
