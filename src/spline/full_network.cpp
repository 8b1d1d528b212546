// SPDX-License-Identifier: MIT
#include "spline/full_assembly.h"
#include "spline/schemes.h"

namespace bot2nurbs {

FullAssembly::FullAssembly(const QuadComplex& complex)
    : NetworkAssembly(complex), leg_(2 * std::size_t(complex.edge_count()), invalid_index),
      ring_(leg_), twist_(complex.halfedge_count(), invalid_index),
      curve_unknowns_(2 * std::size_t(complex.edge_count())), first_row_(complex.halfedge_count())
{
}

const FullMask& FullAssembly::mask_of(const Fan& fan)
{
    const auto [it, fresh] =
        masks_.try_emplace({fan.kind, fan.sector_count(), fan.alpha}, FullMask{});
    if (fresh)
        it->second = full_mask(fan.kind, fan.sector_count(), fan.alpha);
    return it->second;
}

void FullAssembly::apply_mask(std::size_t fan_number, const Fan& fan)
{
    const FullMask& mask = mask_of(fan);
    std::vector<Signed>& columns = fan_columns_[fan_number];
    for (const Index column : mask.ring_column)
        if (column != invalid_index)
            columns.push_back({new_unknown(true)});
    if (apex_[fan.vertex] == invalid_index)
        apex_[fan.vertex] = mask_row(mask.apex, columns);
    for (Index i = 0; i < fan.edge_count(); ++i) {
        const Index end = end_at(fan_edge(fan, i), fan.vertex);
        if (leg_[end] == invalid_index) // a crease is seen by two fans, by a dart twice
            leg_[end] = mask_row(mask.leg[i], columns);
        if (!mask.ring[i].empty())
            ring_[end] = mask_row(mask.ring[i], columns);
    }
    for (Index i = 0; i < fan.sector_count(); ++i)
        twist_[fan.sectors[i]] = mask_row(mask.twist[i], columns);
}

void FullAssembly::add_edges()
{
    for (std::size_t end = 0; end < curve_unknowns_.size(); ++end) {
        const bool free = ring_[end] == invalid_index;
        curve_unknowns_[end] = {free ? new_unknown(true) : invalid_index,
                                free ? new_unknown(true) : invalid_index, new_unknown(true)};
    }
    edge_rows_.resize(complex_.edge_count());
    for (Index e = 0; e < complex_.edge_count(); ++e) {
        edge_rows_[e] = pool_.row_count();
        for (Index j = 0; j < 13; ++j)
            add_edge_row(e, j);
    }
}

void FullAssembly::add_edge_row(Index edge, Index j)
{
    const Index side = j <= 6 ? 0 : 1, end = 2 * edge + side;
    const Index h = complex_.halfedge_of_edge(edge);
    const Index apex = apex_[side == 0 ? complex_.from(h) : complex_.to(h)];
    const auto& [second, fourth, fifth] = curve_unknowns_[end];
    const bool free = ring_[end] == invalid_index;
    switch (side == 0 ? j : 12 - j) {
    case 0: sum_.add(1.0, pool_, apex); break;
    case 1:
        sum_.add(1.0 / 3.0, pool_, apex);
        sum_.add(2.0 / 3.0, pool_, leg_[end]);
        break;
    case 2:
        if (free) {
            sum_.add(1.0, second);
        } else { // the quadratic with controls q0, q1, q2, raised
            sum_.add(2.0 / 3.0, pool_, leg_[end]);
            sum_.add(1.0 / 3.0, pool_, ring_[end]);
        }
        break;
    case 3:
        if (free) {
            sum_.add(0.5, second);
            sum_.add(0.5, fourth);
        } else {
            sum_.add(1.0, pool_, ring_[end]);
        }
        break;
    case 4:
        if (free) {
            sum_.add(1.0, fourth);
        } else { // C1 with the quadratic
            sum_.add(5.0 / 3.0, pool_, ring_[end]);
            sum_.add(-2.0 / 3.0, pool_, leg_[end]);
        }
        break;
    case 5: sum_.add(1.0, fifth); break;
    default: sum_.add(0.5, fifth); sum_.add(0.5, curve_unknowns_[end ^ 1u][2]);
    }
    sum_.append_to(pool_);
}

void FullAssembly::add_first_rows()
{
    for (Index e = 0; e < complex_.edge_count(); ++e) {
        const Index h = complex_.halfedge_of_edge(e), g = complex_.twin(h);
        const bool sharp = complex_.is_sharp(e);
        for (Index& unknown : first_row_[h])
            unknown = new_unknown(sharp);
        if (g == invalid_index)
            continue;
        for (std::size_t k = 0; k < own_indices.size(); ++k)
            first_row_[g][k] = sharp ? new_unknown(true) : first_row_[h][5 - k];
    }
}

void FullAssembly::add_patch(Index quad, SparseRows& stencils)
{
    std::array<Index, 169> row;
    row.fill(invalid_index);
    for (Index s = 0; s < 4; ++s) {
        const Index h = 4 * quad + s, e = complex_.edge(h);
        const bool forward = complex_.halfedge_of_edge(e) == h, sharp = complex_.is_sharp(e);
        const auto at = [&](Index along, Index depth) -> Index& {
            const auto [i, j] = from_side(s, along, depth, 12);
            return row[13 * i + j];
        };
        for (Index j = 0; j < 13; ++j)
            at(j, 0) = edge_rows_[e] + (forward ? j : 12 - j);
        at(1, 1) = twist_[h];
        for (std::size_t k = 0; k < own_indices.size(); ++k) {
            if (!sharp)
                sum_.add(1.0, pool_, at(own_indices[k], 0));
            sum_.add(sharp || forward ? 1.0 : -1.0, first_row_[h][k]);
            at(own_indices[k], 1) = sum_.append_to(pool_);
        }
    }
    Index inner = interior_[quad];
    for (const Index i : own_indices)
        for (const Index j : own_indices) {
            sum_.add(1.0, inner++);
            row[13 * i + j] = sum_.append_to(pool_);
        }
    // C1 at the inner knots, first in one direction, then in the other.
    const auto fill = [&](Index i, Index j, Index step) {
        sum_.add(0.5, pool_, row[13 * i + j - step]);
        sum_.add(0.5, pool_, row[13 * i + j + step]);
        row[13 * i + j] = sum_.append_to(pool_);
    };
    for (const Index i : {3u, 6u, 9u})
        for (Index j = 1; j < 12; ++j)
            if (j % 3 != 0)
                fill(i, j, 13);
    for (Index i = 1; i < 12; ++i)
        for (const Index j : {3u, 6u, 9u})
            fill(i, j, 1);
    for (const Index r : row)
        append_copy(stencils, pool_, r);
}

void FullAssembly::build(const std::vector<Fan>& fans, SplineNetwork& network)
{
    add_vertex_unknowns(fans, full_vertex_columns);
    for (std::size_t f = 0; f < fans.size(); ++f)
        apply_mask(f, fans[f]);
    add_edges();
    add_first_rows();
    for (Index q = 0; q < complex_.quad_count(); ++q) {
        interior_.push_back(static_cast<Index>(is_point_.size()));
        for (int k = 0; k < 36; ++k)
            new_unknown(true);
    }
    for (Index q = 0; q < complex_.quad_count(); ++q)
        add_patch(q, network.stencils);

    recovery_row_.assign(is_point_.size(), invalid_index);
    recover_vertices(fans);
    recover_edges();
    recover_patches();
    finish_recovery(network);
    finish(network);
}

void build_full(const QuadComplex& complex, const std::vector<Fan>& fans, SplineNetwork& network)
{
    FullAssembly(complex).build(fans, network);
}

} // namespace bot2nurbs
