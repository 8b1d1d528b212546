// SPDX-License-Identifier: MIT
#include "bot2nurbs/repair_mesh.h"

#include "mesh_fixtures.h"

#include <gtest/gtest.h>

#include <random>

using namespace bot2nurbs;
namespace fx = bot2nurbs::fixtures;

namespace {

Result<RepairedMesh> repair(const TriangleSoup& soup, const RepairOptions& options = {})
{
    Context context;
    return repair_mesh(soup, options, context);
}

Index count(const RepairedMesh& repaired, const std::string& code)
{
    for (const RepairNote& note : repaired.notes)
        if (note.code == code)
            return note.count;
    return 0;
}

Index degenerate_faces(const ManifoldMesh& mesh, double height)
{
    Index n = 0;
    for (Index f = 0; f < mesh.face_count(); ++f) {
        double longest = 0.0;
        for (Index h = 3 * f; h < 3 * f + 3; ++h)
            longest =
                std::max(longest, norm(mesh.position(mesh.to(h)) - mesh.position(mesh.from(h))));
        n += norm(mesh.area_vector(f)) <= height * longest;
    }
    return n;
}

} // namespace

TEST(RepairMesh, sound_meshes_come_out_as_they_went_in)
{
    for (const auto& list : {fx::closed_meshes(), fx::open_meshes()})
        for (const auto& [name, mesh, genus] : list) {
            SCOPED_TRACE(name);
            const Result<RepairedMesh> repaired = repair(fx::soup_of(mesh));
            ASSERT_TRUE(repaired);
            EXPECT_TRUE(repaired->notes.empty());
            ASSERT_EQ(repaired->components.size(), 1u);
            const MeshComponent& c = repaired->components[0];
            EXPECT_EQ(signature(c.mesh), signature(mesh));
            EXPECT_EQ(c.genus, genus);
            EXPECT_EQ(c.boundary_loops, mesh.closed() ? 0u : (name == "square" ? 1u : 2u));
        }
}

TEST(RepairMesh, a_soup_is_welded_into_the_same_mesh_at_every_scale)
{
    for (const double scale : {1e-6, 1.0, 1e6}) {
        const ManifoldMesh mesh =
            fx::moved(fx::genus_two(), [scale](const Vec3& p) { return scale * p; });
        const Result<RepairedMesh> repaired = repair(fx::unwelded(fx::soup_of(mesh)));
        ASSERT_TRUE(repaired);
        ASSERT_EQ(repaired->components.size(), 1u);
        EXPECT_EQ(repaired->components[0].genus, 2);
        EXPECT_EQ(repaired->components[0].mesh.vertex_count(), mesh.vertex_count());
        EXPECT_EQ(count(*repaired, "weld"), 3 * mesh.face_count() - mesh.vertex_count());
    }
}

TEST(RepairMesh, welds_what_is_near_and_nothing_farther)
{
    std::mt19937 random(2);
    std::uniform_real_distribution<double> shift(-1.0, 1.0);
    const TriangleSoup soup = fx::unwelded(fx::soup_of(fx::icosphere(2)));
    const auto jittered = [&](double size) {
        return fx::moved(soup, [&, size](const Vec3& p) {
            const double x = shift(random), y = shift(random), z = shift(random);
            return p + size * Vec3{x, y, z};
        });
    };
    const Result<RepairedMesh> near = repair(jittered(2e-10));
    ASSERT_TRUE(near);
    ASSERT_EQ(near->components.size(), 1u);
    EXPECT_TRUE(near->components[0].mesh.closed());
    const Result<RepairedMesh> far = repair(jittered(1e-5));
    ASSERT_TRUE(far);
    EXPECT_EQ(far->components.size(), soup.triangles.size());
    RepairOptions options;
    options.weld = 1e-4;
    const Result<RepairedMesh> wide = repair(jittered(1e-5), options);
    ASSERT_TRUE(wide);
    ASSERT_EQ(wide->components.size(), 1u);
    EXPECT_TRUE(wide->components[0].mesh.closed());
}

TEST(RepairMesh, a_wide_weld_leaves_closed_parts_and_small_faces_as_they_are)
{
    // Edges of icosphere(4) are 0.08 long, and 0.1 of the diagonal are 0.35; the plate is 0.02
    // thick.
    RepairOptions options;
    options.weld = 0.1;
    const ManifoldMesh plate = fx::moved(fx::cube(4), [](const Vec3& p) {
        return Vec3{p.x, p.y, 0.02 * p.z};
    });
    for (const ManifoldMesh& mesh : {fx::icosphere(4), plate}) {
        const Result<RepairedMesh> repaired = repair(fx::soup_of(mesh), options);
        ASSERT_TRUE(repaired);
        EXPECT_TRUE(repaired->notes.empty()) << repaired->notes.front().message;
        ASSERT_EQ(repaired->components.size(), 1u);
        EXPECT_EQ(repaired->components[0].mesh.positions(), mesh.positions());
        EXPECT_EQ(repaired->components[0].mesh.triangles(), mesh.triangles());
    }
}

