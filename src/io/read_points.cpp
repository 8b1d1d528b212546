// SPDX-License-Identifier: MIT
#include "bot2nurbs/read_points.h"

#include "io/file_bytes.h"
#include "io/off_header.h"
#include "io/ply_header.h"
#include "io/point_table.h"

#include <algorithm>

namespace bot2nurbs {

namespace {

constexpr const char* column_extensions[] = {"xyz", "xyzn", "xyzrgb", "pts",
                                             "pwn", "txt",  "asc",    "csv"};
constexpr const char* known = "known are .ply .pcd .las .xyz .pts .txt .asc .csv .obj and .off";

bool has_columns(const std::string& extension)
{
    return std::find(std::begin(column_extensions), std::end(column_extensions), extension) !=
           std::end(column_extensions);
}

//! The format that the first bytes of a file say; empty when they say none.
std::string format_of_content(std::string_view bytes)
{
    if (bytes.substr(0, 4) == "ply\n" || bytes.substr(0, 4) == "ply\r")
        return "ply";
    if (bytes.substr(0, 4) == "LASF")
        return "las";
    if (bytes.substr(0, 8) == "ASTM-E57")
        return "e57";
    if (bytes.substr(0, 6) == "# .PCD" || bytes.substr(0, 7) == "VERSION")
        return "pcd";
    const std::size_t start = bytes.find_first_not_of(" \t\r\n");
    if (start != std::string_view::npos &&
        std::string_view("0123456789+-.").find(bytes[start]) != std::string_view::npos &&
        bytes.find('\0') == std::string_view::npos)
        return "xyz";
    return {};
}

bool obj_has_faces(std::string_view bytes)
{
    TextScanner text(bytes, '#');
    while (!text.at_end()) {
        const std::string_view keyword = text.word_in_line();
        if (keyword == "f" || keyword == "fo")
            return true;
        text.skip_line();
    }
    return false;
}

//! False where the file says that it has none; errors of the header are for the reader to name.
bool has_faces(const std::string& format, const MeshFile& file)
{
    if (format == "obj")
        return obj_has_faces(file.bytes);
    if (format == "off") {
        TextScanner text(file.bytes, '#');
        const Result<OffHeader> header = read_off_header(file, text);
        return !header || header->faces > 0;
    }
    const Result<PlyHeader> header = read_ply_header(file);
    if (!header)
        return true;
    return std::any_of(header->elements.begin(), header->elements.end(), [](const PlyElement& e) {
        return (e.name == "face" || e.name == "tristrips") && e.count > 0;
    });
}

} // namespace

Result<PointCloud> read_points(const std::string& path, Context& context)
{
    const Result<std::string> bytes = read_bytes(path, context);
    if (!bytes)
        return bytes.error();
    const MeshFile file{path, *bytes};
    const auto refuse = [&path](const std::string& why) {
        return Error{ErrorCode::cannot_read, path + ": " + why, invalid_index};
    };
    std::string format = extension(path);
    if (format == "e57" || format == "laz" || format == "stl")
        return refuse(format == "stl" ? std::string("STL files have no points without faces")
                                      : "." + format + " files are not read; save it as .las or " +
                                            ".ply first");
    if (has_columns(format))
        return read_point_text(file, context);
    if (format != "ply" && format != "obj" && format != "off" && format != "pcd" && format != "las")
        format = format_of_content(*bytes);
    if (format == "ply")
        return read_ply_points(file, context);
    if (format == "obj")
        return read_obj_points(file, context);
    if (format == "off")
        return read_off_points(file, context);
    if (format == "pcd")
        return read_pcd(file, context);
    if (format == "las")
        return read_las(file, context);
    if (format == "xyz")
        return read_point_text(file, context);
    if (format == "e57")
        return refuse("E57 files are not read; save it as .las or .ply first");
    return refuse(std::string("neither its extension nor its content says which format it is; ") +
                  known);
}

Result<FileContent> file_content(const std::string& path, Context& context)
{
    const std::string format = extension(path);
    if (has_columns(format) || format == "pcd" || format == "las" || format == "laz" ||
        format == "e57")
        return FileContent::points;
    if (format == "stl")
        return FileContent::mesh;
    const Result<std::string> bytes = read_bytes(path, context);
    if (!bytes)
        return bytes.error();
    const MeshFile file{path, *bytes};
    if (format == "ply" || format == "obj" || format == "off")
        return has_faces(format, file) ? FileContent::mesh : FileContent::points;
    const std::string content = format_of_content(*bytes);
    if (content == "ply")
        return has_faces(content, file) ? FileContent::mesh : FileContent::points;
    // A number at the start is an OFF file without its keyword for read_mesh only by extension.
    return content.empty() ? FileContent::mesh : FileContent::points;
}

} // namespace bot2nurbs
