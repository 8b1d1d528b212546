// SPDX-License-Identifier: MIT
#include "fit/plane_quads.h"

#include <cmath>

namespace bot2nurbs {

namespace {

// Meshes are often stored in single precision: 6e-8 of the size of the model, and as much over the
// height of a face in its normal.
constexpr double same_plane = 1e-6;
constexpr double same_normal = 1e-4;

// The plane of a quad's first sample.
struct Plane {
    Vec3 point, normal;
    bool found = false, holds_all = true;

    void add(const Vec3& p, const Vec3& n)
    {
        if (!found) {
            found = true;
            point = p;
            normal = n;
        }
        holds_all = holds_all && norm(n - normal) <= same_normal &&
                    std::fabs(dot(p - point, normal)) <= same_plane;
    }
};

} // namespace

std::vector<char> in_plane_quads(Index quads, const std::vector<Vec3>& points,
                                 const std::vector<Vec3>& normals,
                                 const std::vector<DomainPoint>& where,
                                 const std::vector<char>& on_curve)
{
    std::vector<char> result(points.size(), 0);
    if (normals.empty())
        return result;
    const auto is_inner = [&](std::size_t i) { return on_curve.empty() || !on_curve[i]; };
    std::vector<Plane> planes(quads);
    for (std::size_t i = 0; i < points.size(); ++i)
        if (is_inner(i))
            planes[where[i].quad].add(points[i], normals[i]);
    for (std::size_t i = 0; i < points.size(); ++i)
        result[i] = is_inner(i) && planes[where[i].quad].holds_all;
    return result;
}

} // namespace bot2nurbs
