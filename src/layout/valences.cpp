// SPDX-License-Identifier: MIT
#include "layout/valences.h"

namespace bot2nurbs {

namespace {

// What one unit of (valence - wanted)^2 costs against the energy of a patch (a square of the wanted
// size has 1).
constexpr double valence_weight = 0.35;
// At the boundary, where the angle cannot be shared out differently, it costs more.
constexpr double boundary_weight = 0.7;
// Where a person asked for a valence it is to be met unless that distorts badly.
constexpr double asked_weight = 2.0;
// Largest valence a change may make in K: the masks grow fast beyond. In K_tri a vertex has half as
// many edges again.
constexpr int max_quad_valence = 6;
constexpr int max_triangle_valence = 9;
// Boundary vertices with corners that are nearly flat or more are worth this much to remove, so
// that it is done by whatever change distorts least, and they are made only where all else is
// worse.
constexpr double degenerate_cost = 10.0;
// Those that splines do not exist at are made nowhere: of degree two inside, and at the ends of
// darts, where the boundary turns back and both its sides become one crease inside.
constexpr double forbidden_cost = 1e6;
// Right angles from which a boundary vertex is the end of a dart.
constexpr double dart_end = 3.5;
// Corners wider than this many right angles count as flat.
constexpr double flat_corner = 1.7;

} // namespace

Valences::Valences(const PatchComplex& complex, Index sides)
    : sides_(sides), asked_(complex.wanted()),
      most_(sides == 3 ? max_triangle_valence : max_quad_valence),
      count_(complex.mesh().vertex_count(), 0), angle_(complex.mesh().vertex_count(), 0.0)
{
    constexpr double pi = 3.14159265358979323846;
    const double unit = sides == 3 ? pi / 3.0 : pi / 2.0;
    for (const auto& p : complex.paths())
        if (p.alive)
            ++count_[p.geometry.a], ++count_[p.geometry.b];
    for (Index v = 0; v < count_.size(); ++v)
        if (count_[v] > 0 && complex.mesh().is_boundary_vertex(v))
            angle_[v] = std::max(complex.boundary_angle(v) / unit, 0.5);
}

void Valences::move(Index from, Index to)
{
    if (from == to)
        return;
    count_[to] = count_[from];
    count_[from] = 0;
}

bool Valences::is_degenerate(Index vertex, int by) const
{
    const int edges = count_[vertex] + by;
    if (is_inside(vertex))
        return sides_ == 4 && edges == 2;
    const double flat = sides_ == 4 ? flat_corner : 1.5 * flat_corner;
    return count_[vertex] > 0 && angle_[vertex] > flat * (static_cast<double>(edges) - 1.0);
}

double Valences::cost(Index vertex, int edges) const
{
    if (is_degenerate(vertex, edges - count_[vertex])) {
        const double turn = sides_ == 4 ? dart_end : 1.5 * dart_end;
        return is_inside(vertex) || angle_[vertex] > turn ? forbidden_cost : degenerate_cost;
    }
    const double d = static_cast<double>(edges) - wanted(vertex);
    if (asked_.count(vertex) != 0)
        return asked_weight * d * d;
    return (is_inside(vertex) ? valence_weight : boundary_weight) * d * d;
}

} // namespace bot2nurbs
