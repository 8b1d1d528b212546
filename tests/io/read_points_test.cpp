// SPDX-License-Identifier: MIT
#include "bot2nurbs/read_points.h"

#include "io/lzf.h"
#include "read_fixtures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <clocale>
#include <cmath>
#include <cstring>
#include <functional>
#include <random>

using namespace bot2nurbs;
using bot2nurbs::test::expect_error_of;
using bot2nurbs::test::put;
using bot2nurbs::test::ScratchFile;

namespace {

Result<PointCloud> read(const std::string& name, const std::string& bytes)
{
    const ScratchFile file(name, bytes);
    Context context;
    return read_points(file.path(), context);
}

PointCloud must_read(const std::string& name, const std::string& bytes)
{
    const Result<PointCloud> cloud = read(name, bytes);
    EXPECT_TRUE(cloud) << cloud.error().message;
    return cloud ? *cloud : PointCloud{};
}

void expect_error(const std::string& name, const std::string& bytes, ErrorCode code,
                  const std::vector<std::string>& words)
{
    expect_error_of(read(name, bytes), name, bytes, code, words);
}

// The cloud that every format below stores: four points, unit normals, colours.
const std::vector<Vec3> positions{
    {0.5, -1.25, 2.0}, {1e-3, 3.0, -4.5}, {100.0, 0.0, 0.25}, {-7.0, 8.5, 9.0}};
const std::vector<Vec3> normals{{0, 0, 1}, {0.6, 0.8, 0}, {-1, 0, 0}, {0, -0.6, 0.8}};
const std::vector<std::array<std::uint8_t, 3>> colors{
    {0, 10, 255}, {1, 2, 3}, {200, 100, 50}, {255, 255, 255}};

std::string digits(double x)
{
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", x);
    return text;
}

std::string row_text(std::size_t i, bool with_normals, bool with_colors, char separator = ' ')
{
    std::string text;
    const auto add = [&](const std::string& word) {
        text += (text.empty() ? "" : std::string(1, separator)) + word;
    };
    for (int k = 0; k < 3; ++k)
        add(digits(positions[i][k]));
    for (int k = 0; k < 3 && with_normals; ++k)
        add(digits(normals[i][k]));
    for (std::size_t k = 0; k < 3 && with_colors; ++k)
        add(std::to_string(colors[i][k]));
    return text + "\n";
}

std::string rows_text(bool with_normals, bool with_colors, char separator = ' ')
{
    std::string text;
    for (std::size_t i = 0; i < positions.size(); ++i)
        text += row_text(i, with_normals, with_colors, separator);
    return text;
}

std::string ply_file(const std::string& format)
{
    std::string bytes = "ply\nformat " + format +
                        " 1.0\nelement vertex 4\nproperty double x\nproperty double y\n"
                        "property double z\nproperty double nx\nproperty double ny\n"
                        "property double nz\nproperty uchar red\nproperty uchar green\n"
                        "property uchar blue\nend_header\n";
    if (format == "ascii")
        return bytes + rows_text(true, true);
    const bool big = format == "binary_big_endian";
    for (std::size_t i = 0; i < positions.size(); ++i) {
        for (int k = 0; k < 3; ++k)
            put(bytes, positions[i][k], big);
        for (int k = 0; k < 3; ++k)
            put(bytes, normals[i][k], big);
        for (std::size_t k = 0; k < 3; ++k)
            put(bytes, colors[i][k]);
    }
    return bytes;
}

std::uint32_t packed(const std::array<std::uint8_t, 3>& c)
{
    return std::uint32_t{c[0]} << 16 | std::uint32_t{c[1]} << 8 | c[2];
}

//! A block of LZF that copies everything.
std::string stored_lzf(const std::string& bytes)
{
    std::string block;
    for (std::size_t i = 0; i < bytes.size(); i += 32) {
        const std::string run = bytes.substr(i, 32);
        block += static_cast<char>(run.size() - 1);
        block += run;
    }
    return block;
}

std::string pcd_header(const std::string& viewpoint = "0 0 0 1 0 0 0")
{
    return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n"
           "FIELDS x y z normal_x normal_y normal_z _ rgb\nSIZE 8 8 8 8 8 8 1 4\n"
           "TYPE F F F F F F U U\nCOUNT 1 1 1 1 1 1 4 1\nWIDTH 2\nHEIGHT 2\nVIEWPOINT " +
           viewpoint + "\nPOINTS 4\n";
}

std::string pcd_file(const std::string& data)
{
    std::string bytes = pcd_header() + "DATA " + data + "\n";
    if (data == "ascii") {
        for (std::size_t i = 0; i < positions.size(); ++i) {
            std::string row = row_text(i, true, false);
            row.pop_back();
            bytes += row + " 0 0 0 0 " + std::to_string(packed(colors[i])) + "\n";
        }
        return bytes;
    }
    std::string raw;
    if (data == "binary") {
        for (std::size_t i = 0; i < positions.size(); ++i) {
            for (int k = 0; k < 3; ++k)
                put(raw, positions[i][k]);
            for (int k = 0; k < 3; ++k)
                put(raw, normals[i][k]);
            raw.append(4, '\0');
            put(raw, packed(colors[i]));
        }
        return bytes + raw;
    }
    for (int k = 0; k < 3; ++k)
        for (const Vec3& p : positions)
            put(raw, p[k]);
    for (int k = 0; k < 3; ++k)
        for (const Vec3& n : normals)
            put(raw, n[k]);
    raw.append(16, '\0');
    for (const auto& c : colors)
        put(raw, packed(c));
    const std::string block = stored_lzf(raw);
    put(bytes, static_cast<std::uint32_t>(block.size()));
    put(bytes, static_cast<std::uint32_t>(raw.size()));
    return bytes + block;
}

//! Point format 2: coordinates as whole multiples of 1/1024, 16-bit colours.
std::string las_file(unsigned char format = 2)
{
    std::string header(227, '\0');
    const auto set = [&header](std::size_t at, auto value) {
        std::memcpy(&header[at], &value, sizeof value);
    };
    header.replace(0, 4, "LASF");
    set(24, std::uint8_t{1});
    set(25, std::uint8_t{2});
    set(94, std::uint16_t{227});
    set(96, std::uint32_t{227});
    set(104, std::uint8_t{format});
    set(105, std::uint16_t{26});
    set(107, std::uint32_t{4});
    for (std::size_t k = 0; k < 3; ++k) {
        set(131 + 8 * k, 1.0 / 1024.0);
        set(155 + 8 * k, 1.0);
    }
    std::string bytes = header;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        for (int k = 0; k < 3; ++k)
            put(bytes, static_cast<std::int32_t>(std::lround(1024.0 * (positions[i][k] - 1.0))));
        put(bytes, static_cast<std::uint16_t>(7 * i));
        bytes.append(6, '\0');
        for (std::size_t k = 0; k < 3; ++k)
            put(bytes, static_cast<std::uint16_t>(257 * colors[i][k]));
    }
    return bytes;
}

