// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "bot2nurbs/point_cloud.h"

#include <string>

namespace bot2nurbs {

//! Reads a point cloud.
//!
//! - PLY, OBJ and OFF: the vertices, with nx ny nz (PLY), vn lines in the order of the vertices
//!   (OBJ) or NOFF/COFF columns; faces are passed over.
//! - PCD (Point Cloud Library): ascii, binary and binary_compressed, organised or not. A viewpoint
//!   other than the origin is the scanner's position.
//! - LAS 1.0 to 1.4, point formats 0 to 10, with intensity and colour.
//! - Text of columns (.xyz .xyzn .xyzrgb .pts .pwn .txt .asc .csv): x y z, then what the first line
//!   names, or what the values can only be: a count of points may come first; a column between
//!   coordinates and colours is the intensity; three columns of unit (or only zero) vectors are
//!   normals; three of whole numbers from 0 to 255 are colours. Other columns are passed over with
//!   a note in the log. Words are separated by blanks, commas or semicolons.
//!
//! The extension says the format; a file with another extension is judged by its content. Numbers
//! are read as by read_mesh. Points that are not finite are kept: clean_points() removes them.
//!
//! Errors: cannot_read (missing, truncated, another format, compressed LAS, E57; the message names
//! the file and the line or byte), empty_input (no points), cancelled. Memory stays proportional to
//! the size of the file, whatever its counts say.
Result<PointCloud> read_points(const std::string& path, Context& context);

//! What a file can be read as.
enum class FileContent {
    mesh,  //!< By read_mesh: it has faces, or its format always does.
    points //!< By read_points: its format is one of points, or it lists no faces.
};

//! Decides by the extension, and for PLY, OBJ and OFF by whether the file lists faces. A file that
//! no reader knows counts as a mesh: read_mesh then says what is wrong. Errors: cannot_read,
//! cancelled.
Result<FileContent> file_content(const std::string& path, Context& context);

} // namespace bot2nurbs
