// SPDX-License-Identifier: MIT
#include "core/parallel.h"
#include "fit/fit_loop.h"

#include <algorithm>

namespace bot2nurbs {

namespace {

//! Gaps are cells without samples, 3 x 3 of a Bezier piece: as many as SampleOptions makes.
constexpr Index side = 12;
constexpr Index cells_per_quad = side * side;
//! Places that are so many times farther away than any sample are not what the surface strays from.
constexpr double most_share = 3.0;
constexpr std::size_t chunk_gaps = 64;

std::size_t cell_of(const DomainPoint& d)
{
    const auto along = [](double x) { return std::min(side - 1, static_cast<Index>(side * x)); };
    return static_cast<std::size_t>(cells_per_quad) * d.quad + side * along(d.u) + along(d.v);
}

DomainPoint middle_of(std::size_t cell)
{
    const auto k = static_cast<Index>(cell % cells_per_quad);
    return {static_cast<Index>(cell / cells_per_quad), (k / side + 0.5) / side,
            (k % side + 0.5) / side};
}

//! What samples of a quad are like.
struct Typical {
    double weight = 0.0, row_weight = 0.0; //!< Sums.
    double count = 0.0;
    char in_plane = 0;
};

} // namespace

Status FitLoop::fill_gaps(State& state)
{
    if (!nearest)
        return std::nullopt;
    const Index quads = network_.complex.quad_count();
    std::vector<char> filled(static_cast<std::size_t>(cells_per_quad) * quads, 0);
    std::vector<Typical> typical(quads);
    for (std::size_t i = 0; i < where.size(); ++i) {
        filled[cell_of(where[i])] = 1;
        Typical& t = typical[where[i].quad];
        t.weight += weights[i];
        t.row_weight += row_weights_[i];
        t.count += 1.0;
        t.in_plane |= in_plane_[i];
    }
    std::vector<FootPoint> gaps;
    for (std::size_t c = 0; c < filled.size(); ++c)
        if (!filled[c] && typical[c / cells_per_quad].count > 0.0)
            gaps.push_back({middle_of(c), {}, 0.0});
    std::vector<std::optional<NearPlace>> places(gaps.size());
    if (!for_each_chunk(context_, gaps.size(), chunk_gaps, [&](std::size_t begin, std::size_t end) {
            for (std::size_t g = begin; g < end; ++g) {
                const SurfacePoint s = state.surface.evaluate(gaps[g].where);
                gaps[g].surface = s;
                places[g] = nearest(s.position, normalized(cross(s.du, s.dv)));
                if (places[g])
                    gaps[g].distance = norm(s.position - places[g]->position);
            }
        }))
        return Context::cancelled_error("fit");
    double most = 0.0;
    for (const FootPoint& foot : state.feet)
        most = std::max(most, most_share * foot.distance);
    for (std::size_t g = 0; g < gaps.size(); ++g) {
        if (!places[g] || gaps[g].distance > most)
            continue;
        const Typical& t = typical[gaps[g].where.quad];
        points.push_back(places[g]->position);
        weights.push_back(t.weight / t.count);
        row_weights_.push_back(t.row_weight / t.count);
        in_plane_.push_back(t.in_plane);
        if (!normals.empty())
            normals.push_back(places[g]->normal);
        if (!on_curve.empty())
            on_curve.push_back(0);
        where.push_back(gaps[g].where);
        state.feet.push_back(gaps[g]);
    }
    return std::nullopt;
}

} // namespace bot2nurbs