std::string obj_file()
{
    std::string bytes = "# points\n";
    for (std::size_t i = 0; i < positions.size(); ++i)
        bytes += "v " + row_text(i, false, true);
    for (const Vec3& n : normals)
        bytes += "vn " + digits(n.x) + " " + digits(n.y) + " " + digits(n.z) + "\n";
    return bytes;
}

struct Sample {
    std::string name, bytes;
    bool normals = true, colors = true;
};

std::vector<Sample> samples()
{
    std::vector<Sample> all;
    for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"})
        all.push_back({std::string(format) + ".ply", ply_file(format)});
    for (const char* data : {"ascii", "binary", "binary_compressed"})
        all.push_back({std::string(data) + ".pcd", pcd_file(data)});
    all.push_back({"a.obj", obj_file()});
    all.push_back({"a.off", "CNOFF\n4 0 0\n" + rows_text(true, true)});
    all.push_back({"a.las", las_file(), false, true});
    all.push_back({"plain.xyz", rows_text(false, false), false, false});
    all.push_back({"normals.xyz", rows_text(true, false), true, false});
    all.push_back({"colors.txt", rows_text(false, true), false, true});
    all.push_back({"both.asc", rows_text(true, true)});
    all.push_back({"commas.csv", rows_text(true, true, ',')});
    all.push_back({"semicolons.txt", rows_text(true, true, ';')});
    all.push_back({"counted.pts", "4\r\n" + rows_text(true, true)});
    all.push_back({"named.csv", "//X,Y,Z,Nx,Ny,Nz,R,G,B\n" + rows_text(true, true, ',')});
    all.push_back({"unknown_extension.dat", rows_text(true, true)});
    return all;
}

} // namespace

