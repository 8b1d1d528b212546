// SPDX-License-Identifier: MIT
#include "bot2nurbs/check_mesh.h"

#include "mesh/features.h"
#include "mesh_fixtures.h"

#include <gtest/gtest.h>

#include <set>

using namespace bot2nurbs;
namespace fx = bot2nurbs::fixtures;

namespace {

MeshReport check(const TriangleSoup& soup)
{
    Context context;
    return check_mesh(soup, context);
}

//! The codes of all defects, and the count and first element of one of them.
std::set<std::string> codes(const MeshReport& report)
{
    std::set<std::string> all;
    for (const MeshDefect& d : report.defects)
        all.insert(d.code);
    return all;
}
MeshDefect defect(const MeshReport& report, const std::string& code)
{
    for (const MeshDefect& d : report.defects)
        if (d.code == code)
            return d;
    return {};
}

} // namespace

TEST(CheckMesh, finds_nothing_wrong_with_closed_fixtures)
{
    for (const auto& [name, mesh, genus] : fx::closed_meshes()) {
        SCOPED_TRACE(name);
        const MeshReport report = check(fx::soup_of(mesh));
        EXPECT_TRUE(report.defects.empty());
        EXPECT_TRUE(report.closed && report.manifold && report.oriented && report.orientable);
        ASSERT_EQ(report.components.size(), 1u);
        const ComponentReport& c = report.components[0];
        EXPECT_EQ(c.genus, genus);
        EXPECT_EQ(c.faces, mesh.face_count());
        EXPECT_EQ(c.edges, mesh.edge_count());
        EXPECT_EQ(c.vertices, mesh.vertex_count());
        EXPECT_NEAR(c.volume, mesh.volume(), 1e-12 * mesh.volume());
    }
}

TEST(CheckMesh, boundary_loops_go_round_the_holes)
{
    const MeshReport report = check(fx::soup_of(fx::open_cylinder(9, 3)));
    EXPECT_EQ(codes(report), std::set<std::string>{"open_boundary"});
    EXPECT_FALSE(report.closed);
    ASSERT_EQ(report.boundary_loops.size(), 2u);
    const ManifoldMesh mesh = fx::open_cylinder(9, 3);
    for (const auto& loop : report.boundary_loops) {
        ASSERT_EQ(loop.size(), 9u);
        for (std::size_t i = 0; i < loop.size(); ++i) {
            // Against the halfedges: the hole lies on the left.
            const Index h = mesh.find_halfedge(loop[(i + 1) % 9], loop[i]);
            ASSERT_NE(h, invalid_index);
            EXPECT_EQ(mesh.twin(h), invalid_index);
        }
    }
    EXPECT_EQ(report.components[0].boundary_loops, 2u);
    EXPECT_EQ(report.components[0].genus, 0);
}

TEST(CheckMesh, counts_and_names_each_defect)
{
    const TriangleSoup good = fx::soup_of(fx::icosphere(1));
    const Index faces = static_cast<Index>(good.triangles.size());
    const Index vertices = static_cast<Index>(good.positions.size());

    TriangleSoup soup = good;
    soup.triangles.push_back({0, 1, 99999});
    soup.triangles.push_back({0, 0, 1});
    MeshReport report = check(soup);
    EXPECT_EQ(codes(report), (std::set<std::string>{"invalid_index", "repeated_vertex"}));
    EXPECT_EQ(defect(report, "invalid_index").element, faces);
    EXPECT_EQ(defect(report, "repeated_vertex").element, faces + 1);

    soup = good;
    soup.positions.push_back({NAN, 0, 0});
    soup.triangles.push_back({0, 1, vertices});
    report = check(soup);
    EXPECT_EQ(defect(report, "non_finite").element, faces);
    EXPECT_EQ(defect(report, "non_finite").count, 1u);

    soup = good;
    soup.positions.push_back({7, 7, 7});
    soup.positions.push_back(soup.positions[3]);
    report = check(soup);
    EXPECT_EQ(codes(report), (std::set<std::string>{"unreferenced_vertex", "weldable_vertex"}));
    EXPECT_EQ(defect(report, "unreferenced_vertex").count, 2u);
    EXPECT_EQ(defect(report, "weldable_vertex").element, vertices + 1);

    soup = good;
    soup.triangles.push_back({soup.triangles[5][1], soup.triangles[5][0], soup.triangles[5][2]});
    report = check(soup);
    EXPECT_EQ(defect(report, "duplicate_face").element, faces);
    EXPECT_EQ(defect(report, "nonmanifold_edge").count, 3u);

    soup = good;
    std::swap(soup.triangles[8][0], soup.triangles[8][1]);
    report = check(soup);
    EXPECT_EQ(codes(report), std::set<std::string>{"inconsistent_orientation"});
    EXPECT_EQ(defect(report, "inconsistent_orientation").count, 3u);
    EXPECT_FALSE(report.oriented);
    EXPECT_TRUE(report.orientable);

    report = check(fx::turned(good));
    EXPECT_EQ(codes(report), std::set<std::string>{"inward_component"});

    report = check({});
    EXPECT_EQ(codes(report), std::set<std::string>{"empty"});
}

