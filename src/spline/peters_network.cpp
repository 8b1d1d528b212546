// SPDX-License-Identifier: MIT
#include "spline/control_net.h"
#include "spline/schemes.h"

#include <map>
#include <tuple>

namespace bot2nurbs {

namespace {

class PetersAssembly : ControlNet {
public:
    explicit PetersAssembly(const QuadComplex& complex) : ControlNet(complex) {}
    void build(const std::vector<Fan>& fans, SplineNetwork& network);

private:
    void apply_mask(const Fan& fan, const PetersMask& mask, std::vector<Signed> columns);
};

void PetersAssembly::apply_mask(const Fan& fan, const PetersMask& mask, std::vector<Signed> columns)
{
    const Index k = fan.sector_count();
    if (!mask.twist.empty()) {
        columns.resize(mask.vertex_columns + 2 * std::size_t(fan.edge_count()));
        for (Index i = 0; i < fan.edge_count(); ++i) {
            const Index e = fan_edge(fan, i);
            Signed* at = &columns[mask.edge_column(i, 0)];
            if (complex_.is_sharp(e)) {
                const Index row =
                    side_[4 * std::size_t(e) + (end_at(e, fan.vertex) % 2 == 0 ? 1 : 2)];
                at[0].unknown = unknown_of(row);
            } else {
                at[0].unknown = control_unknown(fan.sectors[i], 1, 0);
                at[1].unknown = control_unknown(fan.sectors[(i + k - 1) % k], 0, 1);
            }
        }
    }
    if (apex_[fan.vertex] == invalid_index)
        apex_[fan.vertex] = mask_row(mask.apex, columns);
    for (Index i = 0; i < k; ++i) {
        const Index h = fan.sectors[i];
        control(h, 0, 0) = mask_row(mask.leg[i], columns);
        if (!mask.twist.empty())
            twist_[h] = mask_row(mask.twist[i], columns);
    }
}

void PetersAssembly::build(const std::vector<Fan>& fans, SplineNetwork& network)
{
    for (Index q = 0; q < complex_.quad_count(); ++q) {
        for (Index i = 0; i < 16; ++i) {
            const bool corner = (i / 4) % 3 == 0 && (i % 4) % 3 == 0;
            if (!corner)
                control_[16 * std::size_t(q) + i] = new_unit_row(true);
        }
    }
    for (Index e = 0; e < complex_.edge_count(); ++e) {
        if (!complex_.is_sharp(e))
            continue;
        for (Index a : {1u, 2u})
            side_[4 * std::size_t(e) + a] = new_unit_row(true);
    }
    add_vertex_unknowns(fans, peters_vertex_columns);

    std::map<std::tuple<FanKind, Index, double>, PetersMask> masks;
    for (std::size_t f = 0; f < fans.size(); ++f) {
        const Fan& fan = fans[f];
        const auto [it, fresh] =
            masks.try_emplace({fan.kind, fan.sector_count(), fan.alpha}, PetersMask{});
        if (fresh)
            it->second = peters_mask(fan.kind, fan.sector_count(), fan.alpha);
        apply_mask(fan, it->second, fan_columns_[f]);
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
    add_patches(network);
}

} // namespace

void build_peters(const QuadComplex& complex, const std::vector<Fan>& fans, SplineNetwork& network)
{
    PetersAssembly(complex).build(fans, network);
}

} // namespace bot2nurbs
