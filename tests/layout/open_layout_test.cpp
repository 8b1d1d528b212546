// SPDX-License-Identifier: MIT
#include "bot2nurbs/layout.h"
#include "bot2nurbs/validate_domain.h"
#include "layout/base_complex.h"
#include "layout/cut_mesh.h"
#include "layout/even_regions.h"
#include "layout/place_sites.h"

#include "layout/crease_fixtures.h"

#include <gtest/gtest.h>

namespace bot2nurbs::fixtures {
namespace {

// The level of a mesh cut along features, and what it refers to.
struct CutLevel {
    CutMesh cut;
    LayoutLevel level;

    CutLevel(const ManifoldMesh& mesh, const std::vector<FeaturePath>& features)
        : cut(mesh, mark_edges(mesh, features)), level(make(mesh, features))
    {
    }

private:
    LayoutLevel make(const ManifoldMesh& mesh, const std::vector<FeaturePath>& features) const
    {
        std::vector<Index> name;
        for (Index v = 0; v < cut.mesh().vertex_count(); ++v)
            name.push_back(cut.original(v));
        return LayoutLevel(cut.mesh(), name, mesh.vertex_count(),
                           std::vector<double>(name.size(), 1.0),
                           trace_curves(mesh, mark_edges(mesh, features),
                                        std::vector<char>(mesh.vertex_count(), 0)));
    }
};

struct Case {
    std::string name;
    ManifoldMesh mesh;
    std::vector<FeaturePath> features;
};

std::vector<Case> cases()
{
    const ManifoldMesh plate = holed_plate(1, 2);
    std::vector<Case> result{
        {"square", square(6), {}},
        {"cylinder", open_cylinder(16, 6), {}},
        {"cube", cube(4), crease_paths(cube(4))},
        {"slit", square(8), {{FeatureKind::crease, straight_run(square(8), 4)}}},
        {"polycube", polycube({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}), {}}};
    result.back().mesh = split_in_four(result.back().mesh);
    result.back().features = crease_paths(result.back().mesh);
    return result;
}

TEST(OpenTiles, give_a_sound_base_complex_with_the_boundary_as_its_paths)
{
    for (const Case& c : cases()) {
        const CutLevel cut(c.mesh, c.features);
        const ManifoldMesh& mesh = cut.level.mesh();
        for (const double width : {0.2, 0.5, 2.0}) {
            SitePlan plan;
            plan.width = width;
            plan.inner = static_cast<Index>(1.0 / (width * width));
            plan.relaxations = 2;
            Context context;
            Tiles tiles(mesh, cut.level.density());
            place_sites(cut.level, plan, tiles, context);
            EXPECT_TRUE(tiles.violations().empty()) << c.name;
            const auto complex = build_base_complex(tiles, context);
            ASSERT_TRUE(complex.ok()) << c.name << ": " << complex.error().message;
            double covered = 0.0, border = 0.0, rim = 0.0, whole = 0.0;
            OverlayBuilder builder(mesh);
            for (const auto& face : complex->faces()) {
                const auto overlay = builder.disk(complex->geometry(face.sides));
                ASSERT_TRUE(overlay) << c.name;
                ASSERT_TRUE(map_to_polygon(*overlay, regular_polygon(3))) << c.name;
                for (const auto& t : overlay->triangles)
                    covered += 0.5 * norm(cross(overlay->vertices[t[1]].position -
                                                    overlay->vertices[t[0]].position,
                                                overlay->vertices[t[2]].position -
                                                    overlay->vertices[t[0]].position));
            }
            for (Index f = 0; f < mesh.face_count(); ++f)
                whole += 0.5 * norm(mesh.area_vector(f));
            for (Index h = 0; h < mesh.halfedge_count(); ++h)
                if (mesh.twin(h) == invalid_index)
                    rim += norm(mesh.position(mesh.to(h)) - mesh.position(mesh.from(h)));
            for (Index p = 0; p < complex->paths().size(); ++p)
                if (complex->is_boundary(p))
                    border += length(mesh, complex->paths()[p].geometry);
            EXPECT_NEAR(covered, whole, 1e-9 * whole) << c.name;
            EXPECT_NEAR(border, rim, 1e-9 * rim) << c.name;
        }
    }
}

TEST(OpenTiles, every_copy_of_a_curve_vertex_is_a_site_or_none_is)
{
    const ManifoldMesh mesh = cube(6);
    const CutLevel cut(mesh, crease_paths(mesh));
    SitePlan plan;
    plan.width = 0.3;
    Tiles tiles(cut.level.mesh(), cut.level.density());
    Context context;
    place_sites(cut.level, plan, tiles, context);
    std::vector<int> sites(mesh.vertex_count(), 0), copies(mesh.vertex_count(), 0);
    for (Index v = 0; v < cut.level.mesh().vertex_count(); ++v)
        ++copies[cut.level.name(v)];
    for (const Index s : tiles.sites())
        ++sites[cut.level.name(s)];
    for (Index n = 0; n < mesh.vertex_count(); ++n)
        EXPECT_TRUE(sites[n] == 0 || sites[n] == copies[n]);
}

TEST(EvenRegions, get_an_even_number_of_sites_on_the_boundary_of_each)
{
    for (const Case& c : cases()) {
        const CutLevel cut(c.mesh, c.features);
        const LayoutLevel& level = cut.level;
        for (const double width : {0.17, 0.29, 0.43, 0.71, 1.3}) {
            SitePlan plan;
            plan.width = width;
            plan.even_regions = true;
            Tiles tiles(level.mesh(), level.density());
            Context context;
            place_sites(level, plan, tiles, context);
            std::vector<int> count(level.region_count(), 0);
            for (const Index s : tiles.sites())
                count[level.regions()[s]] += level.mesh().is_boundary_vertex(s);
            for (const int n : count)
                EXPECT_EQ(n % 2, 0) << c.name << " width " << width;
        }
    }
}

TEST(OpenLayout, is_a_valid_domain_with_the_boundary_and_creases_of_its_source)
{
    for (const Case& c : cases())
        for (const bool split : {false, true})
            for (const Index patches : {8u, 60u}) {
                LayoutOptions options;
                options.features = c.features;
                options.patches = patches;
                options.split_triangles = split;
                Context context;
                const auto layout = build_layout(c.mesh, options, context);
                ASSERT_TRUE(layout.ok()) << c.name << ": " << layout.error().message;
                QuadDomain domain = layout->domain;
                domain.source_signature = signature(c.mesh);
                const auto validation = validate_domain(c.mesh, domain, context);
                ASSERT_TRUE(validation.ok());
                EXPECT_TRUE(validation->valid())
                    << c.name << ": "
                    << (validation->defects.empty() ? "" : validation->defects[0].message);
                double creased = 0.0, expected = 0.0;
                for (Index e = 0; e < domain.edges.size(); ++e)
                    if (domain.edges[e].crease) {
                        Vec3 last =
                            domain.carrier.mesh.position(domain.vertices[domain.edges[e].a]);
                        std::vector<Vec3> points;
                        for (const PathPoint& p : domain.edges[e].path) {
                            ASSERT_TRUE(p.is_vertex());
                            points.push_back(domain.carrier.mesh.position(p.from));
                        }
                        points.push_back(
                            domain.carrier.mesh.position(domain.vertices[domain.edges[e].b]));
                        for (const Vec3& p : points) {
                            creased += norm(p - last);
                            last = p;
                        }
                    }
                for (const FeaturePath& f : c.features)
                    for (std::size_t i = 0; i + 1 < f.vertices.size(); ++i)
                        expected += norm(c.mesh.position(f.vertices[i + 1]) -
                                         c.mesh.position(f.vertices[i]));
                EXPECT_NEAR(creased, expected, 1e-9 * (1.0 + expected)) << c.name;
            }
}

TEST(OpenLayout, of_a_cube_with_its_edges_can_be_one_quad_a_side)
{
    const ManifoldMesh mesh = cube(6);
    LayoutOptions options;
    options.features = crease_paths(mesh);
    options.patches = 6;
    Context context;
    const auto layout = build_layout(mesh, options, context);
    ASSERT_TRUE(layout.ok()) << layout.error().message;
    EXPECT_EQ(layout->domain.complex.quad_count(), 6u);
    EXPECT_EQ(layout->domain.complex.vertex_count(), 8u);
}

} // namespace
} // namespace bot2nurbs::fixtures
