// SPDX-License-Identifier: MIT
#include "io/ply_header.h"
#include "io/text_scanner.h"

#include <cstring>

namespace bot2nurbs {

namespace {

//! Values of a text body, one after the other.
class TextValues {
public:
    TextValues(const MeshFile& file, const PlyHeader& header)
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
template <bool big_endian> class BinaryValues {
public:
    BinaryValues(const MeshFile& file, const PlyHeader& header)
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

//! Reads the elements of one file; Values says how numbers are stored.
template <class Values> class PlyReader {
public:
    PlyReader(const MeshFile& file, const PlyHeader& header, Context& context)
        : file_(file), header_(header), values_(file, header), context_(context)
    {
    }

    Result<PolygonMesh> read()
    {
        for (const PlyElement& element : header_.elements)
            if (element.name == "vertex")
                vertices_ += element.count;
        for (const PlyElement& element : header_.elements) {
            const std::size_t least = element.least_bytes(header_.format);
            // The last number of a text file needs no separator behind it.
            if (least > 0 && element.count > (values_.bytes_left() + 1) / least)
                return values_.error("the file is too short for the " +
                                         std::to_string(element.count) + " elements " +
                                         quoted(element.name) + " it promises",
                                     invalid_index);
            if (Status bad = read_element(element, least))
                return *bad;
        }
        return PolygonMesh{std::move(positions_), std::move(polygons_)};
    }

private:
    Status read_element(const PlyElement& element, std::size_t least)
    {
        const bool is_vertex = element.name == "vertex";
        const bool is_strip = element.name == "tristrips";
        const bool is_face = element.name == "face" || is_strip;
        const std::size_t none = element.properties.size();
        std::array<std::size_t, 3> axis{none, none, none};
        std::size_t list = none;
        if (is_vertex) {
            axis = {element.find({"x"}), element.find({"y"}), element.find({"z"})};
            for (const std::size_t a : axis)
                if (a == none || element.properties[a].is_list)
                    return values_.error("vertices have no x, y and z", invalid_index);
            positions_.reserve(element.count);
        }
        if (is_face) {
            list = element.find({"vertex_indices", "vertex_index"});
            if (element.count > 0 && (list == none || !element.properties[list].is_list))
                return values_.error(quoted(element.name) + " has no list of vertex_indices",
                                     invalid_index);
            if (!is_strip) {
                polygons_.first.reserve(polygons_.first.size() + element.count);
                polygons_.corners.reserve(polygons_.corners.size() + 3 * element.count);
            }
        }
        if (least == 0)
            return std::nullopt; // an element without properties has no bytes
        for (std::uint64_t e = 0; e < element.count; ++e) {
            if (e % elements_per_poll == 0 && context_.cancelled())
                return Context::cancelled_error("read");
            const Index number = static_cast<Index>(e);
            const auto fail = [&](const std::string& what) {
                return values_.error(element.name + " " + std::to_string(e) + " of " +
                                         std::to_string(element.count) + ": " + what,
                                     number);
            };
            Vec3 p;
            for (std::size_t i = 0; i < none; ++i) {
                const PlyProperty& property = element.properties[i];
                if (property.is_list) {
                    double count = 0.0;
                    if (!values_.read(property.count, count))
                        return fail(values_.failure());
                    if (!(count >= 0.0) || count != std::floor(count))
                        return fail("a list cannot have " + number_text(count) + " entries");
                    if (count > static_cast<double>(values_.bytes_left()))
                        return fail("the file ends in a list of " + number_text(count));
                    const auto entries = static_cast<std::uint64_t>(count);
                    if (i != list) {
                        if (!values_.skip(property.type, entries))
                            return fail(values_.failure());
                    } else if (Status bad = is_strip ? read_strip(property, entries, fail)
                                                     : read_face(property, entries, fail)) {
                        return bad;
                    }
                } else if (i == axis[0] || i == axis[1] || i == axis[2]) {
                    double& x = i == axis[0] ? p.x : (i == axis[1] ? p.y : p.z);
                    if (!values_.read(property.type, x))
                        return fail(values_.failure());
                } else if (!values_.skip(property.type)) {
                    return fail(values_.failure());
                }
            }
            if (is_vertex)
                positions_.push_back(p);
        }
        return std::nullopt;
    }

    //! A list entry as the index of a vertex. -1 is allowed in strips and gives invalid_index.
    template <class Fail>
    Status read_index(PlyType type, bool allow_restart, Index& index, const Fail& fail)
    {
        double value = 0.0;
        if (!values_.read(type, value))
            return fail(values_.failure());
        if (allow_restart && value == -1.0) {
            index = invalid_index;
            return std::nullopt;
        }
        if (!(value >= 0.0) || value >= static_cast<double>(vertices_) ||
            value != std::floor(value))
            return fail("vertex " + number_text(value) + " is out of range (the file has " +
                        std::to_string(vertices_) + ")");
        index = static_cast<Index>(value);
        return std::nullopt;
    }

    template <class Fail>
    Status read_face(const PlyProperty& property, std::uint64_t entries, const Fail& fail)
    {
        for (std::uint64_t k = 0; k < entries; ++k) {
            Index v = invalid_index;
            if (Status bad = read_index(property.type, false, v, fail))
                return bad;
            polygons_.corners.push_back(v);
        }
        polygons_.close();
        return std::nullopt;
    }

    //! Triangle strips: every entry after the second closes a triangle, turning alternately; -1
    //! starts anew. Triangles that repeat a vertex only steer the strip and are dropped.
    template <class Fail>
    Status read_strip(const PlyProperty& property, std::uint64_t entries, const Fail& fail)
    {
        Index a = invalid_index, b = invalid_index;
        bool odd = false;
        for (std::uint64_t k = 0; k < entries; ++k) {
            if (k % elements_per_poll == 0 && context_.cancelled())
                return Context::cancelled_error("read");
            Index c = invalid_index;
            if (Status bad = read_index(property.type, true, c, fail))
                return bad;
            if (c == invalid_index) {
                a = b = invalid_index;
                odd = false;
                continue;
            }
            if (a != invalid_index) {
                if (a != b && b != c && c != a) {
                    const std::array<Index, 3> corners{odd ? b : a, odd ? a : b, c};
                    polygons_.corners.insert(polygons_.corners.end(), corners.begin(),
                                             corners.end());
                    polygons_.close();
                }
                odd = !odd;
            }
            a = b;
            b = c;
        }
        return std::nullopt;
    }

    static std::string number_text(double value)
    {
        char text[40];
        const auto [end, error] = std::to_chars(text, text + sizeof text, value);
        return error == std::errc() ? std::string(text, end) : "?";
    }

    const MeshFile& file_;
    const PlyHeader& header_;
    Values values_;
    Context& context_;
    std::uint64_t vertices_ = 0;
    std::vector<Vec3> positions_;
    PolygonList polygons_;
};

} // namespace

Result<PolygonMesh> read_ply(const MeshFile& file, Context& context)
{
    const Result<PlyHeader> header = read_ply_header(file);
    if (!header)
        return header.error();
    switch (header->format) {
    case PlyFormat::text: return PlyReader<TextValues>(file, *header, context).read();
    case PlyFormat::little_endian:
        return PlyReader<BinaryValues<false>>(file, *header, context).read();
    case PlyFormat::big_endian: return PlyReader<BinaryValues<true>>(file, *header, context).read();
    }
    return Error{ErrorCode::internal, "unknown PLY format", invalid_index};
}

} // namespace bot2nurbs