TEST(RepairMesh, solids_that_touch_in_a_point_stay_apart)
{
    const TriangleSoup cube = fx::soup_of(fx::cube(2));
    const TriangleSoup other = fx::moved(cube, [](const Vec3& p) { return p + Vec3{2, 2, 2}; });
    // With vertices of their own they are not welded at all.
    const Result<RepairedMesh> closed = repair(fx::joined(cube, other));
    ASSERT_TRUE(closed);
    EXPECT_EQ(closed->components.size(), 2u);
    // As a soup they are welded, but not to each other.
    const Result<RepairedMesh> soup = repair(fx::unwelded(fx::joined(cube, other)));
    ASSERT_TRUE(soup);
    ASSERT_EQ(soup->components.size(), 2u);
    for (const MeshComponent& c : soup->components)
        EXPECT_NEAR(c.volume, 8.0, 1e-12);
}

TEST(RepairMesh, removes_repeated_duplicate_and_unused_elements)
{
    TriangleSoup soup = fx::soup_of(fx::torus(9, 7));
    const Index faces = static_cast<Index>(soup.triangles.size());
    soup.triangles.push_back(soup.triangles[4]);
    soup.triangles.push_back({soup.triangles[9][2], soup.triangles[9][1], soup.triangles[9][0]});
    soup.triangles.push_back({3, 3, 8});
    soup.positions.push_back({NAN, 0, 0});
    const Result<RepairedMesh> repaired = repair(soup);
    ASSERT_TRUE(repaired);
    EXPECT_EQ(count(*repaired, "duplicate_face"), 2u);
    EXPECT_EQ(count(*repaired, "repeated_vertex"), 1u);
    EXPECT_EQ(count(*repaired, "unused_vertex"), 1u);
    ASSERT_EQ(repaired->components.size(), 1u);
    EXPECT_EQ(repaired->components[0].mesh.face_count(), faces);
    EXPECT_EQ(repaired->components[0].genus, 1);
}

TEST(RepairMesh, collapses_needles_and_flips_caps_without_opening_the_surface)
{
    const ManifoldMesh sphere = fx::icosphere(2);
    TriangleSoup soup = fx::soup_of(sphere);
    std::vector<char> touched(sphere.face_count(), 0);
    Index caps = 0, needles = 0;
    for (Index f = 0; f < sphere.face_count(); f += 12) {
        // Cap: the middle m of side ab is a vertex of the face behind only, which is cut there; the
        // face b-a-m without area closes the gap.
        const Index h = 3 * f, g = sphere.twin(h);
        if (touched[f] || touched[g / 3])
            continue;
        touched[f] = touched[g / 3] = 1;
        const Index a = sphere.from(h), b = sphere.to(h);
        const Index d = sphere.from(ManifoldMesh::prev(g));
        const Index m = static_cast<Index>(soup.positions.size());
        soup.positions.push_back(0.5 * (sphere.position(a) + sphere.position(b)));
        soup.triangles[g / 3] = {b, m, d};
        soup.triangles.push_back({m, a, d});
        soup.triangles.push_back({b, a, m});
        ++caps;
    }
    const ManifoldMesh cut = fx::must_build(soup.positions, soup.triangles);
    // Needles: a vertex is doubled and its fan opened along two edges, each closed by a needle.
    std::vector<Vec3> positions = cut.positions();
    auto triangles = cut.triangles();
    for (const Index v : {Index{0}, Index{5}, Index{9}}) {
        const Index h = cut.halfedge_at(v);
        std::vector<Index> fan;
        for (Index k = h;;) {
            fan.push_back(k);
            k = cut.twin(ManifoldMesh::prev(k));
            if (k == h)
                break;
        }
        // Faces 0 .. 1 of the fan keep v, the others get a copy at the same place.
        const Index copy = static_cast<Index>(positions.size());
        positions.push_back(positions[v]);
        for (std::size_t i = 2; i < fan.size(); ++i)
            for (Index& w : triangles[fan[i] / 3])
                if (w == v)
                    w = copy;
        const Index p = cut.to(fan[0]), q = cut.to(fan[2]);
        triangles.push_back({v, copy, p});
        triangles.push_back({v, q, copy});
        needles += 2;
    }
    const ManifoldMesh damaged = fx::must_build(positions, triangles);
    ASSERT_TRUE(damaged.closed());
    ASSERT_GE(caps, 10u);
    ASSERT_EQ(degenerate_faces(damaged, 1e-12), caps + needles);

    const Result<RepairedMesh> repaired = repair(fx::soup_of(damaged));
    ASSERT_TRUE(repaired);
    ASSERT_EQ(repaired->components.size(), 1u);
    const MeshComponent& c = repaired->components[0];
    EXPECT_TRUE(c.mesh.closed());
    EXPECT_EQ(c.genus, 0);
    EXPECT_EQ(degenerate_faces(c.mesh, 1e-9), 0u);
    EXPECT_GE(count(*repaired, "flipped_cap"), caps);
    EXPECT_EQ(count(*repaired, "collapsed_edge"), 3u);
    EXPECT_EQ(c.mesh.vertex_count(), damaged.vertex_count() - 3);
    EXPECT_EQ(count(*repaired, "zero_area_kept"), 0u);
    EXPECT_NEAR(c.volume, sphere.volume(), 1e-12);
}

