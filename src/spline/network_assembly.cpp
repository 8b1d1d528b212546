// SPDX-License-Identifier: MIT
#include "spline/network_assembly.h"

namespace bot2nurbs {

NetworkAssembly::NetworkAssembly(const QuadComplex& complex)
    : complex_(complex), apex_(complex.vertex_count(), invalid_index)
{
}

Index NetworkAssembly::new_unknown(bool point)
{
    is_point_.push_back(point);
    return static_cast<Index>(is_point_.size() - 1);
}

Index NetworkAssembly::new_unit_row(bool point)
{
    sum_.add(1.0, new_unknown(point));
    return sum_.append_to(pool_);
}

Index NetworkAssembly::mask_row(const MaskRow& mask, const std::vector<Signed>& columns)
{
    for (std::size_t i = 0; i < mask.size(); ++i) {
        if (mask[i] != 0.0)
            sum_.add(mask[i] * columns[i].sign, columns[i].unknown);
    }
    return sum_.append_to(pool_);
}

Index NetworkAssembly::fan_edge(const Fan& fan, Index i) const
{
    // The last edge of an open fan is a side of its last quad that arrives at the vertex.
    return complex_.edge(i < fan.sector_count() ? fan.sectors[i]
                                                : QuadComplex::prev(fan.sectors.back()));
}

Index NetworkAssembly::end_at(Index edge, Index vertex) const
{
    return 2 * edge + (complex_.from(complex_.halfedge_of_edge(edge)) == vertex ? 0 : 1);
}

void NetworkAssembly::add_vertex_unknowns(const std::vector<Fan>& fans, VertexColumns columns)
{
    tangent_.resize(2 * std::size_t(complex_.edge_count()));
    fan_columns_.resize(fans.size());
    for (std::size_t begin = 0, end = 0; begin < fans.size(); begin = end) {
        while (end < fans.size() && fans[end].vertex == fans[begin].vertex)
            ++end;
        add_fans_of_vertex(fans, begin, end, columns);
    }
}

void NetworkAssembly::add_fans_of_vertex(const std::vector<Fan>& fans, std::size_t begin,
                                         std::size_t end, VertexColumns columns_of)
{
    // Unknowns that all fans of the vertex share are made by the first fan that needs them.
    Signed position;
    const auto tangent_at = [&](const Fan& fan, Index edge_number) -> Signed& {
        return tangent_[end_at(fan_edge(fan, edge_number), fan.vertex)];
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
        for (VertexColumn column : columns_of(fan.kind, k)) {
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
            case VertexColumn::shear:
            case VertexColumn::twist: columns.push_back({new_unknown(false)}); break;
            }
        }
    }
}

void NetworkAssembly::finish(SplineNetwork& network)
{
    network.unknown_count = static_cast<Index>(is_point_.size());
    network.is_point = std::move(is_point_);
}

} // namespace bot2nurbs
