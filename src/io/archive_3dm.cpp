// SPDX-License-Identifier: MIT
#include "io/archive_3dm.h"

#include "io/utf8.h"

#include <cassert>
#include <cstring>

namespace bot2nurbs {

namespace {

// Chunks with this bit in their typecode end with a CRC.
constexpr std::uint32_t crc_bit = 0x00008000u;

constexpr std::array<std::uint32_t, 256> make_crc_table()
{
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t n = 0; n < 256; ++n) {
        std::uint32_t c = n;
        for (int k = 0; k < 8; ++k)
            c = (c & 1u) ? 0xEDB88320u ^ (c >> 1) : c >> 1;
        table[n] = c;
    }
    return table;
}
constexpr std::array<std::uint32_t, 256> crc_table = make_crc_table();

int hex_digit(char c)
{
    return c <= '9' ? c - '0' : (c | 0x20) - 'a' + 10;
}

} // namespace

Uuid uuid_from_text(const char* text)
{
    Uuid id{};
    for (std::size_t i = 0; i < id.size(); ++text) {
        if (*text == '-')
            continue;
        id[i++] = static_cast<std::uint8_t>(hex_digit(text[0]) << 4 | hex_digit(text[1]));
        ++text;
    }
    return {id[3], id[2], id[1],  id[0],  id[5],  id[4],  id[7],  id[6],
            id[8], id[9], id[10], id[11], id[12], id[13], id[14], id[15]};
}

std::uint32_t crc32(std::uint32_t crc, const void* bytes, std::size_t count)
{
    const auto* p = static_cast<const std::uint8_t*>(bytes);
    crc = ~crc;
    for (std::size_t i = 0; i < count; ++i)
        crc = crc_table[(crc ^ p[i]) & 0xFFu] ^ (crc >> 8);
    return ~crc;
}

void ArchiveWriter::put(const void* data, std::size_t count)
{
    bytes_.append(static_cast<const char*>(data), count);
}

void ArchiveWriter::byte(int value)
{
    bytes_.push_back(static_cast<char>(value));
}

void ArchiveWriter::int16(int value)
{
    byte(value & 0xFF);
    byte(value >> 8 & 0xFF);
}

void ArchiveWriter::int32(std::int64_t value)
{
    for (int shift = 0; shift < 32; shift += 8)
        byte(static_cast<int>(value >> shift & 0xFF));
}

void ArchiveWriter::real(double value)
{
    std::uint64_t bits = 0;
    static_assert(sizeof bits == sizeof value);
    std::memcpy(&bits, &value, sizeof bits);
    std::array<char, 8> out{};
    for (int i = 0; i < 8; ++i)
        out[i] = static_cast<char>(bits >> (8 * i) & 0xFF);
    put(out.data(), out.size());
}

void ArchiveWriter::reals(const std::vector<double>& values)
{
    for (double v : values)
        real(v);
}

void ArchiveWriter::point(const Vec3& p)
{
    real(p.x);
    real(p.y);
    real(p.z);
}

void ArchiveWriter::point(const Vec2& p)
{
    real(p.x);
    real(p.y);
}

void ArchiveWriter::interval(double a, double b)
{
    real(a);
    real(b);
}

void ArchiveWriter::box(const Box3& b)
{
    point(b.empty() ? Vec3{} : b.min);
    point(b.empty() ? Vec3{} : b.max);
}

void ArchiveWriter::uuid(const Uuid& id)
{
    put(id.data(), id.size());
}

void ArchiveWriter::zeros(int count)
{
    bytes_.append(static_cast<std::size_t>(count), '\0');
}

void ArchiveWriter::text(std::string_view bytes)
{
    bytes_.append(bytes);
}

void ArchiveWriter::wide_string(std::string_view utf8)
{
    std::vector<std::uint16_t> units;
    while (!utf8.empty()) {
        const std::uint32_t c = next_code_point(utf8);
        if (c >= 0x10000) {
            units.push_back(static_cast<std::uint16_t>(0xD800 + ((c - 0x10000) >> 10)));
            units.push_back(static_cast<std::uint16_t>(0xDC00 + ((c - 0x10000) & 0x3FF)));
        } else if (c != 0) { // a zero would end the string
            units.push_back(static_cast<std::uint16_t>(c));
        }
    }
    if (units.empty()) {
        int32(0);
        return;
    }
    units.push_back(0);
    int32(static_cast<std::int64_t>(units.size()));
    for (std::uint16_t u : units)
        int16(u);
}

void ArchiveWriter::header(std::uint32_t typecode, std::int64_t value)
{
    int32(typecode);
    int32(value);
    if (version_ >= 50)
        int32(value >> 32);
}

void ArchiveWriter::absorb()
{
    if (!open_.empty()) {
        Open& chunk = open_.back();
        chunk.crc =
            crc32(chunk.crc, bytes_.data() + chunk.plain_at, bytes_.size() - chunk.plain_at);
    }
}

void ArchiveWriter::resume()
{
    if (!open_.empty())
        open_.back().plain_at = bytes_.size();
}

void ArchiveWriter::short_chunk(std::uint32_t typecode, std::int64_t value)
{
    absorb();
    header(typecode, value);
    resume();
}

void ArchiveWriter::begin(std::uint32_t typecode)
{
    absorb();
    header(typecode, 0);
    const std::size_t width = version_ >= 50 ? 8 : 4;
    open_.push_back({typecode, bytes_.size() - width, bytes_.size(), 0});
}

void ArchiveWriter::end()
{
    assert(!open_.empty());
    absorb();
    const Open chunk = open_.back();
    open_.pop_back();
    if (chunk.typecode & crc_bit)
        int32(chunk.crc);
    const std::size_t width = version_ >= 50 ? 8 : 4;
    const std::uint64_t length = bytes_.size() - chunk.length_at - width;
    for (std::size_t i = 0; i < width; ++i)
        bytes_[chunk.length_at + i] = static_cast<char>(length >> (8 * i) & 0xFF);
    resume();
}

} // namespace bot2nurbs
