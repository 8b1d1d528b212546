// SPDX-License-Identifier: MIT
#include "io/mesh_file.h"

#include <charconv>

namespace bot2nurbs {

namespace {

constexpr std::size_t longest_quote = 40;

} // namespace

Error error_at_line(const MeshFile& file, std::size_t line, const std::string& what, Index element)
{
    return {ErrorCode::cannot_read, file.name + ", line " + std::to_string(line) + ": " + what,
            element};
}

Error error_at_byte(const MeshFile& file, std::size_t byte, const std::string& what, Index element)
{
    return {ErrorCode::cannot_read, file.name + ", byte " + std::to_string(byte) + ": " + what,
            element};
}

std::string quoted(std::string_view word)
{
    std::string text = "\"";
    for (const char c : word.substr(0, longest_quote))
        text += c >= ' ' && c <= '~' ? c : '?';
    return text + (word.size() > longest_quote ? "...\"" : "\"");
}

std::string expected_number(std::string_view found)
{
    return found.empty() ? "a number is missing"
                         : "expected a number in range, found " + quoted(found);
}

std::string number_text(double value)
{
    char text[40];
    const auto [end, error] = std::to_chars(text, text + sizeof text, value);
    return error == std::errc() ? std::string(text, end) : "?";
}

Result<TriangleSoup> finish_soup(const MeshFile& file, std::vector<Vec3> positions,
                                 const PolygonList& polygons, Context& context)
{
    for (std::size_t v = 0; v < positions.size(); ++v)
        if (!is_finite(positions[v]))
            return Error{ErrorCode::bad_geometry,
                         file.name + ": vertex " + std::to_string(v) +
                             " (counted from 0) has a coordinate that is not finite",
                         static_cast<Index>(v)};
    if (polygons.size() == 0)
        return Error{ErrorCode::empty_input,
                     file.name + ": no faces (" + std::to_string(positions.size()) + " vertices)",
                     invalid_index};
    // Triangle numbers and halfedges (three a triangle) must fit an Index.
    if (polygons.corners.size() >= invalid_index / 3 || positions.size() >= invalid_index)
        return Error{ErrorCode::cannot_read, file.name + ": too many elements for 32-bit indices",
                     invalid_index};
    TriangleSoup soup;
    soup.positions = std::move(positions);
    if (polygons.corners.size() > 2 * polygons.size())
        soup.triangles.reserve(polygons.corners.size() - 2 * polygons.size());
    soup.source_face.reserve(soup.triangles.capacity());
    PolygonTriangulator triangulator(soup.positions, polygons);
    std::size_t small = 0;
    for (std::size_t p = 0; p < polygons.size(); ++p) {
        if (p % elements_per_poll == 0 && context.cancelled())
            return Context::cancelled_error("read");
        const std::size_t count = polygons.first[p + 1] - polygons.first[p];
        small += count < 3;
        triangulator.triangulate(p, soup.triangles);
        soup.source_face.resize(soup.triangles.size(), static_cast<Index>(p));
    }
    if (small > 0)
        context.log(LogLevel::warning, file.name + ": left out " + std::to_string(small) +
                                           " faces with fewer than three corners");
    if (soup.triangles.empty())
        return Error{ErrorCode::empty_input, file.name + ": no face has three corners",
                     invalid_index};
    return soup;
}

} // namespace bot2nurbs
