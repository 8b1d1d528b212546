// SPDX-License-Identifier: MIT
#include "bot2nurbs/deviation.h"

#include "bot2nurbs/closest_point.h"
#include "core/parallel.h"
#include "fit/surface_locator.h"
#include "spline/bernstein.h"

#include <algorithm>
#include <cmath>

namespace bot2nurbs {

namespace {

//! Places measured per direction. A closest point costs a few microseconds, so these keep the whole
//! under a second on one core and under a few seconds for meshes of any size.
constexpr std::size_t face_samples = 120000;
constexpr std::size_t most_vertices = 250000;
constexpr std::size_t surface_samples = 120000;
//! Midpoints per Bezier piece and direction: a bicubic piece bends too little for more than the
//! upper bound to show anything new, and fewer than the lower bound could miss a wiggle.
constexpr Index least_side = 3, most_side = 16;
//! Cells per Bezier piece that seed the search for a foot on the surface.
constexpr Index seed_cells = 2;
constexpr std::size_t chunk_places = 128;

constexpr Index pieces_per_quad = pieces_per_side * pieces_per_side;

//! A place to measure from; weight zero counts for the maximum only.
struct Place {
    Vec3 position;
    double weight = 0.0;
    Index patch = invalid_index;
};

//! Fractional parts of multiples of the plastic number's powers spread evenly over the square at
//! any count (Roberts' R2 sequence), without a random generator.
constexpr double r2_u = 0.7548776662466927, r2_v = 0.5698402909980532;

double fraction(double x)
{
    return x - std::floor(x);
}

//! All vertices (evenly thinned above the cap), then points spread evenly by area.
std::vector<Place> source_places(const ManifoldMesh& source)
{
    std::vector<Place> places;
    const std::size_t vertices = source.vertex_count(), kept = std::min(vertices, most_vertices);
    places.reserve(kept + face_samples);
    for (std::size_t i = 0; i < kept; ++i)
        places.push_back(
            {source.position(static_cast<Index>(i * vertices / kept)), 0.0, invalid_index});
    double total = 0.0;
    for (Index f = 0; f < source.face_count(); ++f)
        total += 0.5 * norm(source.area_vector(f));
    const double step = total / static_cast<double>(face_samples);
    double covered = 0.0;
    std::size_t taken = 0;
    for (Index f = 0; f < source.face_count(); ++f) {
        covered += 0.5 * norm(source.area_vector(f));
        for (; taken < face_samples && (static_cast<double>(taken) + 0.5) * step <= covered;
             ++taken) {
            double u = fraction(static_cast<double>(taken) * r2_u);
            double v = fraction(static_cast<double>(taken) * r2_v);
            if (u + v > 1.0) {
                u = 1.0 - u;
                v = 1.0 - v;
            }
            places.push_back({source.at({f, {1.0 - u - v, u, v}}), step, invalid_index});
        }
    }
    return places;
}

double piece_area(const SplineSurface& surface, Index piece)
{
    const Index q = piece / pieces_per_quad, a = piece % pieces_per_quad / pieces_per_side,
                b = piece % pieces_per_side;
    const SurfacePoint s =
        surface.evaluate({q, (a + 0.5) / pieces_per_side, (b + 0.5) / pieces_per_side});
    return norm(cross(s.du, s.dv)) / pieces_per_quad;
}

//! Cell midpoints of every Bezier piece, as dense as its size asks for, and the patch corners.
std::vector<Place> surface_places(const SplineSurface& surface)
{
    const Index pieces = surface.patch_count() * pieces_per_quad;
    std::vector<double> area(pieces);
    double total = 0.0;
    for (Index p = 0; p < pieces; ++p)
        total += area[p] = piece_area(surface, p);
    std::vector<Place> places;
    for (Index p = 0; p < pieces; ++p) {
        const double wanted = total > 0.0 ? std::sqrt(surface_samples * area[p] / total) : 0.0;
        const auto n =
            static_cast<Index>(std::clamp<double>(std::ceil(wanted), least_side, most_side));
        const Index q = p / pieces_per_quad, a = p % pieces_per_quad / pieces_per_side,
                    b = p % pieces_per_side;
        for (Index i = 0; i < n; ++i)
            for (Index j = 0; j < n; ++j) {
                const SurfacePoint s = surface.evaluate({q, (a + (i + 0.5) / n) / pieces_per_side,
                                                         (b + (j + 0.5) / n) / pieces_per_side});
                places.push_back(
                    {s.position, norm(cross(s.du, s.dv)) / (pieces_per_quad * n * n), q});
            }
    }
    for (Index q = 0; q < surface.patch_count(); ++q)
        for (const DomainPoint& corner : {DomainPoint{q, 0, 0}, DomainPoint{q, 1, 0},
                                          DomainPoint{q, 1, 1}, DomainPoint{q, 0, 1}})
            places.push_back({surface.position(corner), 0.0, q});
    return places;
}

//! Statistics of distance(position, near) over all places, where `near` is what the last place of a
//! chunk left for the next; the patch of the worst place to `worst_patch`.
template <class Distance> bool measure(const std::vector<Place>& places, const Context& context,
                                       const Distance& distance, DistanceStatistics& statistics,
                                       Index& worst_patch)
{
    std::vector<double> distances(places.size());
    if (!for_each_chunk(context, places.size(), chunk_places,
                        [&](std::size_t begin, std::size_t end) {
                            Index near = invalid_index;
                            for (std::size_t i = begin; i < end; ++i)
                                distances[i] = distance(places[i].position, near);
                        }))
        return false;
    double sum = 0.0, weight = 0.0;
    statistics.samples = static_cast<Index>(places.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
        sum += places[i].weight * distances[i] * distances[i];
        weight += places[i].weight;
        if (i == 0 || distances[i] > statistics.max) {
            statistics.max = distances[i];
            statistics.worst = places[i].position;
            worst_patch = places[i].patch;
        }
    }
    statistics.rms = weight > 0.0 ? std::sqrt(sum / weight) : 0.0;
    return true;
}

} // namespace

Result<Deviation> measure_deviation(const ManifoldMesh& source, const QuadComplex& complex,
                                    const SplineSurface& surface, Context& context)
{
    if (source.face_count() == 0 || surface.patch_count() == 0)
        return Error{ErrorCode::empty_input, "nothing to measure a deviation of", invalid_index};
    Deviation deviation;
    Index ignored = invalid_index;
    const SurfaceLocator locator(complex, surface, seed_cells);
    if (context.cancelled() ||
        !measure(
            source_places(source), context,
            [&](const Vec3& p, Index& near) { return locator.closest(p, near).distance; },
            deviation.source_to_surface, ignored))
        return Context::cancelled_error("deviation");
    const ClosestPoint mesh(source);
    if (context.cancelled() || !measure(
                                   surface_places(surface), context,
                                   [&](const Vec3& p, Index& near) {
                                       const ClosestPoint::Hit hit = mesh.query_near(p, near);
                                       near = hit.where.face;
                                       return hit.distance;
                                   },
                                   deviation.surface_to_source, deviation.worst_patch))
        return Context::cancelled_error("deviation");
    return deviation;
}

} // namespace bot2nurbs
