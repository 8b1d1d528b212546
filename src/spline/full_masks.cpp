// SPDX-License-Identifier: MIT
#include "spline/full_masks.h"

#include <cmath>

namespace bot2nurbs {

namespace {

//! Whether edge i of a fan lies between two of its sectors.
bool is_inner(FanKind kind, Index sectors, Index edge)
{
    return kind == FanKind::closed || (edge > 0 && edge < sectors);
}

//! Tangents of all edges: a first harmonic, as the cross derivative law demands at the vertex.
std::vector<MaskRow> tangents(FanKind kind, Index sectors, double alpha, const MaskRow& zero)
{
    const auto unit = [&](Index column, double weight) {
        MaskRow row = zero;
        row[column] = weight;
        return row;
    };
    const Index edges = sectors + (kind == FanKind::closed ? 0 : 1);
    const double phi = alpha / sectors;
    const MaskRow u = unit(1, 1.0);
    MaskRow v = unit(2, 1.0);
    if (kind == FanKind::corner && sectors > 1) {
        v = unit(2, 1.0 / std::sin(alpha));
        v[1] = -std::cos(alpha) / std::sin(alpha);
    }
    std::vector<MaskRow> t(edges, zero);
    for (Index i = 0; i < edges; ++i) {
        if (is_inner(kind, sectors, i)) {
            add(t[i], std::cos(i * phi), u);
            add(t[i], std::sin(i * phi), v);
        }
    }
    if (kind != FanKind::closed) {
        t.front() = u;
        t.back() =
            kind == FanKind::corner ? unit(2, 1.0) : unit(1, kind == FanKind::smooth ? -1.0 : 1.0);
    }
    return t;
}

//! The twists, up to an alternating vector. With x_i = (q0 + 2 q1_i) / 3, the first coefficient of
//! edge i, sector i starts from p_i = x_i + x_(i+1) - q0; on top of that two neighbours must have
//! r_i = 2 x_i - p_i - p_(i-1) + (4 c / 9)(q2_i - q1_i) together.
std::vector<MaskRow> twists(const FullMask& mask, FanKind kind, Index sectors, double c)
{
    const Index edges = static_cast<Index>(mask.leg.size());
    const MaskRow zero(mask.column_count(), 0.0);
    std::vector<MaskRow> x(edges, zero), start(sectors, zero), r(edges, zero);
    for (Index i = 0; i < edges; ++i) {
        add(x[i], 1.0 / 3.0, mask.apex);
        add(x[i], 2.0 / 3.0, mask.leg[i]);
    }
    for (Index i = 0; i < sectors; ++i) {
        add(start[i], 1.0, x[i]);
        add(start[i], 1.0, x[(i + 1) % edges]);
        add(start[i], -1.0, mask.apex);
    }
    for (Index i = 0; i < edges; ++i) {
        if (!is_inner(kind, sectors, i))
            continue;
        add(r[i], 2.0, x[i]);
        add(r[i], -1.0, start[i]);
        add(r[i], -1.0, start[(i + sectors - 1) % sectors]);
        add(r[i], 4.0 * c / 9.0, mask.ring[i]);
        if (c != 0.0)
            add(r[i], -4.0 * c / 9.0, mask.leg[i]);
    }
    std::vector<MaskRow> twist = start;
    const std::vector<double> w = ring_weights(sectors);
    for (Index i = 0; i < sectors; ++i) {
        for (Index l = 0; kind == FanKind::closed && l < sectors; ++l)
            add(twist[i], w[l], r[(i + sectors - l) % sectors]);
        for (Index m = 1; kind != FanKind::closed && m < sectors; ++m)
            add(twist[i], chain_weight(sectors, m, i), r[m]);
    }
    return twist;
}

} // namespace

std::vector<VertexColumn> full_vertex_columns(FanKind kind, Index sectors)
{
    using C = VertexColumn;
    switch (kind) {
    case FanKind::closed:
        if (sectors % 2 == 1)
            return {C::position, C::plane_u, C::plane_v};
        return {C::position, C::plane_u, C::plane_v, C::twist};
    case FanKind::smooth:
    case FanKind::dart: return {C::position, C::first_tangent, C::plane_v, C::twist};
    case FanKind::corner: break;
    }
    // The twist of a single sector is a coefficient of its own.
    return {C::position, C::first_tangent, C::last_tangent, sectors == 1 ? C::control : C::twist};
}

FullMask full_mask(FanKind kind, Index sectors, double alpha)
{
    const bool closed = kind == FanKind::closed;
    const Index edges = closed ? sectors : sectors + 1;
    const double cosine = std::cos(alpha / sectors);
    const double c = sectors == 1 || std::fabs(cosine) < regular_cosine ? 0.0 : cosine;
    FullMask mask;
    mask.vertex_columns = static_cast<Index>(full_vertex_columns(kind, sectors).size());
    // The twists of a closed fan of even n have a solution only if sum_i (-1)^i q2_i = 0.
    const bool eliminates = closed && sectors % 2 == 0 && c != 0.0;
    mask.ring_column.assign(edges, invalid_index);
    Index columns = mask.vertex_columns;
    for (Index i = 0; i < edges; ++i) {
        if (c != 0.0 && is_inner(kind, sectors, i) && !(eliminates && i + 1 == edges))
            mask.ring_column[i] = columns++;
    }
    const MaskRow zero(columns, 0.0);
    mask.apex = zero;
    mask.apex[0] = 1.0;
    mask.leg.assign(edges, mask.apex);
    mask.ring.resize(edges);
    const std::vector<MaskRow> t = tangents(kind, sectors, alpha, zero);
    for (Index i = 0; i < edges; ++i) {
        add(mask.leg[i], 1.0, t[i]);
        if (mask.ring_column[i] != invalid_index) {
            mask.ring[i] = zero;
            mask.ring[i][mask.ring_column[i]] = 1.0;
        }
    }
    if (eliminates) {
        mask.ring.back() = zero;
        for (Index i = 0; i + 1 < edges; ++i)
            add(mask.ring.back(), alternating(i), mask.ring[i]);
    }
    if (sectors > 1) {
        mask.twist = twists(mask, kind, sectors, c);
        for (Index i = 0; mask.vertex_columns == 4 && i < sectors; ++i)
            mask.twist[i][3] += alternating(i);
    } else {
        mask.twist.assign(1, zero);
        mask.twist[0][3] = 1.0;
    }
    return mask;
}

} // namespace bot2nurbs
