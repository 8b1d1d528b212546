// SPDX-License-Identifier: MIT
#include "bot2nurbs/read_mesh.h"

#include "io/mesh_file.h"
#include "mesh/triangulate_polygon.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <sys/stat.h>

namespace bot2nurbs {

namespace {

constexpr std::size_t read_block = std::size_t{1} << 22; // 4 MiB: some 1 ms between polls

Result<std::string> read_bytes(const std::string& path, Context& context)
{
    const auto fail = [&path](const std::string& why) {
        return Error{ErrorCode::cannot_read, "cannot read " + path + ": " + why, invalid_index};
    };
    struct stat info {};
    if (stat(path.c_str(), &info) != 0)
        return fail(std::strerror(errno));
    if (S_ISDIR(info.st_mode))
        return fail("it is a folder");
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                               std::fclose);
    if (!file)
        return fail(std::strerror(errno));
    std::string bytes;
    if (info.st_size > 0)
        bytes.reserve(static_cast<std::size_t>(info.st_size) + 1);
    for (;;) {
        if (context.cancelled())
            return Context::cancelled_error("read");
        const std::size_t old = bytes.size();
        // Asking for one byte more than the size shows the end in the same call.
        const std::size_t want =
            bytes.capacity() > old ? std::min(bytes.capacity() - old, read_block) : read_block;
        bytes.resize(old + want);
        const std::size_t got = std::fread(&bytes[old], 1, want, file.get());
        bytes.resize(old + got);
        if (got < want)
            break;
    }
    if (std::ferror(file.get()))
        return fail("input error");
    return bytes;
}

std::string extension(const std::string& path)
{
    const std::size_t slash = path.find_last_of('/');
    const std::size_t dot = path.find_last_of('.');
    if (dot == std::string::npos || (slash != std::string::npos && dot < slash))
        return {};
    std::string text = path.substr(dot + 1);
    for (char& c : text)
        if (c >= 'A' && c <= 'Z')
            c = static_cast<char>(c - 'A' + 'a');
    return text;
}

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

Result<PolygonMesh> read_format(const std::string& path, const std::string& bytes, Context& context)
{
    const MeshFile file{path, bytes};
    if (bytes.empty())
        return Error{ErrorCode::cannot_read, path + ": the file is empty", invalid_index};
    std::string format = extension(path);
    const std::string mark = marked_format(bytes);
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

} // namespace

Result<PolygonMesh> read_polygons(const std::string& path, Context& context)
{
    const Result<std::string> bytes = read_bytes(path, context);
    if (!bytes)
        return bytes.error();
    Result<PolygonMesh> mesh = read_format(path, *bytes, context);
    if (mesh)
        if (const Status bad = check_polygons({path, *bytes}, *mesh))
            return *bad;
    return mesh;
}

Result<TriangleSoup> read_mesh(const std::string& path, Context& context)
{
    Result<PolygonMesh> mesh = read_polygons(path, context);
    if (!mesh)
        return mesh.error();
    const PolygonList& polygons = mesh->polygons;
    TriangleSoup soup;
    soup.positions = std::move(mesh->positions);
    if (polygons.corners.size() > 2 * polygons.size())
        soup.triangles.reserve(polygons.corners.size() - 2 * polygons.size());
    soup.source_face.reserve(soup.triangles.capacity());
    PolygonTriangulator triangulator(soup.positions, polygons);
    std::size_t small = 0;
    for (std::size_t p = 0; p < polygons.size(); ++p) {
        if (p % elements_per_poll == 0 && context.cancelled())
            return Context::cancelled_error("read");
        small += polygons.count(p) < 3;
        triangulator.triangulate(p, soup.triangles);
        soup.source_face.resize(soup.triangles.size(), static_cast<Index>(p));
    }
    if (small > 0)
        context.log(LogLevel::warning, path + ": left out " + std::to_string(small) +
                                           " faces with fewer than three corners");
    if (soup.triangles.empty())
        return Error{ErrorCode::empty_input, path + ": no face has three corners", invalid_index};
    return soup;
}

} // namespace bot2nurbs
