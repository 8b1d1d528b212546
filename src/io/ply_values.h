// SPDX-License-Identifier: MIT
#pragma once

#include "io/ply_header.h"
#include "io/text_scanner.h"

#include <cmath>
#include <cstring>

namespace bot2nurbs {

//! Values of a text body, one after the other.
class PlyTextValues {
public:
    PlyTextValues(const MeshFile& file, const PlyHeader& header)
        : file_(file), text_(file.bytes.substr(header.bytes), 0), header_lines_(header.lines)
    {
    }
    bool read(PlyType type, double& value)
    {
        (void)type;
        return text_.number(value);
    }
    //! Steps over one value.
    bool skip(PlyType) { return !text_.word().empty(); }
    bool skip(PlyType type, std::uint64_t count)
    {
        for (std::uint64_t i = 0; i < count; ++i)
            if (!skip(type))
                return false;
        return true;
    }
    std::size_t bytes_left() const { return text_.bytes_left(); }
    Error error(const std::string& what, Index element) const
    {
        return error_at_line(file_, header_lines_ + text_.line(), what, element);
    }
    std::string failure() const { return expected_number(text_.bad_word()); }

private:
    const MeshFile& file_;
    TextScanner text_;
    std::size_t header_lines_;
};

//! Values of a binary body.
template <bool big_endian> class PlyBinaryValues {
public:
    PlyBinaryValues(const MeshFile& file, const PlyHeader& header)
        : file_(file), p_(file.bytes.data() + header.bytes),
          end_(file.bytes.data() + file.bytes.size())
    {
    }
    bool read(PlyType type, double& value)
    {
        if (ply_size(type) > bytes_left())
            return false;
        switch (type) {
        case PlyType::int8: value = static_cast<std::int8_t>(bits<std::uint8_t>()); break;
        case PlyType::uint8: value = bits<std::uint8_t>(); break;
        case PlyType::int16: value = static_cast<std::int16_t>(bits<std::uint16_t>()); break;
        case PlyType::uint16: value = bits<std::uint16_t>(); break;
        case PlyType::int32: value = static_cast<std::int32_t>(bits<std::uint32_t>()); break;
        case PlyType::uint32: value = bits<std::uint32_t>(); break;
        case PlyType::float32: value = cast<float>(bits<std::uint32_t>()); break;
        case PlyType::float64: value = cast<double>(bits<std::uint64_t>()); break;
        }
        return true;
    }
    bool skip(PlyType type, std::uint64_t count = 1)
    {
        if (count > bytes_left() / ply_size(type))
            return false;
        p_ += count * ply_size(type);
        return true;
    }
    std::size_t bytes_left() const { return static_cast<std::size_t>(end_ - p_); }
    Error error(const std::string& what, Index element) const
    {
        return error_at_byte(file_, static_cast<std::size_t>(p_ - file_.bytes.data()), what,
                             element);
    }
    std::string failure() const { return "the file ends here"; }

private:
    template <class U> U bits()
    {
        U value = 0;
        for (std::size_t i = 0; i < sizeof(U); ++i)
            value = static_cast<U>(value |
                                   static_cast<U>(static_cast<U>(static_cast<unsigned char>(p_[i]))
                                                  << (8 * (big_endian ? sizeof(U) - 1 - i : i))));
        p_ += sizeof(U);
        return value;
    }
    template <class T, class U> static T cast(U from)
    {
        T value;
        std::memcpy(&value, &from, sizeof value);
        return value;
    }

    const MeshFile& file_;
    const char* p_;
    const char* end_;
};

//! Reads the length of a list. `fail(what)` makes the error.
template <class Values, class Fail> Status read_ply_count(Values& values,
                                                          const PlyProperty& property,
                                                          std::uint64_t& entries, const Fail& fail)
{
    double count = 0.0;
    if (!values.read(property.count, count))
        return fail(values.failure());
    if (!(count >= 0.0) || count != std::floor(count))
        return fail("a list cannot have " + number_text(count) + " entries");
    if (count > static_cast<double>(values.bytes_left()))
        return fail("the file ends in a list of " + number_text(count));
    entries = static_cast<std::uint64_t>(count);
    return std::nullopt;
}

} // namespace bot2nurbs
