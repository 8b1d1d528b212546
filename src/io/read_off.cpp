// SPDX-License-Identifier: MIT
#include "io/mesh_file.h"
#include "io/text_scanner.h"

namespace bot2nurbs {

namespace {

// Least number of bytes of a vertex ("0 0 0\n") and of a face ("0\n"): bounds what counts can be
// true in a file of a given size.
constexpr std::size_t least_vertex_bytes = 6;
constexpr std::size_t least_face_bytes = 2;

//! True for the OFF keywords with three coordinates: OFF with prefixes ST, C, N in that order.
bool is_off_keyword(std::string_view word)
{
    for (const std::string_view prefix : {"ST", "C", "N"})
        if (word.substr(0, prefix.size()) == prefix)
            word.remove_prefix(prefix.size());
    return word == "OFF";
}

} // namespace

Result<PolygonMesh> read_off(const MeshFile& file, Context& context)
{
    TextScanner text(file.bytes, '#');
    if (text.at_end())
        return Error{ErrorCode::cannot_read, file.name + ": the file is empty", invalid_index};
    const char first = *text.position();
    // The keyword may be missing: then the file starts with its counts.
    if (first < '0' || first > '9') {
        const std::string_view keyword = text.word();
        if (!is_off_keyword(keyword))
            return error_at_line(file, text.line(),
                                 "not an OFF file of three-dimensional points: starts with " +
                                     quoted(keyword));
        if (!text.at_line_end() && (*text.position() == 'B' || *text.position() == 'b'))
            return error_at_line(file, text.line(),
                                 "binary OFF is not supported; save it as text OFF or as PLY");
    }
    std::uint64_t vertices = 0, faces = 0, edges = 0;
    if (!text.number(vertices) || !text.number(faces))
        return error_at_line(file, text.line(), "counts: " + expected_number(text.bad_word()));
    if (!text.at_line_end() && !text.number_in_line(edges))
        return error_at_line(file, text.line(), "counts: " + expected_number(text.bad_word()));
    if (vertices > text.bytes_left() / least_vertex_bytes + 1 ||
        faces > text.bytes_left() / least_face_bytes + 1)
        return error_at_line(file, text.line(),
                             "the file is too short for the " + std::to_string(vertices) +
                                 " vertices and " + std::to_string(faces) + " faces it promises");

    std::vector<Vec3> positions(vertices);
    for (std::size_t v = 0; v < vertices; ++v) {
        if (v % elements_per_poll == 0 && context.cancelled())
            return Context::cancelled_error("read");
        Vec3& p = positions[v];
        if (!text.number(p.x) || !text.number_in_line(p.y) || !text.number_in_line(p.z))
            return error_at_line(file, text.line(),
                                 "vertex " + std::to_string(v) + " of " + std::to_string(vertices) +
                                     ": " + expected_number(text.bad_word()),
                                 static_cast<Index>(v));
        text.skip_line(); // normal, colour, texture coordinates
    }
    PolygonList polygons;
    polygons.first.reserve(faces + 1);
    polygons.corners.reserve(3 * faces);
    for (std::size_t f = 0; f < faces; ++f) {
        if (f % elements_per_poll == 0 && context.cancelled())
            return Context::cancelled_error("read");
        const auto fail = [&](const std::string& what) {
            return error_at_line(file, text.line(),
                                 "face " + std::to_string(f) + " of " + std::to_string(faces) +
                                     ": " + what,
                                 static_cast<Index>(f));
        };
        std::uint64_t corners = 0;
        if (!text.number(corners))
            return fail(expected_number(text.bad_word()));
        for (std::uint64_t k = 0; k < corners; ++k) {
            std::int64_t v = 0;
            if (!text.number_in_line(v))
                return fail("corner " + std::to_string(k) + " of " + std::to_string(corners) +
                            ": " + expected_number(text.bad_word()));
            if (v < 0 || static_cast<std::uint64_t>(v) >= vertices)
                return fail("vertex " + std::to_string(v) + " is out of range (the file has " +
                            std::to_string(vertices) + ")");
            polygons.corners.push_back(static_cast<Index>(v));
        }
        polygons.close();
        text.skip_line(); // colour
    }
    return PolygonMesh{std::move(positions), std::move(polygons)};
}

} // namespace bot2nurbs