TEST(CheckMesh, zero_area_means_needles_and_caps_of_no_height)
{
    TriangleSoup soup = fx::soup_of(fx::square(1));
    const Index v = static_cast<Index>(soup.positions.size());
    soup.positions.push_back({0.5, 0.0, 0.0}); // on the side from (0, 0) to (1, 0)
    soup.triangles.push_back({0, v, 1});
    EXPECT_EQ(defect(check(soup), "zero_area").element, 2u);
    soup.positions[v].y = -1e-6;
    EXPECT_FALSE(check(soup).has("zero_area"));
}

TEST(CheckMesh, a_moebius_band_has_one_side_and_one_boundary)
{
    const MeshReport report = check(fx::moebius_band());
    EXPECT_TRUE(report.has("non_orientable"));
    EXPECT_FALSE(report.orientable);
    ASSERT_EQ(report.components.size(), 1u);
    EXPECT_EQ(report.components[0].genus, 1); // a projective plane without a disk
    EXPECT_EQ(report.boundary_loops.size(), 1u);
}

TEST(CheckMesh, pinched_vertices_and_edges_separate_components)
{
    // Two cubes that share an edge.
    TriangleSoup soup = fx::soup_of(fx::polycube({{0, 0, 0}}));
    const TriangleSoup other = fx::moved(soup, [](const Vec3& p) { return p + Vec3{1, 1, 0}; });
    soup = fx::joined(soup, other);
    for (auto& t : soup.triangles)
        for (Index& v : t)
            for (Index w = 0; w < 8; ++w)
                if (soup.positions[w] == soup.positions[v])
                    v = w;
    const MeshReport report = check(soup);
    EXPECT_EQ(defect(report, "nonmanifold_edge").count, 1u);
    EXPECT_EQ(defect(report, "nonmanifold_vertex").count, 2u);
    EXPECT_EQ(report.components.size(), 2u);
    EXPECT_TRUE(report.closed);
    EXPECT_FALSE(report.manifold);
    EXPECT_TRUE(report.boundary_loops.empty());
}

TEST(CheckMesh, reports_crossing_faces_but_not_touching_ones)
{
    const TriangleSoup a = fx::soup_of(fx::cube(2));
    const auto beside = [&a](double x) {
        return fx::joined(a, fx::moved(a, [x](const Vec3& p) { return p + Vec3{x, 0.1, 0.05}; }));
    };
    EXPECT_GT(check(beside(1.9)).self_intersecting_pairs, 0u);
    EXPECT_TRUE(check(beside(1.9)).has("self_intersection"));
    EXPECT_EQ(check(beside(2.1)).self_intersecting_pairs, 0u);
    // The second starts inside the plane of the first one's side: their sides overlap.
    EXPECT_GT(check(beside(2.0)).self_intersecting_pairs, 0u);
    CheckOptions options;
    options.self_intersections = false;
    Context context;
    EXPECT_FALSE(check_mesh(beside(1.9), options, context).has("self_intersection"));
}

TEST(CheckMesh, sharp_edges_are_counted_above_the_angle)
{
    const ManifoldMesh cube = fx::cube(3);
    EXPECT_EQ(check(fx::soup_of(cube)).sharp_edges, 36u);
    EXPECT_EQ(count_sharp_edges(cube, 40.0), 36u);
    EXPECT_EQ(count_sharp_edges(cube, 89.999), 36u);
    EXPECT_EQ(count_sharp_edges(cube, 90.001), 0u);
    EXPECT_EQ(check(fx::soup_of(fx::icosphere(3))).sharp_edges, 0u);
    // Octahedron: acos(1/3) between normals.
    const ManifoldMesh octahedron = fx::octahedron();
    for (Index h = 0; h < octahedron.halfedge_count(); ++h)
        EXPECT_NEAR(dihedral_angle_deg(octahedron, h), 70.528779365509308, 1e-12);
}

TEST(CheckMesh, weld_tolerance_scales_with_the_model)
{
    for (const double scale : {1e-6, 1.0, 1e6}) {
        const TriangleSoup soup = fx::moved(fx::unwelded(fx::soup_of(fx::torus(8, 6))),
                                            [scale](const Vec3& p) { return scale * p; });
        EXPECT_EQ(defect(check(soup), "weldable_vertex").count, 3u * 96u - 48u);
    }
}
