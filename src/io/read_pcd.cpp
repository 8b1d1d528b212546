// SPDX-License-Identifier: MIT
#include "io/little_endian.h"
#include "io/lzf.h"
#include "io/pcd_header.h"
#include "io/point_table.h"
#include "io/text_scanner.h"

namespace bot2nurbs {

namespace {

//! LZF makes at most 264 bytes of 3, so that no block unpacks to more than this many times its
//! size.
constexpr std::uint64_t most_expansion = 88;

double stored_value(const PcdField& field, const char* p)
{
    switch (field.size) {
    case 1: {
        const auto bits = little_endian<std::uint8_t>(p);
        return field.type == 'I' ? static_cast<std::int8_t>(bits) : bits;
    }
    case 2: {
        const auto bits = little_endian<std::uint16_t>(p);
        return field.type == 'I' ? static_cast<std::int16_t>(bits) : bits;
    }
    case 4: {
        const auto bits = little_endian<std::uint32_t>(p);
        return field.type == 'F'   ? bit_cast<float>(bits)
               : field.type == 'I' ? static_cast<std::int32_t>(bits)
                                   : bits;
    }
    default: {
        const auto bits = little_endian<std::uint64_t>(p);
        return field.type == 'F'   ? bit_cast<double>(bits)
               : field.type == 'I' ? static_cast<double>(static_cast<std::int64_t>(bits))
                                   : static_cast<double>(bits);
    }
    }
}

//! Colours are packed in four bytes, blue first, which a field of type F calls a float.
bool is_packed_color(const PcdField& field)
{
    return (field.name == "rgb" || field.name == "rgba") && field.size == 4 && field.count == 1;
}

class PcdReader {
public:
    PcdReader(const MeshFile& file, const PcdHeader& header, Context& context)
        : file_(file), header_(header), context_(context)
    {
    }

    Result<PointCloud> read()
    {
        if (Status bad = choose_columns())
            return *bad;
        Status bad;
        switch (header_.data) {
        case PcdData::text: bad = read_text(); break;
        case PcdData::binary: bad = read_binary(); break;
        case PcdData::compressed: bad = read_compressed(); break;
        }
        if (bad)
            return *bad;
        return table_to_cloud(file_, std::move(table_));
    }

private:
    Status choose_columns()
    {
        std::array<bool, point_fields> used{};
        columns_.assign(header_.fields.size(), nullptr);
        bool colored = false;
        for (std::size_t i = 0; i < columns_.size(); ++i) {
            const PcdField& f = header_.fields[i];
            if (is_packed_color(f)) {
                colored = true;
                continue;
            }
            const std::optional<PointField> field = point_field(f.name);
            if (!field || f.count != 1 || used[static_cast<std::size_t>(*field)])
                continue;
            used[static_cast<std::size_t>(*field)] = true;
            columns_[i] = &table_[*field];
        }
        for (const PointField f : {PointField::x, PointField::y, PointField::z})
            if (!used[static_cast<std::size_t>(f)])
                return error_at_line(file_, header_.lines, "PCD header: no fields x, y and z");
        packed_color_ = colored && !used[static_cast<std::size_t>(PointField::red)];
        table_.viewpoint = header_.viewpoint;
        return std::nullopt;
    }

    //! The packed colour of a point; further packed fields of a record are passed over.
    void add_color(std::uint32_t bits)
    {
        table_[PointField::red].push_back(bits >> 16 & 255);
        table_[PointField::green].push_back(bits >> 8 & 255);
        table_[PointField::blue].push_back(bits & 255);
    }

