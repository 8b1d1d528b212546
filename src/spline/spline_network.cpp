// SPDX-License-Identifier: MIT
#include "bot2nurbs/spline_network.h"

#include "spline/fans.h"
#include "spline/patch_grid.h"
#include "spline/sparse_row.h"
#include "spline/vertex_masks.h"

#include <algorithm>
#include <map>
#include <string>
#include <tuple>

namespace bot2nurbs {

namespace {

//! Assembles the stencils of a network from masks around vertices.
//!
//! Away from the corners a patch is the clamped quadratic tensor spline of 6 x 6 controls: the 4 x
//! 4 controls of the quad, a border row per side that both neighbours share, and the vertex
//! positions. Everything that two patches share (vertex positions, the 13 coefficients of an edge)
//! is made once, in the pool, and copied.
class NetworkAssembly {
public:
    explicit NetworkAssembly(const QuadComplex& complex)
        : complex_(complex), control_(16 * std::size_t(complex.quad_count()), invalid_index),
          apex_(complex.vertex_count(), invalid_index),
          side_(4 * std::size_t(complex.edge_count()), invalid_index),
          edge_end_(2 * std::size_t(complex.edge_count()), invalid_index),
          twist_(complex.halfedge_count(), invalid_index),
          corner_piece_(complex.halfedge_count(), invalid_index)
    {
    }

    void build_peters(const std::vector<Fan>& fans, SplineNetwork& network);
    void build_eck_hoppe(const std::vector<Fan>& fans, SplineNetwork& network);

private:
    //! A vertex unknown as a fan sees it: an opposite tangent is minus the unknown.
    struct Signed {
        Index unknown = invalid_index;
        double sign = 1.0;
    };

    Index new_unknown(bool point)
    {
        is_point_.push_back(point);
        return static_cast<Index>(is_point_.size() - 1);
    }
    //! A pool row that is one unknown.
    Index unit_row(Index unknown)
    {
        sum_.add(1.0, unknown);
        return sum_.append_to(pool_);
    }
    //! Pool row of the control (along, depth) of a quad as seen from its corner at halfedge h.
    Index& control(Index h, Index along, Index depth)
    {
        const auto [a, b] = from_side(QuadComplex::side_of(h), along, depth, 3);
        return control_[16 * std::size_t(QuadComplex::quad_of(h)) + 4 * a + b];
    }
    //! The unknown of a control that is one.
    Index control_unknown(Index h, Index along, Index depth)
    {
        return pool_.column[pool_.offset[control(h, along, depth)]];
    }
    //! Pool row of side control a of an edge, a counted from the start of h.
    Index& side(Index h, Index a)
    {
        const Index e = complex_.edge(h);
        return side_[4 * std::size_t(e) + (complex_.halfedge_of_edge(e) == h ? a : 3 - a)];
    }
    //! Whether the start of h is the end (1) or the start (0) of its edge.
    Index end_of(Index h) const { return complex_.halfedge_of_edge(complex_.edge(h)) == h ? 0 : 1; }

    Index pool_row(const MaskRow& mask, const std::vector<Signed>& columns)
    {
        for (std::size_t i = 0; i < mask.size(); ++i) {
            if (mask[i] != 0.0)
                sum_.add(mask[i] * columns[i].sign, columns[i].unknown);
        }
        return sum_.append_to(pool_);
    }

    void add_vertex_unknowns(const std::vector<Fan>& fans, std::size_t begin, std::size_t end);
    void apply_peters_mask(const Fan& fan, const PetersMask& mask, std::vector<Signed> columns);
    void apply_eck_hoppe_mask(const Fan& fan, const EckHoppeMask& mask);
    void add_even_constraint(const Fan& fan, SparseRows& constraints);
    void add_smooth_sides();
    void add_edges();
    void add_patch(Index quad, SparseRows& stencils);
    void finish(SplineNetwork& network);