TEST(RepairMesh, turns_faces_to_agree_with_the_majority)
{
    TriangleSoup soup = fx::soup_of(fx::genus_two());
    std::mt19937 random(3);
    Index turned = 0;
    for (auto& t : soup.triangles)
        if (random() % 10 == 0) {
            std::swap(t[0], t[1]);
            ++turned;
        }
    const Result<RepairedMesh> repaired = repair(soup);
    ASSERT_TRUE(repaired);
    EXPECT_EQ(count(*repaired, "oriented"), turned);
    EXPECT_EQ(count(*repaired, "turned_outward"), 0u);
    EXPECT_NEAR(repaired->components[0].volume, fx::genus_two().volume(), 1e-12);
}

TEST(RepairMesh, inward_solids_are_turned_but_hollows_are_not)
{
    const TriangleSoup outer = fx::soup_of(fx::icosphere(2));
    const auto shell = [&](double size) {
        return fx::moved(outer, [size](const Vec3& p) { return size * p; });
    };
    // All inward: outer, hollow, and a solid in the hollow.
    const TriangleSoup soup = fx::turned(fx::joined(fx::joined(shell(3), shell(2)), shell(1)));
    const Result<RepairedMesh> repaired = repair(soup);
    ASSERT_TRUE(repaired);
    ASSERT_EQ(repaired->components.size(), 3u);
    const auto& c = repaired->components;
    EXPECT_GT(c[0].volume, 0.0);
    EXPECT_LT(c[1].volume, 0.0);
    EXPECT_GT(c[2].volume, 0.0);
    EXPECT_EQ(count(*repaired, "turned_outward"), 2u);
    EXPECT_TRUE(!c[0].cavity && c[1].cavity && !c[2].cavity);
    EXPECT_EQ(c[0].surrounded_by, invalid_index);
    EXPECT_EQ(c[1].surrounded_by, 0u);
    EXPECT_EQ(c[2].surrounded_by, 1u);

    // A surrounded component that turns outward is kept, with a warning.
    const Result<RepairedMesh> nested = repair(fx::joined(shell(3), shell(2)));
    ASSERT_TRUE(nested);
    EXPECT_EQ(count(*nested, "nested_solid"), 1u);
    EXPECT_GT(nested->components[1].volume, 0.0);
    // Beside each other, or in the hole of a torus, is not inside.
    const TriangleSoup ring = fx::soup_of(fx::torus(24, 12, 5.0, 1.0));
    const Result<RepairedMesh> beside = repair(fx::joined(ring, fx::turned(shell(0.5))));
    ASSERT_TRUE(beside);
    EXPECT_EQ(count(*beside, "turned_outward"), 1u);
    EXPECT_EQ(beside->components[1].surrounded_by, invalid_index);
}

TEST(RepairMesh, nesting_is_exact_where_the_ray_meets_vertices_and_edges)
{
    // Grid-aligned cubes: the ray from a corner of the inner one runs through edges and vertices.
    const TriangleSoup outer =
        fx::moved(fx::soup_of(fx::cube(4)), [](const Vec3& p) { return 4 * p; });
    for (const double x : {-2.0, -1.0, 0.0, 1.0, 2.0})
        for (const double y : {-2.0, 0.0, 1.0}) {
            const TriangleSoup inner =
                fx::moved(fx::turned(fx::soup_of(fx::cube(2))), [&](const Vec3& p) {
                    return p + Vec3{x, y, 0};
                });
            const Result<RepairedMesh> repaired = repair(fx::joined(outer, inner));
            ASSERT_TRUE(repaired);
            EXPECT_TRUE(repaired->components[1].cavity);
        }
}