TEST(ReadPoints, every_format_gives_the_points_normals_and_colours_it_stores)
{
    for (const Sample& sample : samples()) {
        SCOPED_TRACE(sample.name);
        const PointCloud cloud = must_read(sample.name, sample.bytes);
        ASSERT_EQ(cloud.size(), positions.size());
        for (std::size_t i = 0; i < positions.size(); ++i)
            // LAS stores whole multiples of its scale.
            EXPECT_LE(norm(cloud.positions[i] - positions[i]),
                      sample.name == "a.las" ? 1.0 / 1024.0 : 0.0);
        EXPECT_EQ(cloud.normals, sample.normals ? normals : std::vector<Vec3>{});
        EXPECT_EQ(cloud.colors, sample.colors ? colors : decltype(cloud.colors){});
        EXPECT_FALSE(cloud.viewpoint);
    }
}

TEST(ReadPoints, numbers_do_not_depend_on_the_locale)
{
    if (std::setlocale(LC_ALL, "de_DE.UTF-8") == nullptr)
        GTEST_SKIP() << "no locale with a decimal comma is installed";
    const PointCloud cloud = must_read("locale.xyz", rows_text(true, false));
    std::setlocale(LC_ALL, "C");
    EXPECT_EQ(cloud.positions, positions);
}

TEST(ReadPoints, confidence_and_intensity_are_kept)
{
    const PointCloud cloud =
        must_read("c.ply", "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\n"
                           "property float y\nproperty float z\nproperty float confidence\n"
                           "property float intensity\nend_header\n0 0 0 0.5 9\n1 1 1 0.25 8\n");
    EXPECT_EQ(cloud.confidence, (std::vector<double>{0.5, 0.25}));
    EXPECT_EQ(cloud.intensity, (std::vector<double>{9, 8}));
}

TEST(ReadPoints, real_colours_are_of_zero_to_one)
{
    const PointCloud cloud =
        must_read("c.ply", "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\n"
                           "property float y\nproperty float z\nproperty float red\n"
                           "property float green\nproperty float blue\nend_header\n"
                           "0 0 0 1 0.2 0\n1 1 1 0 0 0.4\n");
    EXPECT_EQ(cloud.colors[0], (std::array<std::uint8_t, 3>{255, 51, 0}));
    EXPECT_EQ(cloud.colors[1], (std::array<std::uint8_t, 3>{0, 0, 102}));
}

