// SPDX-License-Identifier: MIT
// The bytes of .3dm files. What openNURBS makes of them is tested in tests/judges.
#include "bot2nurbs/write_brep.h"

#include "brep/brep_fixtures.h"
#include "io/archive_3dm.h"

#include <cstring>
#include <gtest/gtest.h>

namespace bot2nurbs {
namespace {

using namespace fixtures;

const Brep& sphere()
{
    static const Brep brep = sphere_brep(0, KnotForm::c1);
    return brep;
}

std::uint64_t little_endian(const std::string& bytes, std::size_t at, int count)
{
    std::uint64_t value = 0;
    for (int i = count - 1; i >= 0; --i)
        value = value << 8 | static_cast<std::uint8_t>(bytes[at + i]);
    return value;
}

TEST(Archive3dm, crc_is_the_one_of_zlib)
{
    EXPECT_EQ(crc32(0, "123456789", 9), 0xCBF43926u);
    EXPECT_EQ(crc32(crc32(0, "1234", 4), "56789", 5), 0xCBF43926u);
    EXPECT_EQ(crc32(0, "", 0), 0u);
}

TEST(Archive3dm, crc_leaves_out_what_belongs_to_nested_chunks)
{
    constexpr std::uint32_t with_crc = 0x40008000, without = 0x00000001;
    ArchiveWriter out(50);
    out.begin(with_crc);
    out.text("1234");
    out.begin(without);
    out.text("nested");
    out.end();
    out.text("56789");
    out.end();
    const std::string& b = out.bytes();
    EXPECT_EQ(little_endian(b, 4, 8), b.size() - 12);
    EXPECT_EQ(little_endian(b, b.size() - 4, 4), 0xCBF43926u);
}

TEST(Archive3dm, lengths_have_four_bytes_before_version_50)
{
    for (int version : {4, 50}) {
        ArchiveWriter out(version);
        out.begin(1);
        out.text("abc");
        out.end();
        const int width = version == 4 ? 4 : 8;
        EXPECT_EQ(out.bytes().size(), 4u + width + 3u);
        EXPECT_EQ(little_endian(out.bytes(), 4, width), 3u);
    }
}

TEST(Archive3dm, ids_have_the_byte_order_of_their_groups)
{
    const Uuid id = uuid_from_text("00112233-4455-6677-8899-AaBbCcDdEeFf");
    const Uuid expected{0x33, 0x22, 0x11, 0x00, 0x55, 0x44, 0x77, 0x66,
                        0x88, 0x99, 0xAA, 0xBB, 0xCC, 0xDD, 0xEE, 0xFF};
    EXPECT_EQ(id, expected);
}

std::vector<std::uint64_t> units_of(const std::string& utf8)
{
    ArchiveWriter out(50);
    out.wide_string(utf8);
    std::vector<std::uint64_t> units;
    for (std::size_t i = 4; i < out.bytes().size(); i += 2)
        units.push_back(little_endian(out.bytes(), i, 2));
    EXPECT_EQ(little_endian(out.bytes(), 0, 4), units.size());
    return units;
}

TEST(Archive3dm, strings_are_utf16_with_a_closing_zero_and_bad_bytes_replaced)
{
    using Units = std::vector<std::uint64_t>;
    EXPECT_EQ(units_of(""), Units{});
    EXPECT_EQ(units_of("a\xC3\xA4\xE2\x82\xAC"), (Units{'a', 0xE4, 0x20AC, 0}));
    EXPECT_EQ(units_of("\xF0\x9F\x90\xB0"), (Units{0xD83D, 0xDC30, 0}));
    // A lone continuation byte, a cut sequence, an overlong one, a surrogate.
    EXPECT_EQ(units_of("\x80z"), (Units{0xFFFD, 'z', 0}));
    EXPECT_EQ(units_of("\xE2\x82"), (Units{0xFFFD, 0xFFFD, 0}));
    EXPECT_EQ(units_of("\xC0\xAF"), (Units{0xFFFD, 0}));
    EXPECT_EQ(units_of("\xED\xA0\x80"), (Units{0xFFFD, 0}));
}

TEST(Write3dm, starts_with_the_version_and_ends_with_the_size)
{
    for (int version : {4, 50, 60, 70, 80}) {
        WriteOptions options;
        options.archive_version = version;
        const Result<std::string> bytes = brep_to_3dm({sphere()}, options);
        ASSERT_TRUE(bytes.ok());
        std::string number = std::to_string(version);
        number.insert(0, 8 - number.size(), ' ');
        EXPECT_EQ(bytes->substr(0, 32), "3D Geometry File Format " + number);
        const int width = version < 50 ? 4 : 8;
        EXPECT_EQ(little_endian(*bytes, bytes->size() - width, width), bytes->size());
        EXPECT_EQ(little_endian(*bytes, bytes->size() - 2 * width - 4, 4), 0x7FFFu);
    }
}

TEST(Write3dm, equal_input_gives_equal_bytes_and_other_input_other_ids)
{
    const Result<std::string> a = brep_to_3dm({sphere()}), b = brep_to_3dm({sphere()});
    ASSERT_TRUE(a.ok() && b.ok());
    EXPECT_EQ(*a, *b);
    Brep other = sphere();
    other.surfaces[0].control[44].x += 1e-12;
    const Result<std::string> c = brep_to_3dm({other});
    ASSERT_TRUE(c.ok());
    ASSERT_EQ(a->size(), c->size());
    std::size_t differ = 0;
    for (std::size_t i = 0; i < a->size(); ++i)
        differ += (*a)[i] != (*c)[i];
    // A few bytes of the number, its CRC, and most of the sixteen of the id with theirs.
    EXPECT_GT(differ, 12u);
    EXPECT_LT(differ, 40u);
}

TEST(Write3dm, refuses_versions_units_and_breps_it_cannot_write)
{
    const auto code = [](const std::vector<Brep>& breps, const WriteOptions& options) {
        const Result<std::string> bytes = brep_to_3dm(breps, options);
        EXPECT_FALSE(bytes.ok());
        return bytes.ok() ? ErrorCode::internal : bytes.error().code;
    };
    WriteOptions version, units;
    version.archive_version = 5;
    units.units = "cubit";
    EXPECT_EQ(code({sphere()}, version), ErrorCode::bad_option);
    EXPECT_EQ(code({sphere()}, units), ErrorCode::bad_option);
    EXPECT_EQ(code({}, {}), ErrorCode::empty_input);
    Brep broken = sphere();
    broken.edges[3].curve = 1000;
    EXPECT_EQ(code({sphere(), broken}, {}), ErrorCode::brep_failed);
}

TEST(Write3dm, says_why_a_path_cannot_be_written)
{
    const Status status = write_3dm({sphere()}, "/missing folder/a.3dm");
    ASSERT_TRUE(status.has_value());
    EXPECT_EQ(status->code, ErrorCode::cannot_write);
}

} // namespace
} // namespace bot2nurbs
