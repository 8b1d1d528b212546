// SPDX-License-Identifier: MIT
#include "layout/face_energy.h"

#include <limits>

namespace bot2nurbs {

double face_distortion(const PatchComplex& complex, const std::vector<PatchComplex::Side>& border,
                       OverlayBuilder& builder)
{
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const auto overlay = complex.overlay(border, builder);
    if (!overlay)
        return infinity;
    const auto map = map_to_polygon(*overlay, unit_square());
    return map ? measure_distortion(*overlay, map->uv).combined() : infinity;
}

double face_energy(const PatchComplex& complex, const std::vector<PatchComplex::Side>& border,
                   const SizeMetric& metric, OverlayBuilder& builder, double* size_out)
{
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const auto overlay = complex.overlay(border, builder);
    if (!overlay)
        return infinity;
    const bool quad = border.size() == 4;
    const auto map = map_to_polygon(*overlay, quad ? unit_square() : regular_polygon(3));
    if (!map)
        return infinity;
    double size = 0.0;
    for (std::size_t t = 0; t < overlay->triangles.size(); ++t) {
        const auto& corner = complex.mesh().triangle(overlay->face[t]);
        const double density =
            (metric.density[corner[0]] + metric.density[corner[1]] + metric.density[corner[2]]) /
            3.0;
        const auto& v = overlay->triangles[t];
        const Vec3 p = overlay->vertices[v[1]].position - overlay->vertices[v[0]].position;
        const Vec3 q = overlay->vertices[v[2]].position - overlay->vertices[v[0]].position;
        size += 0.5 * norm(cross(p, q)) * density * density;
    }
    size /= quad ? metric.target_area : 0.5 * metric.target_area;
    if (size_out)
        *size_out = size;
    return measure_distortion(*overlay, map->uv).combined() * size * size;
}

} // namespace bot2nurbs