TEST(RepairMesh, refuses_what_has_no_single_answer_and_names_it)
{
    const auto error = [](const TriangleSoup& soup) {
        const Result<RepairedMesh> repaired = repair(soup);
        return repaired ? Error{} : repaired.error();
    };
    EXPECT_EQ(error({}).code, ErrorCode::empty_input);
    EXPECT_EQ(error(fx::moebius_band()).code, ErrorCode::not_orientable);

    TriangleSoup soup = fx::soup_of(fx::octahedron());
    soup.triangles[2][0] = 17;
    EXPECT_EQ(error(soup).code, ErrorCode::bad_geometry);
    EXPECT_EQ(error(soup).element, 2u);

    soup = fx::soup_of(fx::octahedron());
    soup.positions[4].z = INFINITY;
    EXPECT_EQ(error(soup).code, ErrorCode::bad_geometry);
    EXPECT_EQ(error(soup).element, 4u);

    soup = fx::moved(fx::soup_of(fx::octahedron()), [](const Vec3&) { return Vec3{1, 2, 3}; });
    EXPECT_EQ(error(soup).code, ErrorCode::bad_geometry);

    // A fin on the edge 0-2 of face 0.
    soup = fx::soup_of(fx::octahedron());
    soup.positions.push_back({2, 2, 2});
    soup.triangles.push_back({0, 2, 6});
    EXPECT_EQ(error(soup).code, ErrorCode::not_manifold);
    EXPECT_EQ(error(soup).element, 0u);
    EXPECT_NE(error(soup).message.find("from vertex 0 to vertex 2"), std::string::npos);

    RepairOptions options;
    options.weld = -1.0;
    const Result<RepairedMesh> bad = repair(fx::soup_of(fx::octahedron()), options);
    ASSERT_FALSE(bad);
    EXPECT_EQ(bad.error().code, ErrorCode::bad_option);
}

TEST(RepairMesh, splitting_separates_solids_that_share_an_edge_or_a_vertex)
{
    for (const Vec3 step : {Vec3{1, 1, 0}, Vec3{1, 0, 1}, Vec3{0, 1, 1}, Vec3{1, 1, 1}}) {
        TriangleSoup soup = fx::soup_of(fx::polycube({{0, 0, 0}}));
        soup = fx::joined(soup, fx::moved(soup, [&](const Vec3& p) { return p + step; }));
        for (auto& t : soup.triangles)
            for (Index& v : t)
                for (Index w = 0; w < 8; ++w)
                    if (soup.positions[w] == soup.positions[v])
                        v = w;
        const Result<RepairedMesh> refused = repair(soup);
        ASSERT_FALSE(refused);
        EXPECT_EQ(refused.error().code, ErrorCode::not_manifold);
        RepairOptions options;
        options.split_nonmanifold = true;
        const Result<RepairedMesh> split = repair(soup, options);
        ASSERT_TRUE(split);
        ASSERT_EQ(split->components.size(), 2u);
        for (const MeshComponent& c : split->components) {
            EXPECT_TRUE(c.mesh.closed());
            EXPECT_NEAR(c.volume, 1.0, 1e-14);
        }
    }
}

TEST(RepairMesh, provenance_leads_back_to_the_soup)
{
    const TriangleSoup soup = fx::joined(
        fx::two_spheres(1), fx::turned(fx::moved(fx::soup_of(fx::torus(8, 6)), [](const Vec3& p) {
            return p + Vec3{0, 9, 0};
        })));
    const Result<RepairedMesh> repaired = repair(soup);
    ASSERT_TRUE(repaired);
    ASSERT_EQ(repaired->components.size(), 3u);
    for (const MeshComponent& c : repaired->components) {
        for (Index v = 0; v < c.mesh.vertex_count(); ++v)
            ASSERT_EQ(c.mesh.position(v), soup.positions[c.source_vertex[v]]);
        for (Index f = 0; f < c.mesh.face_count(); ++f) {
            std::array<Index, 3> mine = c.mesh.triangle(f);
            for (Index& v : mine)
                v = c.source_vertex[v];
            std::array<Index, 3> theirs = soup.triangles[c.source_face[f]];
            std::sort(mine.begin(), mine.end());
            std::sort(theirs.begin(), theirs.end());
            ASSERT_EQ(mine, theirs);
        }
    }
}

TEST(RepairMesh, a_flat_closed_mesh_gets_a_warning)
{
    const Result<RepairedMesh> repaired =
        repair(fx::moved(fx::soup_of(fx::icosphere(2)), [](const Vec3& p) {
            return Vec3{p.x, p.y, 0.0};
        }));
    ASSERT_TRUE(repaired);
    EXPECT_EQ(count(*repaired, "no_volume"), 1u);
}
