// SPDX-License-Identifier: MIT
//! How the unknowns of the scheme full follow from the Bezier coefficients of a surface.

#include "spline/full_assembly.h"

#include <cmath>

namespace bot2nurbs {

namespace {

//! Stencil row of the coefficient (along, depth) as seen from the side of h.
Index place(Index h, Index along, Index depth)
{
    const auto [i, j] = from_side(QuadComplex::side_of(h), along, depth, 12);
    return SplineNetwork::row(QuadComplex::quad_of(h), i, j);
}

} // namespace

void FullAssembly::recover(Index unknown, const Terms& terms)
{
    if (recovery_row_[unknown] != invalid_index)
        return; // what several fans see is recovered where it is seen first
    for (const auto& [weight, row] : terms)
        sum_.add(weight, row);
    recovery_row_[unknown] = sum_.append_to(recovered_);
}

void FullAssembly::recover_vertices(const std::vector<Fan>& fans)
{
    for (std::size_t f = 0; f < fans.size(); ++f) {
        const Fan& fan = fans[f];
        const std::vector<Signed>& columns = fan_columns_[f];
        recover(columns[0].unknown, {{1.0, place(fan.sectors[0], 0, 0)}});
        recover_tangents(fan, columns);
        const FullMask& mask = mask_of(fan);
        for (Index i = 0; i < fan.edge_count(); ++i)
            if (mask.ring_column[i] != invalid_index)
                recover(columns[mask.ring_column[i]].unknown, {{1.0, place(fan.sectors[i], 3, 0)}});
        recover_twist(fan, columns);
    }
}

void FullAssembly::recover_tangents(const Fan& fan, const std::vector<Signed>& columns)
{
    const Index k = fan.sector_count();
    const double phi = fan.alpha / k;
    const Index apex = place(fan.sectors[0], 0, 0);
    // The tangent of edge i, times a weight: its first coefficient is two thirds of it away.
    const auto add_tangent = [&](Terms& terms, double weight, Index i) {
        terms.push_back({1.5 * weight, i < k
                                           ? place(fan.sectors[i], 1, 0)
                                           : place(QuadComplex::prev(fan.sectors.back()), 11, 0)});
        terms.push_back({-1.5 * weight, apex});
    };
    if (fan.kind == FanKind::closed) {
        Terms u, v;
        for (Index i = 0; i < k; ++i) {
            add_tangent(u, 2.0 / k * std::cos(i * phi), i);
            add_tangent(v, 2.0 / k * std::sin(i * phi), i);
        }
        recover(columns[1].unknown, u);
        recover(columns[2].unknown, v);
        return;
    }
    Terms first;
    add_tangent(first, columns[1].sign, 0);
    recover(columns[1].unknown, first);
    if (fan.kind == FanKind::corner) {
        Terms last;
        add_tangent(last, columns[2].sign, k);
        recover(columns[2].unknown, last);
        return;
    }
    // t_i = t_0 cos(i phi) + v sin(i phi), for v by least squares.
    double squares = 0.0;
    for (Index i = 1; i < k; ++i)
        squares += std::sin(i * phi) * std::sin(i * phi);
    Terms v;
    for (Index i = 1; i < k; ++i) {
        const double weight = std::sin(i * phi) / squares;
        add_tangent(v, weight, i);
        add_tangent(v, -weight * std::cos(i * phi), 0);
    }
    recover(columns[2].unknown, v);
}

void FullAssembly::recover_twist(const Fan& fan, const std::vector<Signed>& columns)
{
    const FullMask& mask = mask_of(fan);
    if (mask.vertex_columns < 4)
        return;
    if (fan.sector_count() == 1) {
        recover(columns[3].unknown, {{1.0, place(fan.sectors[0], 1, 1)}});
        return;
    }
    // The alternating mean of what the twists are on top of all other unknowns.
    for (Index i = 0; i < fan.sector_count(); ++i) {
        const double weight = alternating(i) / fan.sector_count();
        sum_.add(weight, place(fan.sectors[i], 1, 1));
        for (Index c = 0; c < mask.column_count(); ++c)
            if (c != 3 && mask.twist[i][c] != 0.0)
                sum_.add(-weight * mask.twist[i][c] * columns[c].sign, recovered_,
                         recovery_row_[columns[c].unknown]);
    }
    recovery_row_[columns[3].unknown] = sum_.append_to(recovered_);
}

void FullAssembly::recover_edges()
{
    constexpr Index along[3] = {2, 4, 5};
    for (Index e = 0; e < complex_.edge_count(); ++e) {
        const Index h = complex_.halfedge_of_edge(e), g = complex_.twin(h);
        for (const Index end : {0u, 1u})
            for (int k = 0; k < 3; ++k)
                if (const Index unknown = curve_unknowns_[2 * e + end][k]; unknown != invalid_index)
                    recover(unknown, {{1.0, place(h, end == 0 ? along[k] : 12 - along[k], 0)}});
        for (std::size_t k = 0; k < own_indices.size(); ++k) {
            const Index j = own_indices[k];
            if (!complex_.is_sharp(e)) {
                recover(first_row_[h][k], {{0.5, place(h, j, 1)}, {-0.5, place(g, 12 - j, 1)}});
                continue;
            }
            recover(first_row_[h][k], {{1.0, place(h, j, 1)}});
            if (g != invalid_index)
                recover(first_row_[g][k], {{1.0, place(g, j, 1)}});
        }
    }
}

void FullAssembly::recover_patches()
{
    for (Index q = 0; q < complex_.quad_count(); ++q) {
        Index unknown = interior_[q];
        for (const Index i : own_indices)
            for (const Index j : own_indices)
                recover(unknown++, {{1.0, SplineNetwork::row(q, i, j)}});
    }
}

void FullAssembly::finish_recovery(SplineNetwork& network)
{
    for (const Index row : recovery_row_)
        append_copy(network.recovery, recovered_, row);
}

} // namespace bot2nurbs
