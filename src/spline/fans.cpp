// SPDX-License-Identifier: MIT
#include "spline/fans.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace bot2nurbs {

namespace {

//! Towards 0, pi and 2 pi the map from the plane to the tangent plane gets singular.
constexpr double singular = M_PI / 6.0;
//! Sectors narrower than this make masks with large weights, and edges wider apart are impossible.
constexpr double least_sector = M_PI / 4.0, most_sector = 2.0 * M_PI / 3.0;

} // namespace

double corner_fan_angle(Index k)
{
    if (k == 1)
        return 0.0; // no smooth edge, so no angle is needed
    return k == 2 ? 2.0 * M_PI / 3.0 : 1.5 * M_PI;
}

double corner_fan_angle(Index k, double measured)
{
    if (k == 1)
        return 0.0;
    if (measured < M_PI)
        return std::min(std::max(measured, k * least_sector), M_PI - singular);
    const double least = std::max(M_PI + singular, k * least_sector);
    return std::min({std::max(measured, least), 2.0 * M_PI - singular, k * most_sector});
}

Result<std::vector<Fan>> find_fans(const QuadComplex& complex,
                                   const std::vector<double>& corner_angles)
{
    std::vector<Fan> fans;
    fans.reserve(complex.vertex_count());
    std::vector<Index> around; // sectors of the vertex, counter-clockwise
    for (Index v = 0; v < complex.vertex_count(); ++v) {
        around.clear();
        Index h = complex.halfedge_at(v);
        do {
            around.push_back(h);
            h = complex.rotate_ccw(h);
        } while (h != invalid_index && h != complex.halfedge_at(v));
        const bool boundary = h == invalid_index;
        const auto starts_fan = [&](Index s) { return complex.is_sharp(complex.edge(s)); };
        // Two creases divide the quads as a boundary would; around one, or none, they are one fan.
        if (!boundary && around.size() < 3 &&
            std::count_if(around.begin(), around.end(), starts_fan) < 2) {
            return Error{ErrorCode::invalid_domain,
                         "vertex " + std::to_string(v) + " lies inside the domain and has only " +
                             std::to_string(around.size()) + " quads; at least 3 are needed",
                         v};
        }
        const auto first = std::find_if(around.begin(), around.end(), starts_fan);
        if (first == around.end()) {
            fans.push_back({v, FanKind::closed, 2.0 * M_PI, around});
            continue;
        }
        // At a boundary vertex the first sector already starts at a sharp edge.
        std::rotate(around.begin(), first, around.end());
        const std::size_t first_fan = fans.size();
        for (Index s : around) {
            if (starts_fan(s))
                fans.push_back({v, FanKind::corner, 0.0, {}});
            fans.back().sectors.push_back(s);
        }
        const std::size_t fan_count = fans.size() - first_fan;
        const std::size_t sharp_edges = fan_count + (boundary ? 1 : 0);
        bool smooth = sharp_edges == 2 && !complex.is_corner(v);
        for (std::size_t f = first_fan; f < fans.size(); ++f) {
            // A straight tangent over a single quad would leave its corner without a normal.
            if (fans[f].sectors.size() < 2)
                smooth = false;
        }
        for (std::size_t f = first_fan; f < fans.size(); ++f) {
            Fan& fan = fans[f];
            if (sharp_edges == 1) {
                fan.kind = FanKind::dart;
                fan.alpha = 2.0 * M_PI;
            } else if (smooth) {
                fan.kind = FanKind::smooth;
                fan.alpha = M_PI;
            } else {
                double measured = 0.0;
                for (const Index s : fan.sectors)
                    measured += corner_angles.empty() ? 0.0 : corner_angles[s];
                fan.alpha = measured > 0.0 ? corner_fan_angle(fan.sector_count(), measured)
                                           : corner_fan_angle(fan.sector_count());
            }
        }
    }
    return fans;
}

} // namespace bot2nurbs
