// SPDX-License-Identifier: MIT
#include "io/mesh_file.h"

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

Status check_polygons(const MeshFile& file, const PolygonMesh& mesh)
{
    const auto& [positions, polygons] = mesh;
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
    return {};
}

} // namespace bot2nurbs
