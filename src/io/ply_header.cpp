// SPDX-License-Identifier: MIT
#include "io/ply_header.h"

#include "io/text_scanner.h"

#include <optional>

namespace bot2nurbs {

namespace {

std::optional<PlyType> type_of(std::string_view name)
{
    static const struct {
        const char* name;
        PlyType type;
    } names[] = {
        {"char", PlyType::int8},      {"int8", PlyType::int8},       {"uchar", PlyType::uint8},
        {"uint8", PlyType::uint8},    {"short", PlyType::int16},     {"int16", PlyType::int16},
        {"ushort", PlyType::uint16},  {"uint16", PlyType::uint16},   {"int", PlyType::int32},
        {"int32", PlyType::int32},    {"uint", PlyType::uint32},     {"uint32", PlyType::uint32},
        {"float", PlyType::float32},  {"float32", PlyType::float32}, {"double", PlyType::float64},
        {"float64", PlyType::float64}};
    for (const auto& n : names)
        if (name == n.name)
            return n.type;
    return std::nullopt;
}

} // namespace

std::size_t ply_size(PlyType type)
{
    static const std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
    return sizes[static_cast<int>(type)];
}

std::size_t PlyElement::least_bytes(PlyFormat format) const
{
    std::size_t bytes = 0;
    for (const PlyProperty& p : properties)
        // A digit and a separator in text; an empty list is its length alone.
        bytes += format == PlyFormat::text ? 2 : ply_size(p.is_list ? p.count : p.type);
    return bytes;
}

std::size_t PlyElement::find(std::initializer_list<const char*> names) const
{
    for (std::size_t i = 0; i < properties.size(); ++i)
        for (const char* wanted : names)
            if (properties[i].name == wanted)
                return i;
    return properties.size();
}

Result<PlyHeader> read_ply_header(const MeshFile& file)
{
    TextScanner text(file.bytes, 0);
    const auto fail = [&](const std::string& what) {
        return error_at_line(file, text.line(), "PLY header: " + what);
    };
    if (text.word() != "ply")
        return fail("the file does not start with \"ply\"");
    PlyHeader header;
    bool has_format = false;
    while (!text.at_end()) {
        const std::string_view keyword = text.word_in_line();
        if (keyword == "comment" || keyword == "obj_info") {
            // free text
        } else if (keyword == "format") {
            const std::string_view format = text.word_in_line();
            if (format == "ascii")
                header.format = PlyFormat::text;
            else if (format == "binary_little_endian")
                header.format = PlyFormat::little_endian;
            else if (format == "binary_big_endian")
                header.format = PlyFormat::big_endian;
            else
                return fail("unknown format " + quoted(format));
            has_format = true;
        } else if (keyword == "element") {
            PlyElement element;
            element.name = text.word_in_line();
            if (element.name.empty() || !text.number_in_line(element.count))
                return fail("element " + quoted(element.name) + " has no valid count");
            header.elements.push_back(std::move(element));
        } else if (keyword == "property") {
            if (header.elements.empty())
                return fail("a property before the first element");
            PlyProperty property;
            std::string_view type = text.word_in_line();
            if (type == "list") {
                property.is_list = true;
                const std::string_view count = text.word_in_line();
                const std::optional<PlyType> known = type_of(count);
                if (!known || *known >= PlyType::float32)
                    return fail("lists cannot be counted by " + quoted(count));
                property.count = *known;
                type = text.word_in_line();
            }
            const std::optional<PlyType> known = type_of(type);
            property.name = text.word_in_line();
            if (!known || property.name.empty())
                return fail("property " + quoted(property.name) + " of unknown type " +
                            quoted(type));
            property.type = *known;
            header.elements.back().properties.push_back(std::move(property));
        } else if (keyword == "end_header") {
            if (!has_format)
                return fail("no format");
            // Binary data start right behind this line's end, whatever their first bytes are.
            text.rest_of_line();
            std::size_t at = static_cast<std::size_t>(text.position() - file.bytes.data());
            if (at < file.bytes.size() && file.bytes[at] == '\r') {
                ++at;
                // Files with CR LF in the header; after a lone CR the byte is data.
                const bool crlf = file.bytes.find("\r\n") < at - 1;
                if (crlf && at < file.bytes.size() && file.bytes[at] == '\n')
                    ++at;
            } else if (at < file.bytes.size()) {
                ++at;
            }
            header.bytes = at;
            header.lines = text.line();
            return header;
        } else {
            return fail("unknown keyword " + quoted(keyword));
        }
        text.skip_line();
    }
    return fail("no \"end_header\"");
}

} // namespace bot2nurbs
