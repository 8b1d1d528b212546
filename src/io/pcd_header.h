// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/vec.h"
#include "io/mesh_file.h"

#include <optional>
#include <string>
#include <vector>

namespace bot2nurbs {

enum class PcdData { text, binary, compressed };

struct PcdField {
    std::string name;
    std::size_t size = 4;   //!< Bytes of a value: 1, 2, 4 or 8.
    char type = 'F';        //!< 'F' real (4 or 8 bytes), 'I' signed, 'U' unsigned.
    std::size_t count = 1;  //!< Values a point.
    std::size_t offset = 0; //!< Of the field in the record of a point, in bytes.
};

struct PcdHeader {
    std::vector<PcdField> fields;
    std::uint64_t points = 0;
    std::optional<Vec3> viewpoint; //!< Absent when it is the origin, which files say by default.
    PcdData data = PcdData::text;
    std::size_t record = 0; //!< Bytes of a point.
    std::size_t bytes = 0;  //!< Length of the header: where the data start.
    std::size_t lines = 0;
};

//! Errors: cannot_read, naming the line.
Result<PcdHeader> read_pcd_header(const MeshFile& file);

} // namespace bot2nurbs
