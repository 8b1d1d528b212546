// SPDX-License-Identifier: MIT
#include "layout/base_complex.h"
#include "layout/face_energy.h"
#include "layout/improve.h"
#include "layout/make_domain.h"
#include "layout/pair_triangles.h"
#include "layout/split_in_quads.h"
#include "layout/valences.h"

#include "maps/patches.h"
#include "mesh_fixtures.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace bot2nurbs::fixtures {
namespace {

PatchComplex base_complex(const ManifoldMesh& mesh, Index sites)
{
    Tiles tiles(mesh, std::vector<double>(mesh.vertex_count(), 1.0));
    tiles.grow({0});
    tiles.add_farthest(sites);
    for (auto missing = tiles.violations(); !missing.empty(); missing = tiles.violations())
        tiles.add(missing);
    Context context;
    auto complex = build_base_complex(tiles, context);
    EXPECT_TRUE(complex.ok());
    return std::move(*complex);
}

// Every face is a disk with an injective map, together they cover the mesh once, and no two paths
// cross an edge at the same place.
void expect_sound(PatchComplex& complex, Index sides, const std::string& what)
{
    double sum = 0.0;
    OverlayBuilder builder(complex.mesh());
    for (Index f = 0; f < complex.faces().size(); ++f) {
        if (!complex.faces()[f].alive())
            continue;
        ASSERT_EQ(complex.faces()[f].sides.size(), sides) << what;
        const auto overlay = builder.disk(complex.geometry(complex.faces()[f].sides));
        ASSERT_TRUE(overlay) << what << " face " << f;
        ASSERT_TRUE(map_to_polygon(*overlay, regular_polygon(sides))) << what << " face " << f;
        for (const auto& t : overlay->triangles)
            sum += 0.5 *
                   norm(cross(overlay->vertices[t[1]].position - overlay->vertices[t[0]].position,
                              overlay->vertices[t[2]].position - overlay->vertices[t[0]].position));
    }
    EXPECT_NEAR(sum, surface_area(complex.mesh()), 1e-9 * surface_area(complex.mesh())) << what;
    std::map<std::pair<Index, double>, int> crossings;
    for (const auto& p : complex.paths())
        if (p.alive)
            for (const PathNode& n : p.geometry.nodes)
                if (!n.is_vertex()) {
                    const std::pair<Index, double> place(complex.mesh().edge(n.halfedge), n.t);
                    EXPECT_EQ(++crossings[place], 1) << what;
                }
}

TEST(BaseComplex, of_every_fixture_is_a_sound_triangulation)
{
    for (const auto& [name, mesh, genus] : closed_meshes())
        for (const Index sites : {4u, 20u}) {
            PatchComplex complex = base_complex(mesh, std::min(sites, mesh.vertex_count()));
            expect_sound(complex, 3, name);
            Context context;
            straighten_triangles(complex, context);
            expect_sound(complex, 3, name + " straightened");
        }
}

TEST(BaseComplex, with_every_vertex_a_site_is_the_mesh_itself)
{
    const ManifoldMesh mesh = icosphere(1);
    PatchComplex complex = base_complex(mesh, mesh.vertex_count());
    EXPECT_EQ(complex.face_count(), mesh.face_count());
    for (const auto& p : complex.paths()) {
        EXPECT_TRUE(p.geometry.nodes.empty());
        EXPECT_NE(mesh.find_halfedge(p.geometry.a, p.geometry.b), invalid_index);
    }
}

TEST(PatchComplex, stays_sound_through_random_flips)
{
    const ManifoldMesh mesh = torus(30, 15);
    PatchComplex complex = base_complex(mesh, 40);
    OverlayBuilder builder(mesh);
    std::mt19937 random(11);
    int flips = 0, planned = 0;
    for (int step = 0; step < 300; ++step) {
        const Index p = static_cast<Index>(random() % complex.paths().size());
        if (!complex.paths()[p].alive)
            continue;
        const std::vector<Index> faces{complex.paths()[p].left, complex.paths()[p].right};
        const auto border = complex.border(faces);
        if (!border || border->size() != 4)
            continue;
        Index a = 0;
        while (complex.start((*border)[a]) != complex.paths()[p].geometry.a)
            ++a;
        const PatchComplex::Side opposite = (*border)[(a + 1) % 4];
        bool joined = false;
        for (const auto& s : complex.star(opposite))
            joined = joined || complex.end(s) == complex.start((*border)[(a + 3) % 4]);
        if (joined)
            continue;
        auto change = complex.plan(faces, *border, {{(a + 1) % 4, (a + 3) % 4}}, builder);
        if (!change)
            continue;
        ++planned;
        EXPECT_EQ(complex.faces_after(*change).size(), 2u);
        if (step % 3 == 0)
            continue; // Planning alone changes nothing.
        complex.apply(std::move(*change));
        ++flips;
    }
    EXPECT_GT(flips, 80);
    EXPECT_GT(planned, flips);
    expect_sound(complex, 3, "flipped");
    complex.compact();
    expect_sound(complex, 3, "compacted");
}

TEST(QuadLayout, pairs_every_triangle_and_stays_sound_through_improvement)
{
    for (const auto& [name, mesh, genus] : closed_meshes()) {
        PatchComplex complex = base_complex(mesh, std::min<Index>(24, mesh.vertex_count()));
        const Index triangles = complex.face_count();
        Context context;
        const auto paired = pair_triangles(complex, {}, context);
        ASSERT_TRUE(paired.ok() && *paired) << name;
        EXPECT_EQ(2 * complex.face_count(), triangles) << name;
        expect_sound(complex, 4, name + " paired");
        const std::vector<double> density(mesh.vertex_count(), 1.0);
        improve_quads(complex, 6, {density, surface_area(mesh) / 12.0}, context);
        expect_sound(complex, 4, name + " improved");
    }
}

TEST(Valences, take_the_angle_that_was_said_for_that_of_the_mesh)
{
    const ManifoldMesh mesh = square(8);
    PatchComplex complex = base_complex(mesh, 12);
    Index v = invalid_index;
    for (const auto& side : complex.vertex_sides())
        if (mesh.is_boundary_vertex(complex.start(side)))
            v = complex.start(side);
    ASSERT_NE(v, invalid_index);
    const auto best = [&] {
        const Valences valences(complex, 4);
        int cheapest = 2;
        for (int edges = 2; edges < 7; ++edges)
            if (valences.cost(v, edges) < valences.cost(v, cheapest))
                cheapest = edges;
        return cheapest;
    };
    EXPECT_EQ(best(), std::lround(boundary_angle(mesh, v) / (0.5 * 3.141592653589793)) + 1);
    complex.set_boundary_angle(v, 3.141592653589793);
    EXPECT_EQ(best(), 3);
    complex.set_boundary_angle(v, 1.5 * 3.141592653589793);
    EXPECT_EQ(best(), 4);
    complex.set_boundary_angle(v, 0.5 * 3.141592653589793);
    EXPECT_EQ(best(), 2);
}

TEST(Valences, forbid_two_quads_at_the_end_of_a_dart_and_only_dislike_a_flat_corner)
{
    const ManifoldMesh mesh = square(8);
    PatchComplex complex = base_complex(mesh, 12);
    const std::vector<PatchComplex::Side> sides = complex.vertex_sides();
    const auto at_boundary = std::find_if(sides.begin(), sides.end(), [&](const auto& s) {
        return mesh.is_boundary_vertex(complex.start(s));
    });
    ASSERT_NE(at_boundary, sides.end());
    const Index v = complex.start(*at_boundary);
    complex.set_boundary_angle(v, 2.0 * 3.141592653589793);
    EXPECT_GT(Valences(complex, 4).cost(v, 3), 1e5);
    EXPECT_LT(Valences(complex, 4).cost(v, 4), 10.0);
    complex.set_boundary_angle(v, 3.141592653589793);
    EXPECT_LT(Valences(complex, 4).cost(v, 2), 100.0);
}

TEST(QuadLayout, a_vertex_inside_with_two_quads_is_noticed)
{
    const ManifoldMesh mesh = icosphere(4);
    PatchComplex complex = base_complex(mesh, 40);
    Context context;
    ASSERT_TRUE(*pair_triangles(complex, {}, context));
    const std::vector<double> density(mesh.vertex_count(), 1.0);
    improve_quads(complex, 20, {density, surface_area(mesh) / 20.0}, context);
    EXPECT_TRUE(has_enough_quads(complex));
    // A new vertex in a quad, joined to two of its corners.
    OverlayBuilder builder(mesh);
    const std::vector<PatchComplex::Side> sides = complex.faces()[0].sides;
    const auto disk = map_disk(builder, complex.geometry(sides));
    ASSERT_TRUE(disk);
    Index inner = invalid_index;
    for (Index v = disk->overlay.boundary_count; v < disk->overlay.vertices.size(); ++v)
        if (disk->overlay.vertices[v].mesh_vertex != invalid_index)
            inner = disk->overlay.vertices[v].mesh_vertex;
    ASSERT_NE(inner, invalid_index);
    auto change = complex.plan({0}, sides, {{0, invalid_index}, {2, invalid_index}}, *disk, inner);
    ASSERT_TRUE(change);
    complex.apply(std::move(*change));
    EXPECT_FALSE(has_enough_quads(complex));
    // Improvement removes it.
    improve_quads(complex, 20, {density, surface_area(mesh) / 20.0}, context);
    EXPECT_TRUE(has_enough_quads(complex));
}

TEST(FaceEnergy, of_a_small_patch_is_that_of_one_half_as_large_as_wanted)
{
    const ManifoldMesh mesh = icosphere(3);
    const PatchComplex complex = base_complex(mesh, 30);
    OverlayBuilder builder(mesh);
    const std::vector<double> density(mesh.vertex_count(), 1.0);
    const auto border = complex.geometry(complex.faces()[0].sides);
    const FaceEnergy as_wanted = face_energy(border, {density, surface_area(mesh) / 15.0}, builder);
    const double distortion = as_wanted.energy / (as_wanted.size * as_wanted.size);
    ASSERT_GT(as_wanted.size, 0.5);
    const FaceEnergy small = face_energy(border, {density, surface_area(mesh)}, builder);
    ASSERT_LT(small.size, 0.5);
    EXPECT_NEAR(small.energy, 0.25 * distortion, 1e-12 * distortion);
}

TEST(QuadLayout, improvement_lowers_distortion_and_leaves_few_extraordinary_vertices)
{
    const ManifoldMesh mesh = icosphere(4);
    PatchComplex complex = base_complex(mesh, 80);
    Context context;
    ASSERT_TRUE(*pair_triangles(complex, {}, context));
    const auto mean_distortion = [&complex, &mesh] {
        OverlayBuilder builder(mesh);
        double sum = 0.0;
        for (const auto& f : complex.faces())
            sum += f.alive() ? face_distortion(complex.geometry(f.sides), builder) : 0.0;
        return sum / complex.face_count();
    };
    const double before = mean_distortion();
    const std::vector<double> density(mesh.vertex_count(), 1.0);
    improve_quads(complex, 60, {density, surface_area(mesh) / 60.0}, context);
    EXPECT_LT(mean_distortion(), before);
    std::map<Index, int> valence;
    for (const auto& p : complex.paths())
        if (p.alive)
            ++valence[p.geometry.a], ++valence[p.geometry.b];
    Index extraordinary = 0;
    for (const auto& [v, n] : valence) {
        extraordinary += n != 4;
        EXPECT_LE(n, 6);
    }
    EXPECT_LE(3 * extraordinary, valence.size());
}

TEST(QuadLayout, splitting_every_triangle_in_three_quads_is_sound_too)
{
    for (const auto& [name, mesh, genus] : closed_meshes()) {
        PatchComplex triangles = base_complex(mesh, std::min<Index>(12, mesh.vertex_count()));
        const Index count = triangles.face_count();
        Context context;
        auto split = split_in_quads(triangles, mesh, CarrierMesh::from_source(mesh), context);
        ASSERT_TRUE(split.ok()) << name << ": " << split.error().message;
        EXPECT_EQ(split->complex.face_count(), 3 * count) << name;
        expect_sound(split->complex, 4, name + " split");
        const CarrierMesh& carrier = *split->carrier;
        for (Index v = 0; v < carrier.mesh.vertex_count(); ++v)
            ASSERT_LT(norm(mesh.at(carrier.vertex_source[v]) - carrier.mesh.position(v)), 1e-13);
        EXPECT_NEAR(surface_area(carrier.mesh), surface_area(mesh), 1e-10 * surface_area(mesh));
        EXPECT_EQ(carrier.mesh.genus(), genus);
    }
}

} // namespace
} // namespace bot2nurbs::fixtures
