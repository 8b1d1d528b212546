// SPDX-License-Identifier: MIT
#include "bot2nurbs/curve_deviation.h"

#include "bot2nurbs/closest_point.h"
#include "spline/bernstein.h"

#include <array>
#include <cmath>

namespace bot2nurbs {

namespace {

constexpr int segments_per_piece = 64;
// Samples of the source between two vertices of a path, which is straight there: the distance to a
// smooth curve has its largest value at a vertex or near the middle.
constexpr int samples_per_segment = 4;

// Straight segments, joined or not.
struct Segments {
    std::vector<Vec3> points;
    std::vector<std::array<Index, 3>> ends; // Triangles without width.

    void add(const std::vector<Vec3>& polyline)
    {
        const Index first = static_cast<Index>(points.size());
        points.insert(points.end(), polyline.begin(), polyline.end());
        for (Index i = 1; i < polyline.size(); ++i)
            ends.push_back({first + i - 1, first + i, first + i});
    }
};

std::vector<Vec3> source_polyline(const ManifoldMesh& mesh, const DomainEdge& edge, Index a,
                                  Index b)
{
    std::vector<Vec3> points{mesh.position(a)};
    for (const PathPoint& p : edge.path)
        points.push_back(mesh.position(p.from) +
                         p.t * (mesh.position(p.to) - mesh.position(p.from)));
    points.push_back(mesh.position(b));
    return points;
}

std::vector<Vec3> surface_polyline(const SplineSurface& surface, Index halfedge)
{
    constexpr int count = segments_per_piece * static_cast<int>(pieces_per_side);
    const Index q = QuadComplex::quad_of(halfedge), side = QuadComplex::side_of(halfedge);
    std::vector<Vec3> points;
    for (int i = 0; i <= count; ++i) {
        const double t = static_cast<double>(i) / count;
        const std::array<std::array<double, 2>, 4> uv{{{t, 0}, {1, t}, {1 - t, 1}, {0, 1 - t}}};
        points.push_back(surface.evaluate({q, uv[side][0], uv[side][1]}).position);
    }
    return points;
}

// Distances of points spread evenly over `from` to `to`.
DistanceStatistics distances(const Segments& from, const Segments& to, int per_segment)
{
    const ClosestPoint closest(to.points, to.ends);
    DistanceStatistics result;
    double sum = 0.0, weight = 0.0;
    for (const auto& [a, b, same] : from.ends) {
        const Vec3 p = from.points[a], q = from.points[b];
        const double each = norm(q - p) / per_segment;
        for (int i = 0; i <= per_segment; ++i) {
            const Vec3 x = p + static_cast<double>(i) / per_segment * (q - p);
            const double d = closest.query(x).distance;
            const double share = i == 0 || i == per_segment ? 0.5 * each : each;
            sum += share * d * d;
            weight += share;
            ++result.samples;
            if (d >= result.max) {
                result.max = d;
                result.worst = x;
            }
        }
    }
    result.rms = weight > 0.0 ? std::sqrt(sum / weight) : 0.0;
    return result;
}

CurveDeviation measure(const QuadDomain& domain, const SplineSurface& surface,
                       const std::vector<Index>& edges)
{
    CurveDeviation result;
    Segments source, curve;
    for (const Index e : edges) {
        const DomainEdge& edge = domain.edges[e];
        source.add(source_polyline(domain.carrier.mesh, edge, domain.vertices[edge.a],
                                   domain.vertices[edge.b]));
        curve.add(surface_polyline(surface, domain.complex.halfedge_of_edge(e)));
    }
    result.edges = static_cast<Index>(edges.size());
    for (const auto& [a, b, same] : source.ends)
        result.length += norm(source.points[b] - source.points[a]);
    result.source_to_surface = distances(source, curve, samples_per_segment);
    result.surface_to_source = distances(curve, source, 1);
    return result;
}

// The boundary edge after the one of a halfedge, with the surface to the left.
Index next_on_boundary(const QuadComplex& complex, Index halfedge)
{
    Index h = QuadComplex::next(halfedge);
    while (complex.twin(h) != invalid_index)
        h = QuadComplex::next(complex.twin(h));
    return h;
}

} // namespace

CurveDeviations measure_curves(const QuadDomain& domain, const SplineSurface& surface)
{
    const QuadComplex& complex = domain.complex;
    CurveDeviations result;
    std::vector<char> done(complex.edge_count(), 0);
    std::vector<Index> creases;
    for (Index e = 0; e < complex.edge_count(); ++e) {
        if (complex.is_crease(e) && !complex.is_boundary_edge(e))
            creases.push_back(e);
        if (!complex.is_boundary_edge(e) || done[e])
            continue;
        std::vector<Index> loop;
        for (Index h = complex.halfedge_of_edge(e); !done[complex.edge(h)];
             h = next_on_boundary(complex, h)) {
            done[complex.edge(h)] = 1;
            loop.push_back(complex.edge(h));
        }
        result.boundary.push_back(measure(domain, surface, loop));
    }
    if (!creases.empty())
        result.creases = measure(domain, surface, creases);
    return result;
}

} // namespace bot2nurbs
