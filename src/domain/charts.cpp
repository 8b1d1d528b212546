// SPDX-License-Identifier: MIT
#include "bot2nurbs/quad_domain.h"

#include "core/parallel.h"
#include "domain/domain_paths.h"
#include "maps/convex_map.h"

#include <oneapi/tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace bot2nurbs {

namespace {

QuadChart make_chart(const ManifoldMesh& source, const CarrierMesh& carrier, const Overlay& overlay,
                     const ConvexMap& map)
{
    QuadChart chart;
    chart.vertices.resize(overlay.vertices.size());
    for (std::size_t i = 0; i < overlay.vertices.size(); ++i)
        chart.vertices[i] = {overlay.vertices[i].position, map.uv[i]};
    chart.level = map.level;
    chart.triangles = overlay.triangles;
    chart.source_face.resize(overlay.triangles.size());
    chart.bary.resize(overlay.triangles.size());
    for (std::size_t t = 0; t < overlay.triangles.size(); ++t) {
        const Index f = overlay.face[t];
        const Index face = carrier.face_source[f];
        chart.source_face[t] = face;
        for (int k = 0; k < 3; ++k) {
            const auto w = overlay.bary_in(carrier.mesh, overlay.triangles[t][k], f);
            if (!carrier.refined) {
                chart.bary[t][k] = w;
                continue;
            }
            std::array<double, 3> sum{};
            for (int i = 0; i < 3; ++i) {
                const Index v = carrier.mesh.triangle(f)[i];
                const auto c = carrier.weights(source, v, face);
                for (int j = 0; j < 3; ++j)
                    sum[j] += w[i] * c[j];
            }
            chart.bary[t][k] = sum;
        }
    }
    return chart;
}

} // namespace

Result<std::vector<QuadChart>> compute_charts(const ManifoldMesh& source, const QuadDomain& domain,
                                              Context& context)
{
    const QuadComplex& complex = domain.complex;
    std::vector<SurfacePath> paths;
    paths.reserve(domain.edges.size());
    for (Index e = 0; e < domain.edges.size(); ++e) {
        Result<SurfacePath> path = domain_path(domain, e);
        if (!path)
            return path.error();
        paths.push_back(std::move(*path));
    }

    std::vector<std::optional<QuadChart>> charts(complex.quad_count());
    std::vector<const char*> failure(complex.quad_count(), nullptr);
    oneapi::tbb::enumerable_thread_specific<OverlayBuilder> builders(
        [&domain] { return OverlayBuilder(domain.carrier.mesh); });
    const bool finished =
        for_each_chunk(context, complex.quad_count(), 1, [&](std::size_t begin, std::size_t end) {
            OverlayBuilder& builder = builders.local();
            for (Index q = static_cast<Index>(begin); q < end; ++q) {
                std::vector<PathSide> sides;
                for (Index s = 0; s < 4; ++s) {
                    const Index h = 4 * q + s, e = complex.edge(h);
                    sides.push_back({&paths[e], complex.from(h) != domain.edges[e].a});
                }
                const std::optional<Overlay> overlay = builder.disk(sides);
                if (!overlay) {
                    failure[q] = "its region is not a disk";
                    continue;
                }
                const auto map = map_to_polygon(*overlay, unit_square());
                if (!map) {
                    failure[q] = "its region cannot be mapped to the square without folds";
                    continue;
                }
                charts[q] = make_chart(source, domain.carrier, *overlay, *map);
            }
        });
    if (!finished)
        return Context::cancelled_error("charts");
    std::vector<QuadChart> result;
    result.reserve(charts.size());
    for (Index q = 0; q < charts.size(); ++q) {
        if (!charts[q])
            return Error{ErrorCode::layout_failed, "quad " + std::to_string(q) + ": " + failure[q],
                         q};
        result.push_back(std::move(*charts[q]));
    }
    return result;
}

std::vector<double> corner_angles(const std::vector<QuadChart>& charts)
{
    const std::vector<Vec2> corner = unit_square();
    std::vector<double> angles(4 * charts.size(), 0.0);
    for (std::size_t q = 0; q < charts.size(); ++q) {
        const QuadChart& chart = charts[q];
        for (const auto& t : chart.triangles) {
            for (std::size_t k = 0; k < 3; ++k) {
                const QuadChart::Vertex& apex = chart.vertices[t[k]];
                const auto at = std::find(corner.begin(), corner.end(), apex.uv);
                if (at == corner.end())
                    continue;
                const Vec3 a = chart.vertices[t[(k + 1) % 3]].position - apex.position;
                const Vec3 b = chart.vertices[t[(k + 2) % 3]].position - apex.position;
                angles[4 * q + static_cast<std::size_t>(at - corner.begin())] +=
                    std::atan2(norm(cross(a, b)), dot(a, b));
            }
        }
    }
    return angles;
}

} // namespace bot2nurbs
