// SPDX-License-Identifier: MIT
#include "convert/tessellation.h"

#include "bot2nurbs/closest_point.h"
#include "core/parallel.h"

#include <cstring>
#include <fmt/format.h>

namespace bot2nurbs {

namespace {

// Cells of a patch per direction: three in each of the four Bezier pieces.
constexpr Index cells = 12;
constexpr Index side = cells + 1;
constexpr Index vertices_per_patch = side * side;
constexpr Index triangles_per_patch = 2 * cells * cells;

// x y z as doubles, six floats, two integers; a triangle is a count and three integers.
constexpr std::size_t vertex_bytes = 3 * 8 + 6 * 4 + 2 * 4;
constexpr std::size_t triangle_bytes = 1 + 3 * 4;

//! Appends a number's bytes at `at`. The header names the machine's own byte order.
template <class T> void put(char*& at, T value)
{
    std::memcpy(at, &value, sizeof value);
    at += sizeof value;
}

bool little_endian()
{
    const std::uint16_t one = 1;
    unsigned char first = 0;
    std::memcpy(&first, &one, 1);
    return first == 1;
}

void put_patch(const TessellationPart& part, const ClosestPoint& source, Index patch, Index number,
               char* at)
{
    for (Index i = 0; i < side; ++i) {
        for (Index j = 0; j < side; ++j) {
            const double u = static_cast<double>(i) / cells, v = static_cast<double>(j) / cells;
            const SurfacePoint p = part.surface->evaluate({patch, u, v});
            const Vec3 normal = normalized(cross(p.du, p.dv));
            const ClosestPoint::Hit hit = source.query(p.position);
            const Vec3 outward = part.source->area_vector(hit.where.face);
            const double sign = dot(p.position - hit.position, outward) < 0.0 ? -1.0 : 1.0;
            // Corners 0 to 3 are at (0, 0), (1, 0), (1, 1), (0, 1).
            const bool corner = (i == 0 || i == cells) && (j == 0 || j == cells);
            const Index which = j == 0 ? (i == 0 ? 0 : 1) : (i == 0 ? 3 : 2);
            for (int k = 0; k < 3; ++k)
                put(at, p.position[k]);
            for (int k = 0; k < 3; ++k)
                put(at, static_cast<float>(normal[k]));
            put(at, static_cast<float>(u));
            put(at, static_cast<float>(v));
            put(at, static_cast<float>(sign * hit.distance));
            put(at, static_cast<std::int32_t>(number));
            put(at, static_cast<std::int32_t>(
                        corner ? part.complex->valence(part.complex->quad(patch)[which]) : 0));
        }
    }
}

void put_triangles(Index number, char* at)
{
    const auto triangle = [&](Index a, Index b, Index c) {
        put(at, static_cast<unsigned char>(3));
        for (const Index v : {a, b, c})
            put(at, static_cast<std::int32_t>(v));
    };
    for (Index i = 0; i < cells; ++i) {
        for (Index j = 0; j < cells; ++j) {
            const Index a = number * vertices_per_patch + i * side + j;
            triangle(a, a + side, a + side + 1);
            triangle(a, a + side + 1, a + 1);
        }
    }
}

} // namespace

Result<std::string> tessellation_to_ply(const std::vector<TessellationPart>& parts,
                                        Context& context)
{
    Index patches = 0;
    for (const TessellationPart& part : parts)
        patches += part.surface->patch_count();
    std::string text = fmt::format("ply\nformat {} 1.0\nelement vertex {}\n",
                                   little_endian() ? "binary_little_endian" : "binary_big_endian",
                                   patches * vertices_per_patch);
    for (const char* name : {"x", "y", "z"})
        text += fmt::format("property double {}\n", name);
    for (const char* name : {"nx", "ny", "nz", "u", "v", "distance"})
        text += fmt::format("property float {}\n", name);
    text += fmt::format("property int patch\nproperty int valence\nelement face {}\n"
                        "property list uchar int vertex_indices\nend_header\n",
                        patches * triangles_per_patch);
    const std::size_t first_vertex = text.size();
    const std::size_t first_triangle =
        first_vertex + std::size_t{patches} * vertices_per_patch * vertex_bytes;
    text.resize(first_triangle + std::size_t{patches} * triangles_per_patch * triangle_bytes);

    Index number = 0;
    for (const TessellationPart& part : parts) {
        const ClosestPoint source(*part.source);
        const Index count = part.surface->patch_count();
        const bool done = for_each_chunk(context, count, 1, [&](std::size_t begin, std::size_t) {
            const Index patch = static_cast<Index>(begin);
            const std::size_t k = number + begin;
            put_patch(part, source, patch, number + patch,
                      text.data() + first_vertex + k * vertices_per_patch * vertex_bytes);
            put_triangles(number + patch,
                          text.data() + first_triangle + k * triangles_per_patch * triangle_bytes);
        });
        if (!done)
            return Context::cancelled_error("tessellation");
        number += count;
    }
    return text;
}

} // namespace bot2nurbs
