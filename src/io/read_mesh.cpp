// SPDX-License-Identifier: MIT
#include "bot2nurbs/read_mesh.h"

#include "io/file_bytes.h"
#include "io/mesh_file.h"

#include <cstring>

namespace bot2nurbs {

namespace {

//! The format whose unmistakable mark the bytes carry; empty when there is none.
std::string marked_format(std::string_view bytes)
{
    const std::size_t start = bytes.find_first_not_of(" \t\r\n");
    const std::string_view head =
        start == std::string_view::npos ? std::string_view() : bytes.substr(start, 8);
    if (head.substr(0, 4) == "ply\n" || head.substr(0, 4) == "ply\r")
        return "ply";
    for (const char* keyword : {"OFF", "COFF", "NOFF", "CNOFF", "STOFF"}) {
        const std::size_t n = std::strlen(keyword);
        if (head.substr(0, n) == keyword &&
            (head.size() == n || head.find_first_of(" \t\r\n") == n))
            return "off";
    }
    if (head.substr(0, 6) == "solid ")
        return "stl";
    return {};
}

} // namespace

Result<TriangleSoup> read_mesh(const std::string& path, Context& context)
{
    const Result<std::string> bytes = read_bytes(path, context);
    if (!bytes)
        return bytes.error();
    const MeshFile file{path, *bytes};
    std::string format = extension(path);
    const std::string mark = marked_format(*bytes);
    const bool known = format == "stl" || format == "obj" || format == "ply" || format == "off";
    if (!known) {
        if (mark.empty())
            return Error{ErrorCode::cannot_read,
                         path + ": neither its extension nor its content says which format it is; "
                                "known are .stl, .obj, .ply and .off",
                         invalid_index};
        format = mark;
    } else if (!mark.empty() && mark != format) {
        return Error{ErrorCode::cannot_read,
                     path + ": the name says ." + format + ", but the content is " + mark +
                         "; rename the file",
                     invalid_index};
    }
    if (format == "stl")
        return read_stl(file, context);
    if (format == "obj")
        return read_obj(file, context);
    if (format == "ply")
        return read_ply(file, context);
    return read_off(file, context);
}

} // namespace bot2nurbs
