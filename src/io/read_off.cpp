// SPDX-License-Identifier: MIT
#include "io/off_header.h"

namespace bot2nurbs {

Result<PolygonMesh> read_off(const MeshFile& file, Context& context)
{
    TextScanner text(file.bytes, '#');
    const Result<OffHeader> header = read_off_header(file, text);
    if (!header)
        return header.error();
    const std::uint64_t vertices = header->vertices, faces = header->faces;

    std::vector<Vec3> positions(vertices);
    for (std::size_t v = 0; v < vertices; ++v) {
        if (v % elements_per_poll == 0 && context.cancelled())
            return Context::cancelled_error("read");
        Vec3& p = positions[v];
        if (!text.number(p.x) || !text.number_in_line(p.y) || !text.number_in_line(p.z))
            return error_at_line(file, text.line(),
                                 "vertex " + std::to_string(v) + " of " + std::to_string(vertices) +
                                     ": " + expected_number(text.bad_word()),
                                 static_cast<Index>(v));
        text.skip_line(); // normal, colour, texture coordinates
    }
    PolygonList polygons;
    polygons.first.reserve(faces + 1);
    polygons.corners.reserve(3 * faces);
    for (std::size_t f = 0; f < faces; ++f) {
        if (f % elements_per_poll == 0 && context.cancelled())
            return Context::cancelled_error("read");
        const auto fail = [&](const std::string& what) {
            return error_at_line(file, text.line(),
                                 "face " + std::to_string(f) + " of " + std::to_string(faces) +
                                     ": " + what,
                                 static_cast<Index>(f));
        };
        std::uint64_t corners = 0;
        if (!text.number(corners))
            return fail(expected_number(text.bad_word()));
        for (std::uint64_t k = 0; k < corners; ++k) {
            std::int64_t v = 0;
            if (!text.number_in_line(v))
                return fail("corner " + std::to_string(k) + " of " + std::to_string(corners) +
                            ": " + expected_number(text.bad_word()));
            if (v < 0 || static_cast<std::uint64_t>(v) >= vertices)
                return fail("vertex " + std::to_string(v) + " is out of range (the file has " +
                            std::to_string(vertices) + ")");
            polygons.corners.push_back(static_cast<Index>(v));
        }
        polygons.close();
        text.skip_line(); // colour
    }
    return PolygonMesh{std::move(positions), std::move(polygons)};
}

} // namespace bot2nurbs