    Status read_text()
    {
        TextScanner text(file_.bytes.substr(header_.bytes), 0);
        for (std::uint64_t i = 0; i < header_.points; ++i) {
            if (i % elements_per_poll == 0 && context_.cancelled())
                return Context::cancelled_error("read");
            const auto fail = [&](const std::string& what) {
                return error_at_line(file_, header_.lines + text.line(),
                                     "point " + std::to_string(i) + " of " +
                                         std::to_string(header_.points) + ": " + what,
                                     static_cast<Index>(i));
            };
            if (text.at_end())
                return fail("the file ends here");
            bool colored = false;
            for (std::size_t c = 0; c < columns_.size(); ++c) {
                const PcdField& field = header_.fields[c];
                for (std::size_t k = 0; k < field.count; ++k) {
                    double value = 0.0;
                    if (!text.number_in_line(value))
                        return fail(expected_number(text.bad_word()));
                    if (columns_[c] != nullptr)
                        columns_[c]->push_back(value);
                    if (packed_color_ && !colored && is_packed_color(field)) {
                        add_color(text_color(field, value));
                        colored = true;
                    }
                }
            }
            text.skip_line();
        }
        return std::nullopt;
    }

    //! Text has the packed bytes as a number, or as the float that has these bits.
    static std::uint32_t text_color(const PcdField& field, double value)
    {
        if (field.type == 'F')
            return bit_cast<std::uint32_t>(static_cast<float>(value));
        return value >= 0.0 && value <= 4294967295.0 ? static_cast<std::uint32_t>(value) : 0u;
    }

    Error too_short() const
    {
        return error_at_byte(file_, file_.bytes.size(),
                             "the file is too short for the " + std::to_string(header_.points) +
                                 " points it promises");
    }

    Status read_binary()
    {
        const std::string_view data = file_.bytes.substr(header_.bytes);
        if (header_.points > data.size() / header_.record)
            return too_short();
        return read_records([&](const PcdField& field, std::uint64_t i) {
            return data.data() + i * header_.record + field.offset;
        });
    }

    //! Compressed data have the values of all points field by field.
    Status read_compressed()
    {
        const std::string_view data = file_.bytes.substr(header_.bytes);
        if (data.size() < 8)
            return too_short();
        const std::uint64_t packed = little_endian<std::uint32_t>(data.data());
        const std::uint64_t unpacked = little_endian<std::uint32_t>(data.data() + 4);
        if (packed > data.size() - 8 || unpacked > most_expansion * packed)
            return too_short();
        if (header_.points > unpacked / header_.record)
            return too_short();
        std::string bytes(unpacked, '\0');
        if (!unpack_lzf(data.substr(8, packed), bytes))
            return error_at_byte(file_, header_.bytes + 8, "the compressed data are broken");
        return read_records([&](const PcdField& field, std::uint64_t i) {
            return bytes.data() + field.offset * header_.points + i * field.size * field.count;
        });
    }

    //! `at(field, point)`: where the first value of a field is.
    template <class At> Status read_records(const At& at)
    {
        for (auto* column : columns_)
            if (column != nullptr)
                column->reserve(header_.points);
        for (std::uint64_t i = 0; i < header_.points; ++i) {
            if (i % elements_per_poll == 0 && context_.cancelled())
                return Context::cancelled_error("read");
            bool colored = false;
            for (std::size_t c = 0; c < columns_.size(); ++c) {
                const PcdField& field = header_.fields[c];
                if (columns_[c] != nullptr)
                    columns_[c]->push_back(stored_value(field, at(field, i)));
                if (packed_color_ && !colored && is_packed_color(field)) {
                    add_color(little_endian<std::uint32_t>(at(field, i)));
                    colored = true;
                }
            }
        }
        return std::nullopt;
    }

    const MeshFile& file_;
    const PcdHeader& header_;
    Context& context_;
    PointTable table_;
    std::vector<std::vector<double>*> columns_;
    bool packed_color_ = false;
};

} // namespace

Result<PointCloud> read_pcd(const MeshFile& file, Context& context)
{
    const Result<PcdHeader> header = read_pcd_header(file);
    if (!header)
        return header.error();
    return PcdReader(file, *header, context).read();
}

} // namespace bot2nurbs
