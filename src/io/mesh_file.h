// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "bot2nurbs/manifold_mesh.h"
#include "bot2nurbs/polygon_mesh.h"

#include <string>
#include <string_view>

namespace bot2nurbs {

//! A file in memory, under the name that messages use.
struct MeshFile {
    std::string name;
    std::string_view bytes;
};

// One reader a format; read_polygons chooses. Errors as there.
Result<PolygonMesh> read_stl(const MeshFile& file, Context& context);
Result<PolygonMesh> read_obj(const MeshFile& file, Context& context);
Result<PolygonMesh> read_ply(const MeshFile& file, Context& context);
Result<PolygonMesh> read_off(const MeshFile& file, Context& context);

//! Readers ask for cancellation once in so many elements.
inline constexpr std::size_t elements_per_poll = 65536;

//! cannot_read at a line of a text file.
Error error_at_line(const MeshFile& file, std::size_t line, const std::string& what,
                    Index element = invalid_index);
//! cannot_read at a byte of a binary file.
Error error_at_byte(const MeshFile& file, std::size_t byte, const std::string& what,
                    Index element = invalid_index);
//! A word of the file for a message: quoted, without unprintable bytes, cut when long.
std::string quoted(std::string_view word);
//! Says that a number was expected where `found` stands (empty: nothing stands there).
std::string expected_number(std::string_view found);

//! Checks what all formats share: there are faces, coordinates are finite, and numbers fit an
//! Index. Corners must be in range.
Status check_polygons(const MeshFile& file, const PolygonMesh& mesh);

} // namespace bot2nurbs
