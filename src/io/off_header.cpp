// SPDX-License-Identifier: MIT
#include "io/off_header.h"

namespace bot2nurbs {

namespace {

// Least number of bytes of a vertex ("0 0 0\n") and of a face ("0\n"): bounds what counts can be
// true in a file of a given size.
constexpr std::size_t least_vertex_bytes = 6;
constexpr std::size_t least_face_bytes = 2;

//! Understands the OFF keywords with three coordinates: OFF with prefixes ST, C, N in that order.
bool read_keyword(std::string_view word, OffHeader& header)
{
    const auto prefix = [&word](std::string_view p) {
        const bool found = word.substr(0, p.size()) == p;
        if (found)
            word.remove_prefix(p.size());
        return found;
    };
    prefix("ST");
    header.colors = prefix("C");
    header.normals = prefix("N");
    return word == "OFF";
}

} // namespace

Result<OffHeader> read_off_header(const MeshFile& file, TextScanner& text)
{
    if (text.at_end())
        return Error{ErrorCode::cannot_read, file.name + ": the file is empty", invalid_index};
    OffHeader header;
    const char first = *text.position();
    // Without a keyword the file starts with its counts.
    if (first < '0' || first > '9') {
        const std::string_view keyword = text.word();
        if (!read_keyword(keyword, header))
            return error_at_line(file, text.line(),
                                 "not an OFF file of three-dimensional points: starts with " +
                                     quoted(keyword));
        if (!text.at_line_end() && (*text.position() == 'B' || *text.position() == 'b'))
            return error_at_line(file, text.line(),
                                 "binary OFF is not supported; save it as text OFF or as PLY");
    }
    std::uint64_t edges = 0;
    if (!text.number(header.vertices) || !text.number(header.faces))
        return error_at_line(file, text.line(), "counts: " + expected_number(text.bad_word()));
    if (!text.at_line_end() && !text.number_in_line(edges))
        return error_at_line(file, text.line(), "counts: " + expected_number(text.bad_word()));
    if (header.vertices > text.bytes_left() / least_vertex_bytes + 1 ||
        header.faces > text.bytes_left() / least_face_bytes + 1)
        return error_at_line(file, text.line(),
                             "the file is too short for the " + std::to_string(header.vertices) +
                                 " vertices and " + std::to_string(header.faces) +
                                 " faces it promises");
    return header;
}

} // namespace bot2nurbs