    const QuadComplex& complex_;
    std::vector<char> is_point_;
    SparseRows pool_;
    RowSum sum_;
    std::vector<Index> control_; //!< 16 pool rows per quad.
    std::vector<Index> apex_;    //!< Pool row of the position of each vertex.
    std::vector<Index> side_;    //!< Four pool rows per edge: its border controls.
    //! Per edge end: first of two pool rows that replace Bezier coefficients 1 and 2, or none.
    std::vector<Index> edge_end_;
    std::vector<Index> edge_rows_; //!< Per edge: first of its 13 pool rows.
    std::vector<Index> twist_;     //!< Per sector: pool row added to coefficient (1, 1), or none.
    //! Per sector: first of the pool rows replacing (1, 1), (2, 1), (1, 2), (2, 2), or none.
    std::vector<Index> corner_piece_;
    //! Per edge end of a sharp edge: its tangent there.
    std::vector<Signed> tangent_;
    std::vector<std::vector<Signed>> fan_columns_; //!< Vertex columns of each fan.
};

//! The domain edge that is edge i of a fan.
Index fan_edge(const QuadComplex& k, const Fan& fan, Index i)
{
    // The last edge of an open fan is a side of its last quad that arrives at the vertex.
    return k.edge(i < fan.sector_count() ? fan.sectors[i] : QuadComplex::prev(fan.sectors.back()));
}

void NetworkAssembly::add_vertex_unknowns(const std::vector<Fan>& fans, std::size_t begin,
                                          std::size_t end)
{
    // Unknowns that all fans of the vertex share are made by the first fan that needs them.
    Signed position;
    const auto tangent_at = [&](const Fan& fan, Index edge_number) -> Signed& {
        const Index e = fan_edge(complex_, fan, edge_number);
        const bool starts_here = complex_.from(complex_.halfedge_of_edge(e)) == fan.vertex;
        return tangent_[2 * std::size_t(e) + (starts_here ? 0 : 1)];
    };
    for (std::size_t f = begin; f < end; ++f) {
        const Fan& fan = fans[f];
        const Index k = fan.sector_count();
        if (fan.kind != FanKind::closed) {
            if (position.unknown == invalid_index)
                position.unknown = new_unknown(true);
            Signed &first = tangent_at(fan, 0), &last = tangent_at(fan, k);
            if (first.unknown == invalid_index) {
                first = fan.kind == FanKind::smooth && last.unknown != invalid_index
                            ? Signed{last.unknown, -last.sign}
                            : Signed{new_unknown(false)};
            }
            if (last.unknown == invalid_index) { // a dart's last edge is its first
                last = fan.kind == FanKind::smooth ? Signed{first.unknown, -first.sign}
                                                   : Signed{new_unknown(false)};
            }
        }
        std::vector<Signed>& columns = fan_columns_[f];
        for (VertexColumn column : peters_vertex_columns(fan.kind, k)) {
            switch (column) {
            case VertexColumn::position:
                if (position.unknown == invalid_index)
                    position.unknown = new_unknown(true);
                columns.push_back(position);
                break;
            case VertexColumn::first_tangent: columns.push_back(tangent_at(fan, 0)); break;
            case VertexColumn::last_tangent: columns.push_back(tangent_at(fan, k)); break;
            case VertexColumn::control: columns.push_back({new_unknown(true)}); break;
            case VertexColumn::plane_u:
            case VertexColumn::plane_v:
            case VertexColumn::shear: columns.push_back({new_unknown(false)}); break;
            }
        }
    }
}

void NetworkAssembly::apply_peters_mask(const Fan& fan, const PetersMask& mask,
                                        std::vector<Signed> columns)
{
    const Index k = fan.sector_count();
    if (!mask.twist.empty()) {
        columns.resize(mask.vertex_columns + 2 * std::size_t(fan.edge_count()));
        for (Index i = 0; i < fan.edge_count(); ++i) {
            const Index e = fan_edge(complex_, fan, i);
            Signed* at = &columns[mask.edge_column(i, 0)];
            if (complex_.is_sharp(e)) {
                const bool starts_here = complex_.from(complex_.halfedge_of_edge(e)) == fan.vertex;
                const Index row = side_[4 * std::size_t(e) + (starts_here ? 1 : 2)];
                at[0].unknown = pool_.column[pool_.offset[row]];
            } else {
                at[0].unknown = control_unknown(fan.sectors[i], 1, 0);
                at[1].unknown = control_unknown(fan.sectors[(i + k - 1) % k], 0, 1);
            }
        }
    }
    if (apex_[fan.vertex] == invalid_index)
        apex_[fan.vertex] = pool_row(mask.apex, columns);
    for (Index i = 0; i < k; ++i) {
        const Index h = fan.sectors[i];
        control(h, 0, 0) = pool_row(mask.leg[i], columns);
        if (!mask.twist.empty())
            twist_[h] = pool_row(mask.twist[i], columns);
    }
}

void NetworkAssembly::add_even_constraint(const Fan& fan, SparseRows& constraints)
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

void NetworkAssembly::build_peters(const std::vector<Fan>& fans, SplineNetwork& network)
{
    for (Index q = 0; q < complex_.quad_count(); ++q) {
        for (Index i = 0; i < 16; ++i) {
            const bool corner = (i / 4) % 3 == 0 && (i % 4) % 3 == 0;
            if (!corner)
                control_[16 * std::size_t(q) + i] = unit_row(new_unknown(true));
        }
    }
    for (Index e = 0; e < complex_.edge_count(); ++e) {
        if (!complex_.is_sharp(e))
            continue;
        for (Index a : {1u, 2u})
            side_[4 * std::size_t(e) + a] = unit_row(new_unknown(true));
    }
    tangent_.resize(2 * std::size_t(complex_.edge_count()));
    fan_columns_.resize(fans.size());
    for (std::size_t begin = 0, end = 0; begin < fans.size(); begin = end) {
        while (end < fans.size() && fans[end].vertex == fans[begin].vertex)
            ++end;
        add_vertex_unknowns(fans, begin, end);
    }

    std::map<std::tuple<FanKind, Index, double>, PetersMask> masks;
    for (std::size_t f = 0; f < fans.size(); ++f) {
        const Fan& fan = fans[f];
        const auto [it, fresh] =
            masks.try_emplace({fan.kind, fan.sector_count(), fan.alpha}, PetersMask{});
        if (fresh)
            it->second = peters_mask(fan.kind, fan.sector_count(), fan.alpha);
        apply_peters_mask(fan, it->second, fan_columns_[f]);
        add_even_constraint(fan, network.constraints);
    }
    for (Index e = 0; e < complex_.edge_count(); ++e) {
        if (!complex_.is_sharp(e))
            continue;
        const Index h = complex_.halfedge_of_edge(e);
        for (Index end : {0u, 1u}) {
            const Signed& t = tangent_[2 * std::size_t(e) + end];
            sum_.add(1.0, pool_, apex_[end == 0 ? complex_.from(h) : complex_.to(h)]);
            sum_.add(t.sign, t.unknown);
            side_[4 * std::size_t(e) + 3 * end] = sum_.append_to(pool_);
        }
    }
    finish(network);
}

void NetworkAssembly::apply_eck_hoppe_mask(const Fan& fan, const EckHoppeMask& mask)
{
    const Index n = fan.sector_count();
    std::vector<Signed> columns(4 * std::size_t(n));
    for (Index i = 0; i < n; ++i) {
        const Index h = fan.sectors[i];
        columns[4 * i].unknown = control_unknown(h, 0, 0);
        columns[4 * i + 1].unknown = control_unknown(h, 1, 0);
        columns[4 * i + 2].unknown = control_unknown(fan.sectors[(i + n - 1) % n], 0, 1);
        columns[4 * i + 3].unknown = control_unknown(h, 1, 1);
    }
    apex_[fan.vertex] = pool_row(mask.apex, columns);
    if (n == 4)
        return; // regular: the quadratic spline is smooth as it is
    for (Index i = 0; i < n; ++i) {
        const Index h = fan.sectors[i];
        const Index rows = pool_row(mask.edge1[i], columns);
        pool_row(mask.edge2[i], columns);
        edge_end_[2 * std::size_t(complex_.edge(h)) + end_of(h)] = rows;
        corner_piece_[h] = pool_row(mask.b11[i], columns);
        for (const auto* part : {&mask.b21, &mask.b12, &mask.b22})
            pool_row((*part)[i], columns);
    }
}

void NetworkAssembly::build_eck_hoppe(const std::vector<Fan>& fans, SplineNetwork& network)
{
    for (std::size_t i = 0; i < control_.size(); ++i)
        control_[i] = unit_row(new_unknown(true));
    std::map<Index, EckHoppeMask> masks;
    for (const Fan& fan : fans) {
        const auto [it, fresh] = masks.try_emplace(fan.sector_count(), EckHoppeMask{});
        if (fresh)
            it->second = eck_hoppe_mask(fan.sector_count());
        apply_eck_hoppe_mask(fan, it->second);
        add_even_constraint(fan, network.constraints);
    }
    finish(network);
}

void NetworkAssembly::add_smooth_sides()
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

void NetworkAssembly::add_edges()
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

void NetworkAssembly::add_patch(Index quad, SparseRows& stencils)
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

void NetworkAssembly::finish(SplineNetwork& network)
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
    network.unknown_count = static_cast<Index>(is_point_.size());
    network.is_point = std::move(is_point_);
}

//! Why the masks of Eck and Hoppe do not cover a domain, if they do not.
Status eck_hoppe_refusal(const std::vector<Fan>& fans)
{
    for (const Fan& fan : fans) {
        if (fan.kind != FanKind::closed) {
            return Error{ErrorCode::invalid_domain,
                         "the scheme eck-hoppe covers closed smooth domains only, but vertex " +
                             std::to_string(fan.vertex) +
                             " lies on a boundary or crease; use the scheme peters",
                         fan.vertex};
        }
    }
    return {};
}

} // namespace

Result<SplineNetwork> build_spline_network(const QuadComplex& complex, SplineScheme scheme)
{
    auto fans = find_fans(complex);
    if (!fans)
        return fans.error();
    SplineNetwork network;
    network.scheme = scheme;
    network.complex = complex;
    network.c1_inside = scheme == SplineScheme::peters;
    NetworkAssembly assembly(complex);
    if (scheme == SplineScheme::eck_hoppe) {
        if (Status refused = eck_hoppe_refusal(*fans))
            return *refused;
        assembly.build_eck_hoppe(*fans, network);
    } else {
        assembly.build_peters(*fans, network);
    }
    return network;
}

} // namespace bot2nurbs
