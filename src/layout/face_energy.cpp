// SPDX-License-Identifier: MIT
#include "layout/face_energy.h"

#include "maps/convex_map.h"

#include <algorithm>
#include <limits>

namespace bot2nurbs {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
// Smaller patches count as this size: else any shape would do for those at a narrow neck or handle.
constexpr double least_size = 0.5;

} // namespace

double face_distortion(const std::vector<PathSide>& border, OverlayBuilder& builder)
{
    const auto overlay = builder.disk(border);
    if (!overlay)
        return infinity;
    const auto map = map_to_polygon(*overlay, unit_square());
    return map ? measure_distortion(*overlay, map->uv).combined() : infinity;
}

FaceEnergy face_energy(const std::vector<PathSide>& border, const SizeMetric& metric,
                       OverlayBuilder& builder)
{
    const auto overlay = builder.disk(border);
    if (!overlay)
        return {infinity, 0.0};
    const bool quad = border.size() == 4;
    const auto map = map_to_polygon(*overlay, quad ? unit_square() : regular_polygon(3));
    if (!map)
        return {infinity, 0.0};
    double size = 0.0;
    for (std::size_t t = 0; t < overlay->triangles.size(); ++t) {
        const auto& corner = builder.mesh().triangle(overlay->face[t]);
        const double density =
            (metric.density[corner[0]] + metric.density[corner[1]] + metric.density[corner[2]]) /
            3.0;
        const auto& v = overlay->triangles[t];
        const Vec3 p = overlay->vertices[v[1]].position - overlay->vertices[v[0]].position;
        const Vec3 q = overlay->vertices[v[2]].position - overlay->vertices[v[0]].position;
        size += 0.5 * norm(cross(p, q)) * density * density;
    }
    size /= quad ? metric.target_area : 0.5 * metric.target_area;
    const double counted = std::max(size, least_size);
    return {measure_distortion(*overlay, map->uv).combined() * counted * counted, size};
}

} // namespace bot2nurbs
