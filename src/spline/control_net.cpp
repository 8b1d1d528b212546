// SPDX-License-Identifier: MIT
#include "spline/control_net.h"

#include <array>

namespace bot2nurbs {

ControlNet::ControlNet(const QuadComplex& complex)
    : NetworkAssembly(complex), control_(16 * std::size_t(complex.quad_count()), invalid_index),
      side_(4 * std::size_t(complex.edge_count()), invalid_index),
      edge_end_(2 * std::size_t(complex.edge_count()), invalid_index),
      twist_(complex.halfedge_count(), invalid_index),
      corner_piece_(complex.halfedge_count(), invalid_index)
{
}

Index& ControlNet::control(Index h, Index along, Index depth)
{
    const auto [a, b] = from_side(QuadComplex::side_of(h), along, depth, 3);
    return control_[16 * std::size_t(QuadComplex::quad_of(h)) + 4 * a + b];
}

Index& ControlNet::side(Index h, Index a)
{
    const Index e = complex_.edge(h);
    return side_[4 * std::size_t(e) + (complex_.halfedge_of_edge(e) == h ? a : 3 - a)];
}

void ControlNet::add_even_constraint(const Fan& fan, SparseRows& constraints)
{
    const Index n = fan.sector_count();
    if (fan.kind != FanKind::closed || n % 2 != 0 || n == 4)
        return;
    for (Index i = 0; i < n; ++i) {
        const double sign = i % 2 == 0 ? 1.0 : -1.0;
        sum_.add(sign, control_unknown(fan.sectors[i], 1, 0));
        sum_.add(sign, control_unknown(fan.sectors[(i + n - 1) % n], 0, 1));
    }
    sum_.append_to(constraints);
}

void ControlNet::add_smooth_sides()
{
    for (Index e = 0; e < complex_.edge_count(); ++e) {
        if (complex_.is_sharp(e))
            continue;
        const Index h = complex_.halfedge_of_edge(e), g = complex_.twin(h);
        for (Index a = 0; a < 4; ++a) {
            sum_.add(0.5, pool_, control(h, a, 0));
            sum_.add(0.5, pool_, control(g, 3 - a, 0));
            side(h, a) = sum_.append_to(pool_);
        }
    }
}

void ControlNet::add_edges()
{
    edge_rows_.resize(complex_.edge_count());
    for (Index e = 0; e < complex_.edge_count(); ++e) {
        const Index h = complex_.halfedge_of_edge(e);
        std::array<Index, 6> net{};
        net[0] = apex_[complex_.from(h)];
        net[5] = apex_[complex_.to(h)];
        for (Index a = 0; a < 4; ++a)
            net[a + 1] = side_[4 * std::size_t(e) + a];
        edge_rows_[e] = pool_.row_count();
        for (Index j = 0; j < 13; ++j) {
            // Coefficients 1 and 2 counted from either end may have masks of their own.
            const Index end = j < 6 ? 0 : 1, from_end = end == 0 ? j : 12 - j;
            const Index own = edge_end_[2 * std::size_t(e) + end];
            if (own != invalid_index && (from_end == 1 || from_end == 2)) {
                sum_.add(1.0, pool_, own + from_end - 1);
            } else {
                const ClampedRow& row = clamped_rows[j];
                if (row.weight != 0.0)
                    sum_.add(row.weight, pool_, net[row.first]);
                if (row.next_weight != 0.0)
                    sum_.add(row.next_weight, pool_, net[row.first + 1]);
            }
            sum_.append_to(pool_);
        }
    }
}

void ControlNet::add_patch(Index quad, SparseRows& stencils)
{
    // The 6 x 6 clamped control net, the rows that are copied, and what happens at the corners.
    std::array<Index, 36> net{};
    std::array<Index, 169> ready, extra;
    ready.fill(invalid_index);
    extra.fill(invalid_index);
    for (Index a = 0; a < 4; ++a) {
        for (Index b = 0; b < 4; ++b) {
            net[6 * (a + 1) + b + 1] = control_[16 * std::size_t(quad) + 4 * a + b];
        }
    }
    for (Index s = 0; s < 4; ++s) {
        const Index h = 4 * quad + s, e = complex_.edge(h);
        const auto at = [s](Index along, Index depth) {
            const auto [i, j] = from_side(s, along, depth, 12);
            return 13 * i + j;
        };
        const bool forward = complex_.halfedge_of_edge(e) == h;
        for (Index j = 0; j < 13; ++j)
            ready[at(j, 0)] = edge_rows_[e] + (forward ? j : 12 - j);
        for (Index a = 0; a < 4; ++a) {
            const auto [i, j] = from_side(s, a + 1, 0, 5);
            net[6 * i + j] = side(h, a);
        }
        extra[at(1, 1)] = twist_[h];
        if (corner_piece_[h] != invalid_index) {
            ready[at(1, 1)] = corner_piece_[h];
            ready[at(2, 1)] = corner_piece_[h] + 1;
            ready[at(1, 2)] = corner_piece_[h] + 2;
            ready[at(2, 2)] = corner_piece_[h] + 3;
        }
        const auto [i, j] = from_side(s, 0, 0, 5);
        net[6 * i + j] = apex_[complex_.from(h)];
    }
    for (Index i = 0; i < 13; ++i) {
        for (Index j = 0; j < 13; ++j) {
            const Index place = 13 * i + j;
            if (ready[place] != invalid_index) {
                append_copy(stencils, pool_, ready[place]);
                continue;
            }
            const ClampedRow &ri = clamped_rows[i], &rj = clamped_rows[j];
            for (Index a = 0; a < 2; ++a) {
                for (Index b = 0; b < 2; ++b) {
                    const double w = (a == 0 ? ri.weight : ri.next_weight) *
                                     (b == 0 ? rj.weight : rj.next_weight);
                    sum_.add(w, pool_, net[6 * (ri.first + a) + rj.first + b]);
                }
            }
            if (extra[place] != invalid_index)
                sum_.add(1.0, pool_, extra[place]);
            sum_.append_to(stencils);
        }
    }
}

void ControlNet::add_patches(SplineNetwork& network)
{
    add_smooth_sides();
    add_edges();
    const std::size_t rows = 169 * std::size_t(complex_.quad_count());
    network.stencils.offset.reserve(rows + 1);
    // Four controls make a regular coefficient; corners with their few dozen are rare.
    network.stencils.column.reserve(6 * rows);
    network.stencils.weight.reserve(6 * rows);
    for (Index q = 0; q < complex_.quad_count(); ++q)
        add_patch(q, network.stencils);
    finish(network);
}

} // namespace bot2nurbs
