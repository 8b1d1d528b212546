// SPDX-License-Identifier: MIT
#pragma once

#include "io/mesh_file.h"
#include "io/text_scanner.h"

namespace bot2nurbs {

struct OffHeader {
    std::uint64_t vertices = 0, faces = 0;
    bool normals = false; //!< Three numbers behind the coordinates of a vertex (NOFF).
    bool colors = false;  //!< Then four (COFF).
};

//! Reads the keyword, which may be missing, and the counts. Errors: cannot_read, naming the line.
Result<OffHeader> read_off_header(const MeshFile& file, TextScanner& text);

} // namespace bot2nurbs
