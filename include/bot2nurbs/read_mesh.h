// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "bot2nurbs/manifold_mesh.h"
#include "bot2nurbs/polygon_mesh.h"

#include <string>

namespace bot2nurbs {

//! Reads a triangle or polygon mesh: STL, OBJ, PLY or OFF, text or binary.
//!
//! The extension says the format and the content must agree with it; a file with an extension we do
//! not know is judged by its content. Numbers are read with the nearest double and a decimal point
//! in every locale. Polygons become triangles in their plane; `source_face` keeps the face of the
//! file. Vertices of STL files, which have no indices, are merged where they agree to the bit.
//!
//! Errors: cannot_read (missing, truncated, another format, an index out of range; the message
//! names the file and the line or byte), empty_input (no faces), bad_geometry (a coordinate that is
//! not finite), cancelled. Memory stays proportional to the size of the file, whatever its counts
//! say.
Result<TriangleSoup> read_mesh(const std::string& path, Context& context);

//! The same file with its polygons as they are: what read_mesh cuts into triangles. Errors: the
//! same.
Result<PolygonMesh> read_polygons(const std::string& path, Context& context);

} // namespace bot2nurbs
