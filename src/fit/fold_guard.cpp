// SPDX-License-Identifier: MIT
#include "fit/fold_guard.h"

#include "core/parallel.h"
#include "spline/bernstein.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bot2nurbs {

namespace {

constexpr Index pieces_per_quad = pieces_per_side * pieces_per_side;
//! Places on a piece and direction, as parameters of the piece: near the corners, where folds at
//! extraordinary vertices begin, and the middle.
constexpr double places[3] = {0.02, 0.5, 0.98};
//! Unit normals whose mean is shorter than this span more than about 120 degrees; no direction
//! stands for such a piece.
constexpr double clear_mean = 0.5;
constexpr std::size_t chunk_quads = 16;

template <class Visit> void visit_places(const SplineSurface& surface, Index piece, Visit visit)
{
    const Index q = piece / pieces_per_quad, a = piece % pieces_per_quad / pieces_per_side,
                b = piece % pieces_per_side;
    for (const double s : places)
        for (const double t : places) {
            const SurfacePoint p =
                surface.evaluate({q, (a + s) / pieces_per_side, (b + t) / pieces_per_side});
            visit(cross(p.du, p.dv));
        }
}

} // namespace

FoldGuard::FoldGuard(Index quads, const std::vector<Vec3>& normals,
                     const std::vector<DomainPoint>& where)
{
    if (normals.empty())
        return;
    reference_.assign(static_cast<std::size_t>(quads) * pieces_per_quad, Vec3{});
    std::vector<double> count(reference_.size(), 0.0);
    for (std::size_t i = 0; i < normals.size(); ++i) {
        const Index piece = pieces_per_quad * where[i].quad +
                            pieces_per_side * piece_parameter(where[i].u).piece +
                            piece_parameter(where[i].v).piece;
        reference_[piece] += normals[i];
        count[piece] += 1.0;
    }
    for (std::size_t p = 0; p < reference_.size(); ++p)
        reference_[p] =
            norm(reference_[p]) >= clear_mean * count[p] ? normalized(reference_[p]) : Vec3{};
}

void FoldGuard::set_reference(const SplineSurface& surface)
{
    reference_.assign(static_cast<std::size_t>(surface.patch_count()) * pieces_per_quad, Vec3{});
    for (Index p = 0; p < reference_.size(); ++p) {
        Vec3 sum;
        visit_places(surface, p, [&](const Vec3& normal) { sum += normalized(normal); });
        reference_[p] = norm(sum) >= clear_mean * 9.0 ? normalized(sum) : Vec3{};
    }
}

std::vector<Index> FoldGuard::folds(const SplineSurface& surface, const Context& context) const
{
    std::vector<Index> folds(surface.patch_count(), 0);
    if (!ready())
        return folds;
    for_each_chunk(context, folds.size(), chunk_quads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin * pieces_per_quad; p < end * pieces_per_quad; ++p)
            if (!(reference_[p] == Vec3{}))
                visit_places(surface, static_cast<Index>(p), [&](const Vec3& normal) {
                    folds[p / pieces_per_quad] += dot(normal, reference_[p]) < 0.0;
                });
    });
    return folds;
}

std::vector<double> FoldGuard::smallest_jacobians(const SplineSurface& surface,
                                                  const Context& context) const
{
    std::vector<double> smallest(surface.patch_count(), 1.0);
    if (!ready())
        return smallest;
    constexpr double place_count = 9.0 * pieces_per_quad;
    for_each_chunk(context, smallest.size(), chunk_quads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t q = begin; q < end; ++q) {
            double sum = 0.0, least = std::numeric_limits<double>::infinity();
            for (std::size_t p = q * pieces_per_quad; p < (q + 1) * pieces_per_quad; ++p)
                visit_places(surface, static_cast<Index>(p), [&](const Vec3& normal) {
                    sum += norm(normal);
                    if (!(reference_[p] == Vec3{}))
                        least = std::min(least, dot(normal, reference_[p]));
                });
            if (std::isfinite(least))
                smallest[q] = sum > 0.0 ? least * place_count / sum : 0.0;
        }
    });
    return smallest;
}

} // namespace bot2nurbs
