// SPDX-License-Identifier: MIT
#include "fit/surface_locator.h"

#include "spline/bernstein.h"

namespace bot2nurbs {

namespace {

//! Per patch its own grid of vertices: closest-point queries do not need them joined.
ClosestPoint tessellate(const SplineSurface& surface, Index side, const Context* context)
{
    const Index row = side + 1;
    std::vector<Vec3> positions;
    std::vector<std::array<Index, 3>> triangles;
    positions.reserve(static_cast<std::size_t>(surface.patch_count()) * row * row);
    triangles.reserve(2ul * surface.patch_count() * side * side);
    for (Index q = 0; q < surface.patch_count(); ++q) {
        if (context && context->cancelled())
            break;
        const Index first = static_cast<Index>(positions.size());
        for (Index i = 0; i <= side; ++i)
            for (Index j = 0; j <= side; ++j)
                positions.push_back(surface.position(
                    {q, static_cast<double>(i) / side, static_cast<double>(j) / side}));
        for (Index i = 0; i < side; ++i)
            for (Index j = 0; j < side; ++j) {
                const Index a = first + i * row + j;
                triangles.push_back({a, a + row, a + row + 1});
                triangles.push_back({a, a + row + 1, a + 1});
            }
    }
    return ClosestPoint(positions, triangles, context);
}

} // namespace

SurfaceLocator::SurfaceLocator(const QuadComplex& complex, const SplineSurface& surface,
                               Index cells, const Context* context)
    : side_(cells * pieces_per_side), walk_(complex, surface),
      tree_(tessellate(surface, side_, context))
{
}

DomainPoint SurfaceLocator::place(const SourcePoint& where) const
{
    const Index cell = where.face / 2, per_patch = side_ * side_;
    const double i = cell % per_patch / side_, j = cell % side_;
    const auto& b = where.bary;
    // Corners of the two triangles of a cell in (u, v): 00 10 11 and 00 11 01.
    const bool lower = where.face % 2 == 0;
    return {cell / per_patch, (i + (lower ? b[1] + b[2] : b[1])) / side_,
            (j + (lower ? b[2] : b[1] + b[2])) / side_};
}

FootPoint SurfaceLocator::closest(const Vec3& p) const
{
    return walk_.descend(p, place(tree_.query(p).where));
}

std::optional<FootPoint> SurfaceLocator::closest_within(const Vec3& p, double limit) const
{
    const ClosestPoint::Hit hit = tree_.query(p, limit);
    if (hit.where.face == invalid_index)
        return std::nullopt;
    return walk_.descend(p, place(hit.where));
}

} // namespace bot2nurbs
