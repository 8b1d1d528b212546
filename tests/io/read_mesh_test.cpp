// SPDX-License-Identifier: MIT
#include "bot2nurbs/read_mesh.h"

#include "mesh_fixtures.h"
#include "read_fixtures.h"

#include <gtest/gtest.h>

#include <clocale>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <random>

using namespace bot2nurbs;
using bot2nurbs::test::expect_error_of;
using bot2nurbs::test::put;
using bot2nurbs::test::ScratchFile;

namespace {

Result<TriangleSoup> read(const std::string& name, const std::string& bytes)
{
    const ScratchFile file(name, bytes);
    Context context;
    return read_mesh(file.path(), context);
}

//! Expects an error with the code, whose message has all the words.
void expect_error(const std::string& name, const std::string& bytes, ErrorCode code,
                  const std::vector<std::string>& words)
{
    expect_error_of(read(name, bytes), name, bytes, code, words);
}

std::string binary_stl(const std::vector<std::array<Vec3, 3>>& facets, const std::string& header,
                       std::uint32_t count)
{
    std::string bytes = header;
    bytes.resize(80, ' ');
    put(bytes, count);
    for (const auto& f : facets) {
        for (int i = 0; i < 3; ++i)
            put(bytes, 0.0f);
        for (const Vec3& p : f)
            for (int k = 0; k < 3; ++k)
                put(bytes, static_cast<float>(p[k]));
        put(bytes, std::uint16_t{0});
    }
    return bytes;
}

std::vector<std::array<Vec3, 3>> octahedron_facets()
{
    const ManifoldMesh mesh = fixtures::octahedron();
    std::vector<std::array<Vec3, 3>> facets;
    for (const auto& t : mesh.triangles())
        facets.push_back({mesh.position(t[0]), mesh.position(t[1]), mesh.position(t[2])});
    return facets;
}

const char* const text_facet = "facet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1 0 0\n"
                               "  vertex 0 1 0\n endloop\nendfacet\n";

std::string ply_header(const std::string& format)
{
    return "ply\nformat " + format + " 1.0\ncomment made by a test\n";
}

} // namespace

TEST(ReadMesh, a_missing_file_or_a_folder_cannot_be_read_and_is_named)
{
    Context context;
    for (const std::string& path : {std::string("no/such/file.obj"), testing::TempDir()}) {
        const Result<TriangleSoup> soup = read_mesh(path, context);
        ASSERT_FALSE(soup);
        EXPECT_EQ(soup.error().code, ErrorCode::cannot_read);
        EXPECT_NE(soup.error().message.find(path), std::string::npos);
    }
}

TEST(ReadMesh, content_must_agree_with_the_extension)
{
    const std::string off = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    EXPECT_TRUE(read("a.off", off));
    EXPECT_TRUE(read("a.OFF", off));
    EXPECT_TRUE(read("a.mesh", off)); // unknown extension: by content
    expect_error("a.ply", off, ErrorCode::cannot_read, {"off"});
    expect_error("a.obj", off, ErrorCode::cannot_read, {"off"});
    expect_error("a.mesh", "hello", ErrorCode::cannot_read, {"known are"});
    expect_error("a.obj", "<html><body>not found</body></html>", ErrorCode::cannot_read, {"OBJ"});
    for (const char* name : {"a.stl", "a.obj", "a.ply", "a.off"})
        expect_error(name, "", ErrorCode::cannot_read, {"empty"});
}

