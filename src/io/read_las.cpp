// SPDX-License-Identifier: MIT
#include "io/little_endian.h"
#include "io/point_table.h"

namespace bot2nurbs {

namespace {

// Places in the public header block, and its least size, as the LAS specification numbers them.
constexpr std::size_t header_bytes = 227, header_bytes_1_4 = 375;
constexpr std::size_t at_minor_version = 25, at_data_offset = 96, at_format = 104,
                      at_record_length = 105, at_count = 107, at_scale = 131, at_offset = 155,
                      at_count_1_4 = 247;
constexpr std::size_t at_intensity = 12; //!< In a point record.
constexpr int most_format = 10;
//! A set bit of the format says that the points are compressed (LAZ).
constexpr int compressed_bit = 128;

//! Least record of each point format, and where its colours start (0: it has none).
struct PointFormat {
    std::size_t bytes, color;
};
constexpr PointFormat formats[most_format + 1] = {{20, 0},  {28, 0},  {26, 20}, {34, 28},
                                                  {57, 0},  {63, 28}, {30, 0},  {36, 30},
                                                  {38, 30}, {59, 0},  {67, 30}};

double real_at(const char* p)
{
    return bit_cast<double>(little_endian<std::uint64_t>(p));
}

Vec3 reals_at(const char* p)
{
    return {real_at(p), real_at(p + 8), real_at(p + 16)};
}

} // namespace

Result<PointCloud> read_las(const MeshFile& file, Context& context)
{
    const std::string_view bytes = file.bytes;
    const char* p = bytes.data();
    if (bytes.substr(0, 4) != "LASF")
        return error_at_byte(file, 0, "not a LAS file: it does not start with \"LASF\"");
    if (bytes.size() < header_bytes)
        return error_at_byte(file, bytes.size(), "the file ends in its header");
    const int stored_format = static_cast<unsigned char>(p[at_format]);
    if (stored_format >= compressed_bit)
        return error_at_byte(file, at_format,
                             "the points are compressed (LAZ), which is not read; unpack the file "
                             "to LAS first");
    if (stored_format > most_format)
        return error_at_byte(file, at_format,
                             "unknown point format " + std::to_string(stored_format));
    const PointFormat format = formats[stored_format];
    const std::size_t record = little_endian<std::uint16_t>(p + at_record_length);
    if (record < format.bytes)
        return error_at_byte(file, at_record_length,
                             "a record of " + std::to_string(record) +
                                 " bytes is too short for point format " +
                                 std::to_string(stored_format));
    std::uint64_t count = little_endian<std::uint32_t>(p + at_count);
    if (p[at_minor_version] >= 4 && bytes.size() >= header_bytes_1_4)
        count = little_endian<std::uint64_t>(p + at_count_1_4);
    const std::size_t start = little_endian<std::uint32_t>(p + at_data_offset);
    if (start > bytes.size() || count > (bytes.size() - start) / record)
        return error_at_byte(file, bytes.size(),
                             "the file is too short for the " + std::to_string(count) +
                                 " points it promises");
    const Vec3 scale = reals_at(p + at_scale), offset = reals_at(p + at_offset);
    if (!is_finite(scale) || !is_finite(offset))
        return error_at_byte(file, at_scale, "the scale of the coordinates is no number");

    PointTable table;
    table.full_color = 65535.0;
    const auto short_at = [](const char* q) { return double(little_endian<std::uint16_t>(q)); };
    for (std::uint64_t i = 0; i < count; ++i) {
        if (i % elements_per_poll == 0 && context.cancelled())
            return Context::cancelled_error("read");
        const char* q = p + start + i * record;
        const auto coordinate = [q](int k) {
            return double(static_cast<std::int32_t>(little_endian<std::uint32_t>(q + 4 * k)));
        };
        table[PointField::x].push_back(scale.x * coordinate(0) + offset.x);
        table[PointField::y].push_back(scale.y * coordinate(1) + offset.y);
        table[PointField::z].push_back(scale.z * coordinate(2) + offset.z);
        table[PointField::intensity].push_back(short_at(q + at_intensity));
        if (format.color > 0) {
            table[PointField::red].push_back(short_at(q + format.color));
            table[PointField::green].push_back(short_at(q + format.color + 2));
            table[PointField::blue].push_back(short_at(q + format.color + 4));
        }
    }
    return table_to_cloud(file, std::move(table));
}

} // namespace bot2nurbs
