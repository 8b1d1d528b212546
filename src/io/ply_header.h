// SPDX-License-Identifier: MIT
#pragma once

#include "io/mesh_file.h"

#include <string>
#include <vector>

namespace bot2nurbs {

enum class PlyFormat { text, little_endian, big_endian };
enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

//! Bytes of a value of the type in a binary file.
std::size_t ply_size(PlyType type);

struct PlyProperty {
    std::string name;
    bool is_list = false;
    PlyType count = PlyType::uint8; //!< Type of the length, of lists.
    PlyType type = PlyType::float32;
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;

    //! Least number of bytes one of these takes in the file.
    std::size_t least_bytes(PlyFormat format) const;
    //! Index in `properties` of the first of these names, or properties.size().
    std::size_t find(std::initializer_list<const char*> names) const;
};

struct PlyHeader {
    PlyFormat format = PlyFormat::text;
    std::vector<PlyElement> elements;
    std::size_t bytes = 0; //!< Length of the header: where the elements start.
    std::size_t lines = 0;
};

//! Errors: cannot_read, naming the line.
Result<PlyHeader> read_ply_header(const MeshFile& file);

} // namespace bot2nurbs