TEST(ReadPoints, faces_of_a_mesh_file_are_passed_over)
{
    const PointCloud cloud =
        must_read("mesh.ply",
                  "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\n"
                  "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                  "end_header\n3 0 1 2\n0 0 0\n1 0 0\n0 1 0\n");
    EXPECT_EQ(cloud.positions, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    EXPECT_EQ(must_read("mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").size(), 3u);
    EXPECT_EQ(must_read("mesh.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n").size(), 3u);
}

TEST(ReadPoints, an_organised_scan_keeps_its_points_that_saw_nothing)
{
    const PointCloud cloud =
        must_read("organised.pcd", "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\n"
                                   "HEIGHT 2\nPOINTS 4\nDATA ascii\n0 0 1\nnan nan nan\n"
                                   "1 0 1\nnan nan nan\n");
    ASSERT_EQ(cloud.size(), 4u);
    EXPECT_TRUE(std::isnan(cloud.positions[1].x));
    EXPECT_EQ(cloud.positions[2], (Vec3{1, 0, 1}));
}

TEST(ReadPoints, a_viewpoint_away_from_the_origin_is_where_the_scanner_stood)
{
    std::string bytes = pcd_header("1 -2 3.5 1 0 0 0") + "DATA binary\n";
    bytes.resize(bytes.size() + 4 * 56, '\0');
    const PointCloud cloud = must_read("viewpoint.pcd", bytes);
    ASSERT_TRUE(cloud.viewpoint);
    EXPECT_EQ(*cloud.viewpoint, (Vec3{1, -2, 3.5}));
}

TEST(ReadPoints, floats_that_pack_a_colour_are_unpacked)
{
    float as_float;
    const std::uint32_t bits = packed({200, 100, 50});
    std::memcpy(&as_float, &bits, 4);
    const std::string header = "FIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F F\nWIDTH 1\nHEIGHT 1\n"
                               "POINTS 1\nDATA ";
    std::string binary = header + "binary\n";
    for (const float v : {1.0f, 2.0f, 3.0f, as_float})
        put(binary, v);
    for (const PointCloud& cloud :
         {must_read("packed.pcd", binary),
          must_read("packed.pcd", header + "ascii\n1 2 3 " + digits(as_float) + "\n")}) {
        ASSERT_EQ(cloud.colors.size(), 1u);
        EXPECT_EQ(cloud.colors[0], (std::array<std::uint8_t, 3>{200, 100, 50}));
    }
}

TEST(ReadPoints, columns_are_normals_only_if_they_are_unit_or_zero)
{
    const auto has = [](const std::string& row, std::size_t repeat = 3) {
        std::string text;
        for (std::size_t i = 0; i < repeat; ++i)
            text += std::to_string(i) + " 2 3 " + row + "\n";
        const PointCloud cloud = must_read("columns.xyz", text);
        return std::string(cloud.normals.empty() ? "" : "n") + (cloud.colors.empty() ? "" : "c") +
               (cloud.intensity.empty() ? "" : "i");
    };
    EXPECT_EQ(has(""), "");
    EXPECT_EQ(has("0.6 0.8 0"), "n");
    EXPECT_EQ(has("0 0 0"), "n");
    EXPECT_EQ(has("255 0 12"), "c");
    EXPECT_EQ(has("0.4 0.3 0.2"), "");
    EXPECT_EQ(has("300 2 1"), "");
    EXPECT_EQ(has("77"), "i");
    EXPECT_EQ(has("77 5"), "");
    EXPECT_EQ(has("-1012 255 0 12"), "ci");
    EXPECT_EQ(has("0.6 0.8 0 0.01"), "n"); // a curvature behind the normal
    EXPECT_EQ(has("255 0 12 0 -1 0"), "nc");
    EXPECT_EQ(has("0 -1 0 255 0 12"), "nc");
    EXPECT_EQ(has("9 0 -1 0 255 0 12"), "nci");
}

TEST(ReadPoints, parts_that_each_start_with_their_count_are_read_in_turn)
{
    const PointCloud cloud = must_read("parts.pts", "2\n0 0 0\n1 0 0\n1\n2 0 0\n");
    EXPECT_EQ(cloud.size(), 3u);
    expect_error("parts.pts", "2\n0 0 0\n1 0 0\n2 0 0\n", ErrorCode::cannot_read,
                 {"line 4", "more points than"});
    expect_error("parts.pts", "3\n0 0 0\n1 0 0\n", ErrorCode::cannot_read, {"1 points too early"});
}

TEST(ReadPoints, errors_of_text_name_the_line)
{
    expect_error("bad.xyz", "0 0 0\n1 1 1\n1 x 1\n", ErrorCode::cannot_read,
                 {"line 3", "point 3", "\"x\""});
    expect_error("bad.xyz", "0 0 0\n1 1 1 1\n", ErrorCode::cannot_read,
                 {"line 2", "4 numbers", "3"});
    expect_error("bad.xyz", "0 0\n", ErrorCode::cannot_read, {"line 1", "2 numbers"});
    expect_error("bad.xyz", "0 0 0\n7\n", ErrorCode::cannot_read, {"line 2", "single number"});
    expect_error("bad.asc", "ncols 480\nnrows 450\n", ErrorCode::cannot_read,
                 {"line 1", "names of columns"});
    expect_error("bad.csv", "x,y,z,nx\n0,0,0\n", ErrorCode::cannot_read,
                 {"4 columns", "3 numbers"});
    expect_error("bad.xyz", "1,5 2,5 3,5\n", ErrorCode::cannot_read, {"decimal commas"});
    expect_error("bad.csv", "1,5;2,5;3,5\n", ErrorCode::cannot_read, {"decimal commas"});
    expect_error("bad.ply",
                 "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
                 "property float z\nend_header\n0 0 0\n0 zero 0\n",
                 ErrorCode::cannot_read, {"line 9", "vertex 1 of 2", "\"zero\""});
    expect_error("bad.pcd",
                 "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 1\nHEIGHT 1\nPOINTS 2\nDATA ascii\n"
                 "0 0 0\n1 two 3\n",
                 ErrorCode::cannot_read, {"line 9", "point 1 of 2", "\"two\""});
    expect_error("bad.obj", "v 0 0 0\nv 1 0\n", ErrorCode::cannot_read, {"line 2", "vertex 2"});
    expect_error("bad.off", "OFF\n2 0 0\n0 0 0\n0 0 q\n", ErrorCode::cannot_read,
                 {"line 4", "vertex 1", "\"q\""});
}

TEST(ReadPoints, files_without_points_are_empty)
{
    expect_error("empty.xyz", "# nothing\n\n", ErrorCode::empty_input, {"no points"});
    expect_error("empty.pts", "0\n", ErrorCode::empty_input, {"no points"});
    expect_error("empty.obj", "# nothing\n", ErrorCode::empty_input, {"no vertices"});
    expect_error("empty.off", "OFF\n0 0 0\n", ErrorCode::empty_input, {"no points"});
    expect_error("empty.ply",
                 "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\n"
                 "property float z\nend_header\n",
                 ErrorCode::empty_input, {"no points"});
    expect_error("empty.pcd", "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 0\nDATA ascii\n",
                 ErrorCode::empty_input, {"no points"});
}

TEST(ReadPoints, formats_that_are_not_read_are_refused_with_the_way_out)
{
    expect_error("scan.e57", "ASTM-E57", ErrorCode::cannot_read, {".las or .ply"});
    expect_error("scan.laz", "LASF", ErrorCode::cannot_read, {".las or .ply"});
    expect_error("scan.las", las_file(2 + 128), ErrorCode::cannot_read, {"LAZ"});
    expect_error("scan.las", las_file(11), ErrorCode::cannot_read, {"point format 11"});
    expect_error("scan.stl", "solid\n", ErrorCode::cannot_read, {"STL"});
    expect_error("scan.unknown", "hello", ErrorCode::cannot_read, {"known are"});
}

TEST(ReadPoints, files_cut_anywhere_give_an_error_or_fewer_points_but_never_other_points)
{
    for (const Sample& sample : samples())
        for (std::size_t length = 0; length < sample.bytes.size(); ++length) {
            const Result<PointCloud> cloud = read(sample.name, sample.bytes.substr(0, length));
            if (!cloud) {
                ASSERT_NE(cloud.error().message.find(sample.name), std::string::npos);
                continue;
            }
            // Only text without a promised count can end early; its last number may be cut too.
            ASSERT_LE(cloud->size(), positions.size()) << sample.name << " cut at " << length;
            for (std::size_t i = 0; i + 1 < cloud->size(); ++i)
                ASSERT_EQ(cloud->positions[i],
                          sample.name == "a.las" ? cloud->positions[i] : positions[i])
                    << sample.name << " cut at " << length;
        }
}

TEST(ReadPoints, files_with_bytes_changed_at_random_never_crash)
{
    std::mt19937 random(20241);
    for (const Sample& sample : samples())
        for (int round = 0; round < 400; ++round) {
            std::string bytes = sample.bytes;
            for (int change = 0; change < 1 + round % 4; ++change)
                bytes[random() % bytes.size()] = static_cast<char>(random());
            const Result<PointCloud> cloud = read(sample.name, bytes);
            if (cloud) {
                ASSERT_LE(cloud->size(), bytes.size());
                ASSERT_TRUE(cloud->normals.empty() || cloud->normals.size() == cloud->size());
                ASSERT_TRUE(cloud->colors.empty() || cloud->colors.size() == cloud->size());
            } else {
                ASSERT_FALSE(cloud.error().message.empty());
            }
        }
}

TEST(ReadPoints, counts_that_the_file_cannot_hold_are_refused_without_the_memory_for_them)
{
    expect_error("huge.ply",
                 "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000000\n"
                 "property float x\nproperty float y\nproperty float z\nend_header\n",
                 ErrorCode::cannot_read, {"too short"});
    expect_error("huge.pcd",
                 "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 4000000000000\nDATA binary\n",
                 ErrorCode::cannot_read, {"too short"});
    std::string compressed =
        "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 100000000\nDATA binary_compressed\n";
    put(compressed, std::uint32_t{4});
    put(compressed, std::uint32_t{1200000000});
    expect_error("huge.pcd", compressed + "abcd", ErrorCode::cannot_read, {"too short"});
    expect_error("huge.off", "OFF\n4000000000 0 0\n", ErrorCode::cannot_read, {"too short"});
    std::string las = las_file();
    const std::uint32_t count = 4000000000u;
    std::memcpy(&las[107], &count, 4);
    expect_error("huge.las", las, ErrorCode::cannot_read, {"too short"});
}

TEST(ReadPoints, cancels)
{
    const ScratchFile file("cancel.xyz", rows_text(true, true));
    Context context;
    context.cancel();
    const Result<PointCloud> cloud = read_points(file.path(), context);
    ASSERT_FALSE(cloud);
    EXPECT_EQ(cloud.error().code, ErrorCode::cancelled);
}

TEST(Lzf, copies_bytes_and_repeats_what_came_before)
{
    // "ab", then five bytes from two back (overlapping), then a long run of 7 + 2 + 3 bytes from 1.
    const std::string packed{"\x01"
                             "ab"
                             "\x60\x01"
                             "\xe0\x03\x00",
                             8};
    std::string unpacked(2 + 5 + 12, '\0');
    ASSERT_TRUE(unpack_lzf(packed, unpacked));
    EXPECT_EQ(unpacked, "abababa" + std::string(12, 'a'));
}

TEST(Lzf, refuses_blocks_that_are_cut_or_reach_back_too_far)
{
    std::string unpacked(4, '\0');
    EXPECT_FALSE(unpack_lzf(std::string("\x05"
                                        "ab"),
                            unpacked));
    EXPECT_FALSE(unpack_lzf(std::string("\x20\x00", 2), unpacked));
    EXPECT_FALSE(unpack_lzf(std::string("\x00"
                                        "a"
                                        "\xe0",
                                        3),
                            unpacked));
    EXPECT_FALSE(unpack_lzf(std::string("\x00"
                                        "a",
                                        2),
                            unpacked)); // too few
    EXPECT_FALSE(unpack_lzf(std::string("\x00"
                                        "a"
                                        "\x60\x00",
                                        4),
                            unpacked)); // too many
}

TEST(FileContent, is_points_where_the_file_lists_no_faces)
{
    const auto content = [](const std::string& name, const std::string& bytes) {
        const ScratchFile file(name, bytes);
        Context context;
        const Result<FileContent> found = file_content(file.path(), context);
        EXPECT_TRUE(found);
        return found && *found == FileContent::points;
    };
    for (const Sample& sample : samples())
        EXPECT_TRUE(content(sample.name, sample.bytes)) << sample.name;
    EXPECT_TRUE(content("a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
                                 "property float y\nproperty float z\nelement face 0\n"
                                 "property list uchar int vertex_indices\nend_header\n0 0 0\n"));
    EXPECT_FALSE(content("a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
                                  "property float y\nproperty float z\nelement face 1\n"
                                  "property list uchar int vertex_indices\nend_header\n"));
    EXPECT_FALSE(content("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
    EXPECT_TRUE(content("a.obj", "v 0 0 0\nv 1 0 0\np 1\np 2\n"));
    EXPECT_FALSE(content("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"));
    EXPECT_FALSE(content("a.stl", "solid\nendsolid\n"));
    EXPECT_FALSE(content("a.unknown", "solid\nendsolid\n"));
}