TEST(ReadMesh, a_cancelled_context_stops_reading)
{
    const ScratchFile file("cancel.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    Context context;
    context.cancel();
    const Result<TriangleSoup> soup = read_mesh(file.path(), context);
    ASSERT_FALSE(soup);
    EXPECT_EQ(soup.error().code, ErrorCode::cancelled);
}

TEST(ReadStl, binary_merges_equal_corners_also_behind_a_header_that_starts_with_solid)
{
    for (const char* header : {"binary", "solid but binary", "solid\nfacet normal"}) {
        const Result<TriangleSoup> soup = read("a.stl", binary_stl(octahedron_facets(), header, 8));
        ASSERT_TRUE(soup);
        EXPECT_EQ(soup->positions.size(), 6u);
        EXPECT_EQ(soup->triangles.size(), 8u);
        const Result<ManifoldMesh> mesh = ManifoldMesh::build(soup->positions, soup->triangles);
        ASSERT_TRUE(mesh);
        EXPECT_NEAR(mesh->volume(), 4.0 / 3.0, 1e-14);
    }
}

TEST(ReadStl, minus_zero_is_zero_and_floats_keep_their_value)
{
    std::vector<std::array<Vec3, 3>> facets{{Vec3{0, 0, 0}, Vec3{0.1f, 0, 0}, Vec3{0, 1, 0}},
                                            {Vec3{-0.0, 0, -0.0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}};
    const Result<TriangleSoup> soup = read("a.stl", binary_stl(facets, "", 2));
    ASSERT_TRUE(soup);
    EXPECT_EQ(soup->positions.size(), 4u);
    EXPECT_EQ(soup->positions[1].x, static_cast<double>(0.1f));
}

TEST(ReadStl, text_with_capitals_several_solids_and_any_line_ends)
{
    std::string text = std::string("solid a part\n") + text_facet + "endsolid\nsolid b\n";
    text += "FACET NORMAL 0 0 1\n OUTER LOOP\n VERTEX 1 0 0\n VERTEX 1 1 0\n VERTEX +0 1.0e0 0\n"
            " ENDLOOP\nENDFACET\nendsolid b\n";
    for (const char* end : {"\n", "\r\n", "\r"}) {
        std::string file;
        for (const char c : text)
            file += c == '\n' ? std::string(end) : std::string(1, c);
        const Result<TriangleSoup> soup = read("a.stl", file);
        ASSERT_TRUE(soup) << soup.error().message;
        EXPECT_EQ(soup->positions.size(), 4u);
        EXPECT_EQ(soup->triangles.size(), 2u);
    }
}

TEST(ReadStl, broken_files_are_refused_with_the_place)
{
    const std::string good = binary_stl(octahedron_facets(), "x", 8);
    expect_error("a.stl", good.substr(0, good.size() - 60), ErrorCode::cannot_read,
                 {"8 facets", "has 6"});
    expect_error("a.stl", binary_stl(octahedron_facets(), "x", 0xffffffffu), ErrorCode::cannot_read,
                 {"4294967295"});
    expect_error("a.stl", binary_stl({}, "x", 0), ErrorCode::empty_input, {"no faces"});
    auto facets = octahedron_facets();
    facets[3][1].y = NAN;
    expect_error("a.stl", binary_stl(facets, "x", 8), ErrorCode::bad_geometry, {"facet 3"});

    const std::string facet = text_facet;
    expect_error("a.stl", "solid x\n" + facet.substr(0, facet.find("1 0 0")),
                 ErrorCode::cannot_read, {"line 5", "missing"});
    expect_error("a.stl", "solid x\nfacet\nouter loop\nvertex 1 2 z\n", ErrorCode::cannot_read,
                 {"line 4", "\"z\""});
    expect_error("a.stl", "solid x\nfacet\nouter loop\nvertex 1 2 3\nendloop\n",
                 ErrorCode::cannot_read, {"1 vertices"});
    expect_error("a.stl", "solid x\n" + facet + "rubbish\n", ErrorCode::cannot_read,
                 {"line 9", "rubbish"});
    expect_error("a.stl", "solid x\nendsolid x\n", ErrorCode::empty_input, {});
}

TEST(ReadObj, all_forms_of_faces_with_provenance)
{
    const std::string text = "# comment\r\nmtllib x.mtl\r\no first\r\nv 0 0 0 1.0\r\nv 1 0 0\r\n"
                             "v 1 1 0 0.5 0.5 0.5\r\nv 0 1 0\r\nvt 0 0\r\nvn 0 0 1\r\n"
                             "f 1/1/1 2/1/1 3/1/1 4/1/1 # a quad\r\no second\r\nv 0 0 1\r\n"
                             "f -1//1 -4//1 -5//1\r\nf 1/1 4/1 5/1\r\nf 2 3 \\\r\n 5\r\nl 1 2\r\n";
    const Result<TriangleSoup> soup = read("a.obj", text);
    ASSERT_TRUE(soup) << soup.error().message;
    EXPECT_EQ(soup->positions.size(), 5u);
    const std::vector<std::array<Index, 3>> expected{
        {0, 1, 2}, {0, 2, 3}, {4, 1, 0}, {0, 3, 4}, {1, 2, 4}};
    EXPECT_EQ(soup->triangles, expected);
    EXPECT_EQ(soup->source_face, (std::vector<Index>{0, 0, 1, 2, 3}));
}

TEST(ReadPolygons, keeps_the_polygons_that_read_mesh_cuts)
{
    const ScratchFile file("polygons.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0.5 0\n"
                                           "f 1 2 3 4\nf 2 5 3\n");
    Context context;
    const Result<PolygonMesh> mesh = read_polygons(file.path(), context);
    ASSERT_TRUE(mesh) << mesh.error().message;
    ASSERT_EQ(mesh->polygons.size(), 2u);
    EXPECT_EQ(mesh->polygons.count(0), 4u);
    EXPECT_EQ(mesh->polygons.count(1), 3u);
    EXPECT_EQ(mesh->polygons.corners, (std::vector<Index>{0, 1, 2, 3, 1, 4, 2}));
    EXPECT_EQ(mesh->positions.size(), 5u);
}

TEST(ReadObj, faces_may_name_vertices_that_come_later)
{
    EXPECT_TRUE(read("a.obj", "f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"));
    expect_error("a.obj", "v 0 0 0\nf 1 2 4\nv 1 0 0\nv 0 1 0\n", ErrorCode::cannot_read,
                 {"line 2", "vertex 4"});
}

TEST(ReadObj, numbers_are_the_nearest_doubles_in_any_locale)
{
    std::mt19937_64 random(1);
    std::vector<double> values;
    std::string text;
    for (int i = 0; i < 3000; ++i) {
        const double x = (static_cast<double>(random()) / 1e19 - 1.0) *
                         std::pow(10.0, static_cast<int>(random() % 40) - 20);
        values.push_back(x);
        char word[40];
        std::snprintf(word, sizeof word, "%.17g", x);
        text += (i % 3 == 0 ? "v " : " ") + std::string(word) + (i % 3 == 2 ? "\n" : "");
    }
    text += "f 1 2 3\n";
    const std::string before = std::setlocale(LC_NUMERIC, nullptr);
    for (const char* name : {"de_DE.UTF-8", "fr_FR.UTF-8", "C"}) {
        std::setlocale(LC_NUMERIC, name); // where the locale is missing, nothing changes
        const Result<TriangleSoup> soup = read("a.obj", text);
        ASSERT_TRUE(soup) << soup.error().message;
        for (std::size_t i = 0; i < values.size(); ++i)
            ASSERT_EQ(soup->positions[i / 3][static_cast<int>(i % 3)], values[i]);
    }
    std::setlocale(LC_NUMERIC, before.c_str());
}

TEST(ReadObj, too_small_is_zero_and_too_large_is_an_error)
{
    const Result<TriangleSoup> soup = read("a.obj", "v 1e-400 -0.0 1\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    ASSERT_TRUE(soup);
    EXPECT_EQ(soup->positions[0].x, 0.0);
    expect_error("a.obj", "v 1e400 0 1\nf 1 1 1\n", ErrorCode::cannot_read, {"line 1", "1e400"});
}

TEST(ReadObj, broken_files_are_refused_with_the_place)
{
    expect_error("a.obj", "v 0 0\n", ErrorCode::cannot_read, {"line 1", "vertex 1", "missing"});
    expect_error("a.obj", "v 0 0 0\nv 0 0,5 0\n", ErrorCode::cannot_read, {"line 2", "0,5"});
    expect_error("a.obj", "v 0 0 0\nf 1 x 1\n", ErrorCode::cannot_read, {"line 2", "\"x\""});
    expect_error("a.obj", "v 0 0 0\nf 1 0 1\n", ErrorCode::cannot_read, {"vertex 0"});
    expect_error("a.obj", "v 0 0 0\nf 1 -2 1\n", ErrorCode::cannot_read, {"vertex -2"});
    expect_error("a.obj", "v 0 0 0\nf 1 99999999999 1\n", ErrorCode::cannot_read, {"99999999999"});
    expect_error("a.obj", "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", ErrorCode::bad_geometry,
                 {"not finite"});
    expect_error("a.obj", "v 0 0 0\nv 1 0 0\n", ErrorCode::empty_input, {"no faces"});
    expect_error("a.obj", std::string("v 0 0 0\0\nf 1 1 1\n", 17), ErrorCode::cannot_read,
                 {"byte 7"});
}

TEST(ReadOff, header_variants_comments_and_colours)
{
    const std::string body = "0 0 0\n1 0 0 # corner\n\n1 1 0\n0 1 0\n4 0 1 2 3 255 0 0\n";
    for (const char* header : {"OFF\n4 1 0\n", "OFF 4 1 0\n", "# first\nOFF\n# second\n4 1\n",
                               "4 1 0\n", "\n  OFF\r\n4 1 0\r\n"}) {
        const Result<TriangleSoup> soup = read("a.off", header + body);
        ASSERT_TRUE(soup) << header << soup.error().message;
        EXPECT_EQ(soup->triangles.size(), 2u);
        EXPECT_EQ(soup->source_face, (std::vector<Index>{0, 0}));
    }
    for (const char* keyword : {"COFF", "NOFF", "CNOFF", "STOFF", "STCNOFF"}) {
        const Result<TriangleSoup> soup =
            read("a.off", std::string(keyword) +
                              "\n3 1 0\n0 0 0 9 9 9 9\n1 0 0 9 9 9 9\n0 1 0 9 9 9 9\n3 0 1 2\n");
        ASSERT_TRUE(soup) << keyword;
        EXPECT_EQ(soup->positions[2].y, 1.0);
    }
    // Faces with fewer than three corners are left out; source faces keep their numbers.
    const Result<TriangleSoup> soup =
        read("a.off", "OFF\n3 3 0\n0 0 0\n1 0 0\n0 1 0\n2 0 1\n1 0\n3 0 1 2\n");
    ASSERT_TRUE(soup);
    EXPECT_EQ(soup->source_face, std::vector<Index>{2});
}

TEST(ReadOff, broken_files_are_refused_with_the_place)
{
    expect_error("a.off", "OFF BINARY\n\x01\x02", ErrorCode::cannot_read, {"binary"});
    expect_error("a.off", "4OFF\n1 1 0\n", ErrorCode::cannot_read, {"counts"});
    expect_error("a.off", "nOFF\n3 1 0\n", ErrorCode::cannot_read, {"nOFF"});
    expect_error("a.off", "OFF\n-3 1 0\n", ErrorCode::cannot_read, {"-3"});
    expect_error("a.off", "OFF\n4000000000 4000000000 0\n0 0 0\n", ErrorCode::cannot_read,
                 {"4000000000"});
    expect_error("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1\n3 0 1 2\n", ErrorCode::cannot_read,
                 {"line 5", "vertex 2 of 3"});
    expect_error("a.off", "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", ErrorCode::cannot_read,
                 {"face 1 of 2", "missing"});
    expect_error("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", ErrorCode::cannot_read,
                 {"line 6", "vertex 3"});
    expect_error("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 -1 2\n", ErrorCode::cannot_read,
                 {"vertex -1"});
    expect_error("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n999999999999 0 1 2\n",
                 ErrorCode::cannot_read, {"corner 3 of 999999999999"});
    expect_error("a.off", "OFF\n3 1 0\n0 0 0\ninf 0 0\n0 1 0\n3 0 1 2\n", ErrorCode::bad_geometry,
                 {"vertex 1"});
    expect_error("a.off", "OFF\n0 0 0\n", ErrorCode::empty_input, {});
}

TEST(ReadPly, text_with_extra_elements_and_properties_in_any_order)
{
    // Faces before vertices, coordinates out of order, lists at vertices, elements in between.
    const std::string text =
        ply_header("ascii") +
        "element note 1\nproperty list uchar int words\nproperty float weight\n"
        "element face 2\nproperty uchar flag\nproperty list uchar uint vertex_index\n"
        "element nothing 7\n"
        "element vertex 5\nproperty double z\nproperty list int float extra\nproperty double x\n"
        "property int colour\nproperty double y\nend_header\n"
        "2 8 9 0.5\n1 4 0 1 2 3\n0 3 0 4 1\n"
        "0 0 0 7 0\n0 2 1 1 1 7 0\n0 0 1 7 1\n0 0 0 7 1\n1 1 3 0.125 7 0.25\n";
    const Result<TriangleSoup> soup = read("a.ply", text);
    ASSERT_TRUE(soup) << soup.error().message;
    ASSERT_EQ(soup->positions.size(), 5u);
    EXPECT_EQ(soup->positions[4], (Vec3{0.125, 0.25, 1}));
    EXPECT_EQ(soup->triangles.size(), 3u);
    EXPECT_EQ(soup->source_face, (std::vector<Index>{0, 0, 1}));
}

TEST(ReadPly, binary_of_every_scalar_type_in_both_byte_orders)
{
    for (const bool big : {false, true}) {
        std::string bytes =
            ply_header(big ? "binary_big_endian" : "binary_little_endian") +
            "element vertex 4\nproperty char a\nproperty uint8 b\nproperty short c\n"
            "property uint16 d\nproperty double x\nproperty int32 e\n"
            "property float y\nproperty uint f\nproperty int z\n"
            "element face 1\nproperty list ushort int32 vertex_indices\n"
            "property list uint double skipped\n"
            "element face 1\nproperty list int8 uint8 vertex_indices\nend_header\n";
        for (int i = 0; i < 4; ++i) {
            put(bytes, std::int8_t{-3}, big);
            put(bytes, std::uint8_t{200}, big);
            put(bytes, std::int16_t{-300}, big);
            put(bytes, std::uint16_t{60000}, big);
            put(bytes, i == 1 ? 0.1 : -0.3 * i, big);
            put(bytes, std::int32_t{-70000}, big);
            put(bytes, i == 2 ? 0.7f : 0.0f, big);
            put(bytes, std::uint32_t{4000000000u}, big);
            put(bytes, std::int32_t{i == 3 ? -5 : 0}, big);
        }
        put(bytes, std::uint16_t{3}, big);
        for (const std::int32_t v : {0, 1, 2})
            put(bytes, v, big);
        put(bytes, std::uint32_t{2}, big);
        put(bytes, 1.5, big);
        put(bytes, 2.5, big);
        put(bytes, std::int8_t{3}, big);
        for (const std::uint8_t v : {std::uint8_t{0}, std::uint8_t{3}, std::uint8_t{1}})
            put(bytes, v, big);
        const Result<TriangleSoup> soup = read("a.ply", bytes);
        ASSERT_TRUE(soup) << soup.error().message;
        EXPECT_EQ(soup->positions[1].x, 0.1);
        EXPECT_EQ(soup->positions[2].y, static_cast<double>(0.7f));
        EXPECT_EQ(soup->positions[3].z, -5.0);
        const std::vector<std::array<Index, 3>> expected{{0, 1, 2}, {0, 3, 1}};
        EXPECT_EQ(soup->triangles, expected);
    }
}

TEST(ReadPly, triangle_strips_alternate_and_restart)
{
    const std::string header = ply_header("ascii") +
                               "element vertex 6\nproperty float x\nproperty float y\n"
                               "property float z\nelement tristrips 1\n"
                               "property list int int vertex_indices\nend_header\n"
                               "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n1 2 0\n";
    const Result<TriangleSoup> soup = read("a.ply", header + "13 0 1 2 3 -1 2 3 4 5 -1 0 0 1\n");
    ASSERT_TRUE(soup) << soup.error().message;
    const std::vector<std::array<Index, 3>> expected{{0, 1, 2}, {2, 1, 3}, {2, 3, 4}, {4, 3, 5}};
    EXPECT_EQ(soup->triangles, expected);
    // A repeated vertex turns the strip and gives no triangle.
    const Result<TriangleSoup> turned = read("a.ply", header + "5 0 1 2 2 3\n");
    ASSERT_TRUE(turned);
    EXPECT_EQ(turned->triangles, (std::vector<std::array<Index, 3>>{{0, 1, 2}}));
    expect_error("a.ply", header + "4 0 1 -2 3\n", ErrorCode::cannot_read, {"vertex -2"});
}

TEST(ReadPly, binary_data_may_start_with_the_byte_of_a_line_end)
{
    std::string bytes =
        "ply\r\nformat binary_little_endian 1.0\r\nelement vertex 3\r\n"
        "property uchar x\r\nproperty uchar y\r\nproperty uchar z\r\n"
        "element face 1\r\nproperty list uchar uchar vertex_indices\r\nend_header\r\n";
    bytes += std::string("\n\0\0\r\n\0\0\0\1", 9) + std::string("\3\0\1\2", 4);
    const Result<TriangleSoup> crlf = read("a.ply", bytes);
    ASSERT_TRUE(crlf) << crlf.error().message;
    EXPECT_EQ(crlf->positions[0].x, 10.0);
    std::string lf;
    const std::size_t body = bytes.size() - 13;
    for (std::size_t i = 0; i < bytes.size(); ++i)
        if (bytes[i] != '\r' || i >= body)
            lf += bytes[i];
    const Result<TriangleSoup> plain = read("a.ply", lf);
    ASSERT_TRUE(plain) << plain.error().message;
    EXPECT_EQ(plain->positions[0].x, 10.0);
    EXPECT_EQ(plain->positions[1].x, 13.0);
}

TEST(ReadPly, broken_files_are_refused_with_the_place)
{
    const std::string vertices = "element vertex 3\nproperty float x\nproperty float y\n"
                                 "property float z\n";
    const std::string faces = "element face 1\nproperty list uchar int vertex_indices\n";
    const std::string data = "0 0 0\n1 0 0\n0 1 0\n";
    const std::string head = ply_header("ascii") + vertices + faces + "end_header\n" + data;
    EXPECT_TRUE(read("a.ply", head + "3 0 1 2\n"));
    EXPECT_TRUE(read("a.ply", head + "3 0 1 2"));
    expect_error("a.ply", head + "3 0 1 3\n", ErrorCode::cannot_read,
                 {"line 14", "face 0 of 1", "vertex 3"});
    expect_error("a.ply", head + "3 0 1 1.5\n", ErrorCode::cannot_read, {"1.5"});
    expect_error("a.ply", head + "3 0 1\n", ErrorCode::cannot_read, {"missing"});
    expect_error("a.ply", head + "-1 0 1\n", ErrorCode::cannot_read, {"-1 entries"});
    expect_error("a.ply", head + "1e18 0 1\n", ErrorCode::cannot_read, {"ends in a list"});
    expect_error("a.ply", head + "nan 0 1\n", ErrorCode::cannot_read, {"entries"});
    expect_error("a.ply", ply_header("ascii") + vertices + "end_header\n" + data,
                 ErrorCode::empty_input, {"3 vertices"});
    expect_error("a.ply", ply_header("ascii") + vertices, ErrorCode::cannot_read, {"end_header"});
    expect_error("a.ply", "ply\nelement vertex 3\nend_header\n", ErrorCode::cannot_read,
                 {"no format"});
    expect_error("a.ply", ply_header("ebcdic"), ErrorCode::cannot_read, {"line 2", "ebcdic"});
    expect_error("a.ply", ply_header("ascii") + "element vertex many\n", ErrorCode::cannot_read,
                 {"line 4", "count"});
    expect_error("a.ply", ply_header("ascii") + "element vertex 1\nproperty quad x\n",
                 ErrorCode::cannot_read, {"quad"});
    expect_error("a.ply", ply_header("ascii") + "property float x\n", ErrorCode::cannot_read,
                 {"before"});
    expect_error("a.ply",
                 ply_header("ascii") + "element vertex 3\nproperty float x\nend_header\n1\n2\n3\n",
                 ErrorCode::cannot_read, {"x, y and z"});
    expect_error("a.ply",
                 ply_header("binary_little_endian") +
                     "element vertex 18446744073709551615\nproperty float x\nproperty float y\n"
                     "property float z\nend_header\n",
                 ErrorCode::cannot_read, {"18446744073709551615"});
    // A list length of 4e9 in a file of a few bytes.
    expect_error("a.ply",
                 ply_header("binary_little_endian") + "element vertex 0\nproperty float x\n"
                                                      "property float y\nproperty float z\n"
                                                      "element face 1\n"
                                                      "property list uint int vertex_indices\n"
                                                      "end_header\n\xff\xff\xff\xff",
                 ErrorCode::cannot_read, {"4294967295"});
}

TEST(ReadMesh, files_cut_anywhere_or_with_changed_bytes_never_crash)
{
    // Every format; every cut of small files and random changes, seeded.
    std::vector<std::pair<std::string, std::string>> files;
    files.push_back({"f.stl", binary_stl(octahedron_facets(), "solid x", 8)});
    files.push_back({"t.stl", std::string("solid a\n") + text_facet + text_facet + "endsolid\n"});
    files.push_back({"f.obj",
                     "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv .5 .5 1\nf 1 2 3 4\nf -1/2 1 2\n"
                     "f 1 2 \\\n 5\n"});
    files.push_back({"f.off", "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n3 0 1 2\n"});
    files.push_back({"t.ply", ply_header("ascii") +
                                  "element vertex 4\nproperty float x\nproperty float y\n"
                                  "property double z\nelement tristrips 1\n"
                                  "property list int int vertex_indices\nelement face 1\n"
                                  "property list uchar int vertex_indices\nend_header\n"
                                  "0 0 0\n1 0 0\n1 1 0\n0 1 0\n6 0 1 2 -1 0 1\n4 0 1 2 3\n"});
    std::string binary = ply_header("binary_big_endian") +
                         "element vertex 3\nproperty short x\nproperty short y\nproperty short z\n"
                         "element face 2\nproperty list uchar int vertex_indices\nend_header\n";
    for (int i = 0; i < 9; ++i)
        put(binary, static_cast<std::int16_t>(i * i), true);
    for (int f = 0; f < 2; ++f) {
        put(binary, std::uint8_t{3}, true);
        for (const std::int32_t v : {0, 1, 2})
            put(binary, v, true);
    }
    files.push_back({"b.ply", binary});
    std::mt19937 random(42);
    int readable = 0;
    for (const auto& [name, bytes] : files) {
        EXPECT_TRUE(read(name, bytes)) << name;
        for (std::size_t n = 0; n < bytes.size(); ++n)
            readable += read(name, bytes.substr(0, n)).ok();
        for (int i = 0; i < 400; ++i) {
            std::string changed = bytes;
            for (unsigned k = 0; k <= random() % 4; ++k)
                changed[random() % changed.size()] =
                    i % 2 == 0 ? static_cast<char>(random()) : "0123456789-+.eE \n/"[random() % 18];
            const Result<TriangleSoup> soup = read(name, changed);
            readable += soup.ok();
            if (!soup)
                continue;
            for (const auto& t : soup->triangles)
                for (const Index v : t)
                    ASSERT_LT(v, soup->positions.size());
            for (const Vec3& p : soup->positions)
                ASSERT_TRUE(is_finite(p));
            ASSERT_EQ(soup->source_face.size(), soup->triangles.size());
        }
    }
    EXPECT_GT(readable, 100);
}
