// SPDX-License-Identifier: MIT
#include "layout/quad_fixtures.h"

#include <gtest/gtest.h>

namespace bot2nurbs::fixtures {
namespace {

// Three by three vertices in the plane, and their four quads.
std::vector<Vec3> grid()
{
    std::vector<Vec3> p;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            p.push_back({double(j), double(i), 0});
    return p;
}
const std::vector<std::vector<Index>> four = {
    {0, 1, 4, 3}, {1, 2, 5, 4}, {3, 4, 7, 6}, {4, 5, 8, 7}};

// Expects a refusal that names the element and has the words.
void expect_refused(const PolygonMesh& mesh, Index element, const std::string& words)
{
    const auto pieces = split_quads(mesh);
    ASSERT_FALSE(pieces) << words;
    EXPECT_EQ(pieces.error().code, ErrorCode::invalid_domain);
    EXPECT_EQ(pieces.error().element, element) << pieces.error().message;
    EXPECT_NE(pieces.error().message.find(words), std::string::npos) << pieces.error().message;
}

TEST(SplitQuads, keeps_the_numbers_of_quads_and_turns_them_to_agree)
{
    std::vector<std::vector<Index>> faces = four;
    std::swap(faces[2][1], faces[2][3]);
    const auto pieces = split_quads(polygons(grid(), faces));
    ASSERT_TRUE(pieces) << pieces.error().message;
    ASSERT_EQ(pieces->size(), 1u);
    const QuadMesh& quads = pieces->front();
    EXPECT_EQ(quads.source_face, (std::vector<Index>{0, 1, 2, 3}));
    for (std::size_t q = 0; q < 4; ++q)
        for (std::size_t k = 0; k < 4; ++k)
            EXPECT_EQ(quads.source_vertex[quads.quads[q][k]], four[q][k]);
}

TEST(SplitQuads, gives_each_connected_piece_by_itself_without_unused_vertices)
{
    std::vector<Vec3> p = grid();
    p.push_back({9, 9, 9});
    for (const Vec3& q : {Vec3{5, 0, 0}, Vec3{6, 0, 0}, Vec3{6, 1, 0}, Vec3{5, 1, 0}})
        p.push_back(q);
    const auto pieces = split_quads(polygons(p, {{10, 11, 12, 13}, {0, 1, 4, 3}, {1, 2, 5, 4}}));
    ASSERT_TRUE(pieces) << pieces.error().message;
    ASSERT_EQ(pieces->size(), 2u);
    EXPECT_EQ((*pieces)[0].source_vertex, (std::vector<Index>{10, 11, 12, 13}));
    EXPECT_EQ((*pieces)[1].source_face, (std::vector<Index>{1, 2}));
    EXPECT_EQ((*pieces)[1].positions.size(), 6u);
}

TEST(SplitQuads, welds_seams_whose_vertices_agree)
{
    std::vector<Vec3> p = grid();
    p.push_back(p[1]);
    p.push_back(p[4]);
    const auto pieces = split_quads(polygons(p, {{0, 1, 4, 3}, {9, 2, 5, 10}}));
    ASSERT_TRUE(pieces) << pieces.error().message;
    EXPECT_EQ(pieces->size(), 1u);
    EXPECT_EQ(pieces->front().positions.size(), 6u);
}

TEST(SplitQuads, refuses_what_is_no_manifold_of_quads_by_name)
{
    expect_refused(polygons(grid(), {{0, 1, 4, 3}, {1, 2, 5}}), 1, "face 1");
    expect_refused(polygons(grid(), {{0, 1, 4, 3}, {1, 2, 2, 4}}), 1, "vertex 2 twice");
    std::vector<Vec3> fin = grid();
    fin.push_back({1, 0, 1});
    fin.push_back({1, 1, 1});
    expect_refused(polygons(fin, {{0, 1, 4, 3}, {1, 2, 5, 4}, {1, 4, 10, 9}}), 2, "edge 1-4");
    expect_refused(polygons(grid(), {four[0], four[3]}), 4, "vertex 4");
    // A quad beside two others: vertex 4 lies on its side.
    expect_refused(polygons({{0, 0, 0},
                             {1, 0, 0},
                             {2, 0, 0},
                             {0, 1, 0},
                             {1, 1, 0},
                             {2, 1, 0},
                             {0, -1, 0},
                             {2, -1, 0}},
                            {{0, 1, 4, 3}, {1, 2, 5, 4}, {6, 7, 2, 0}}),
                   1, "T-junctions");
}

TEST(SplitQuads, refuses_a_one_sided_surface)
{
    const TriangleSoup band = moebius_band();
    std::vector<std::vector<Index>> faces;
    for (std::size_t f = 0; f < band.triangles.size(); f += 2)
        faces.push_back({band.triangles[f][0], band.triangles[f][1], band.triangles[f][2],
                         band.triangles[f + 1][2]});
    const auto pieces = split_quads(polygons(band.positions, faces));
    ASSERT_FALSE(pieces);
    EXPECT_NE(pieces.error().message.find("Moebius"), std::string::npos);
}

} // namespace
} // namespace bot2nurbs::fixtures
