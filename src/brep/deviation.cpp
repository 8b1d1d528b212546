// SPDX-License-Identifier: MIT
#include "bot2nurbs/deviation.h"

#include "bot2nurbs/closest_point.h"
#include "core/parallel.h"
#include "fit/surface_locator.h"
#include "spline/bernstein.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace bot2nurbs {

namespace {

//! Places measured per direction, for a Bezier piece, at least and at most. A closest point costs
//! some microseconds. Root mean squares of either direction are within 1 % of those of sixteen
//! times as many places (seven models); the largest distance of a mesh is for bound_hausdorff() to
//! find.
constexpr std::size_t face_samples_per_piece = 6, least_face_samples = 4000,
                      most_face_samples = 30000;
constexpr std::size_t surface_samples_per_piece = 9, least_surface_samples = 2500,
                      most_surface_samples = 25000;
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
    Index piece = invalid_index; //!< Bezier piece of the surface.
};

//! Fractional parts of multiples of the plastic number's powers spread evenly over the square at
//! any count (Roberts' R2 sequence), without a random generator.
constexpr double r2_u = 0.7548776662466927, r2_v = 0.5698402909980532;

double fraction(double x)
{
    return x - std::floor(x);
}

//! `count` points spread evenly by area.
std::vector<Place> source_places(const ManifoldMesh& source, std::size_t count)
{
    std::vector<Place> places;
    places.reserve(count);
    double total = 0.0;
    for (Index f = 0; f < source.face_count(); ++f)
        total += 0.5 * norm(source.area_vector(f));
    const double step = total / static_cast<double>(count);
    double covered = 0.0;
    std::size_t taken = 0;
    for (Index f = 0; f < source.face_count(); ++f) {
        covered += 0.5 * norm(source.area_vector(f));
        for (; taken < count && (static_cast<double>(taken) + 0.5) * step <= covered; ++taken) {
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

//! Adds the midpoints of n x n cells of a Bezier piece, with their areas as weights.
void add_midpoints(const SplineSurface& surface, Index piece, Index n, std::vector<Place>& places)
{
    const Index q = piece / pieces_per_quad, a = piece % pieces_per_quad / pieces_per_side,
                b = piece % pieces_per_side;
    for (Index i = 0; i < n; ++i)
        for (Index j = 0; j < n; ++j) {
            const SurfacePoint s = surface.evaluate(
                {q, (a + (i + 0.5) / n) / pieces_per_side, (b + (j + 0.5) / n) / pieces_per_side});
            places.push_back(
                {s.position, norm(cross(s.du, s.dv)) / (pieces_per_quad * n * n), piece});
        }
}

//! Cell midpoints of every Bezier piece, as dense as its size asks for, and the patch corners.
std::vector<Place> surface_places(const SplineSurface& surface)
{
    const Index pieces = surface.patch_count() * pieces_per_quad;
    std::vector<double> area(pieces);
    double total = 0.0;
    for (Index p = 0; p < pieces; ++p)
        total += area[p] = piece_area(surface, p);
    const double samples =
        static_cast<double>(std::clamp(surface_samples_per_piece * std::size_t{pieces},
                                       least_surface_samples, most_surface_samples));
    std::vector<Place> places;
    for (Index p = 0; p < pieces; ++p) {
        const double wanted = total > 0.0 ? std::sqrt(samples * area[p] / total) : 0.0;
        add_midpoints(
            surface, p,
            static_cast<Index>(std::clamp<double>(std::ceil(wanted), least_side, most_side)),
            places);
    }
    constexpr Index last = pieces_per_side - 1;
    for (Index q = 0; q < surface.patch_count(); ++q)
        for (const Index a : {0u, last})
            for (const Index b : {0u, last})
                places.push_back({surface.position({q, a > 0 ? 1.0 : 0.0, b > 0 ? 1.0 : 0.0}), 0.0,
                                  q * pieces_per_quad + a * pieces_per_side + b});
    return places;
}

//! distance(position) of all places. \return nothing when cancelled.
template <class Distance> std::optional<std::vector<double>>
measure(const std::vector<Place>& places, const Context& context, const Distance& distance)
{
    std::vector<double> distances(places.size());
    if (!for_each_chunk(context, places.size(), chunk_places,
                        [&](std::size_t begin, std::size_t end) {
                            for (std::size_t i = begin; i < end; ++i)
                                distances[i] = distance(places[i].position);
                        }))
        return std::nullopt;
    return distances;
}

//! \return the place with the largest distance.
const Place& summarise(const std::vector<Place>& places, const std::vector<double>& distances,
                       DistanceStatistics& statistics)
{
    double sum = 0.0, weight = 0.0;
    std::size_t worst = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
        sum += places[i].weight * distances[i] * distances[i];
        weight += places[i].weight;
        if (distances[i] > distances[worst])
            worst = i;
    }
    statistics.samples = static_cast<Index>(places.size());
    statistics.max = distances[worst];
    statistics.worst = places[worst].position;
    statistics.rms = weight > 0.0 ? std::sqrt(sum / weight) : 0.0;
    return places[worst];
}

} // namespace

Result<Deviation> measure_deviation(const ManifoldMesh& source, const QuadComplex& complex,
                                    const SplineSurface& surface, Context& context)
{
    if (source.face_count() == 0 || surface.patch_count() == 0)
        return Error{ErrorCode::empty_input, "nothing to measure a deviation of", invalid_index};
    Deviation deviation;
    {
        const SurfaceLocator locator(complex, surface, seed_cells, &context);
        if (context.cancelled())
            return Context::cancelled_error("deviation");
        const std::size_t wanted =
            face_samples_per_piece * pieces_per_quad * std::size_t{surface.patch_count()};
        const std::vector<Place> places =
            source_places(source, std::clamp(wanted, least_face_samples, most_face_samples));
        const auto distances =
            measure(places, context, [&](const Vec3& p) { return locator.closest(p).distance; });
        if (!distances)
            return Context::cancelled_error("deviation");
        summarise(places, *distances, deviation.source_to_surface);
    }
    const ClosestPoint mesh(source, &context);
    const auto to_source = [&](const Vec3& p) { return mesh.query(p).distance; };
    const std::vector<Place> places = surface_places(surface);
    const auto distances = measure(places, context, to_source);
    if (!distances)
        return Context::cancelled_error("deviation");
    deviation.worst_patch =
        summarise(places, *distances, deviation.surface_to_source).piece / pieces_per_quad;
    return deviation;
}

} // namespace bot2nurbs
