// SPDX-License-Identifier: MIT
#include "spline/vertex_masks.h"

#include <cassert>
#include <cmath>

namespace bot2nurbs {

namespace {

//! Twists x_0 .. x_(k-1) with x_i + x_(i-1) = r_i for the inner edges i = 1 .. k - 1: the solution
//! closest to x_i = (r_i + r_(i+1)) / 4 + ..., which is exact where the surface is a sphere.
std::vector<MaskRow> open_twists(const std::vector<MaskRow>& r)
{
    const Index k = static_cast<Index>(r.size()) - 1;
    const MaskRow zero(r[0].size(), 0.0);
    std::vector<MaskRow> twist(k, zero);
    for (Index i = 0; i < k; ++i) {
        add(twist[i], 0.25, r[i]);
        add(twist[i], 0.25, r[i + 1]);
    }
    for (Index m = 1; m < k; ++m) {
        // What the start leaves unsolved at edge m, spread over all sectors.
        MaskRow defect = zero;
        add(defect, -0.25, r[m - 1]);
        add(defect, 0.5, r[m]);
        add(defect, -0.25, r[m + 1]);
        for (Index i = 0; i < k; ++i)
            add(twist[i], chain_weight(k, m, i), defect);
    }
    return twist;
}

//! Control legs A_i = position + (first harmonic of u, v) + alternating shear, at the columns
//! given.
void harmonic_legs(PetersMask& mask, Index columns, double phi, Index position, const MaskRow& u,
                   const MaskRow& v, Index shear)
{
    const double secant = 1.0 / std::cos(0.5 * phi);
    for (Index i = 0; i < mask.leg.size(); ++i) {
        MaskRow& leg = mask.leg[i];
        leg.assign(columns, 0.0);
        leg[position] = 1.0;
        add(leg, secant * std::cos((i + 0.5) * phi), u);
        add(leg, secant * std::sin((i + 0.5) * phi), v);
        if (shear != invalid_index)
            leg[shear] += alternating(i);
    }
}

} // namespace

std::vector<VertexColumn> peters_vertex_columns(FanKind kind, Index sectors)
{
    using C = VertexColumn;
    switch (kind) {
    case FanKind::closed:
        if (sectors <= 4)
            return std::vector<C>(sectors, C::control);
        if (sectors % 2 == 1)
            return {C::position, C::plane_u, C::plane_v};
        return {C::position, C::plane_u, C::plane_v, C::shear};
    case FanKind::smooth:
    case FanKind::dart: return {C::position, C::first_tangent, C::plane_v, C::shear};
    case FanKind::corner: break;
    }
    if (sectors == 1)
        return {C::position, C::control};
    return {C::position, C::first_tangent, C::last_tangent, C::shear};
}

PetersMask peters_mask(FanKind kind, Index sectors, double alpha)
{
    const bool closed = kind == FanKind::closed;
    const Index edges = closed ? sectors : sectors + 1;
    PetersMask mask;
    mask.vertex_columns = static_cast<Index>(peters_vertex_columns(kind, sectors).size());
    const Index columns = mask.vertex_columns + 2 * edges;
    const MaskRow zero(columns, 0.0);
    const auto unit = [&](Index column, double weight = 1.0) {
        MaskRow row = zero;
        row[column] = weight;
        return row;
    };
    const double phi = alpha / sectors;
    mask.apex = unit(0);
    mask.leg.resize(sectors);
    MaskRow first = zero, last = zero; // tangents of the outer edges of an open fan
    if (closed && sectors <= 4) {
        mask.apex.assign(columns, 0.0);
        for (Index i = 0; i < sectors; ++i) {
            mask.apex[i] = 1.0 / sectors;
            mask.leg[i] = unit(i);
        }
    } else if (closed) {
        harmonic_legs(mask, columns, phi, 0, unit(1), unit(2),
                      sectors % 2 == 0 ? 3 : invalid_index);
    } else if (sectors == 1) {
        assert(kind == FanKind::corner);
        mask.leg[0] = unit(1);
        return mask; // no smooth edge: nothing to correct
    } else {
        first = unit(1);
        MaskRow v = unit(2);
        if (kind == FanKind::corner) {
            last = unit(2);
            v = unit(2, 1.0 / std::sin(alpha));
            v[1] = -std::cos(alpha) / std::sin(alpha);
        } else {
            last = unit(1, kind == FanKind::smooth ? -1.0 : 1.0);
        }
        harmonic_legs(mask, columns, phi, 0, first, v, 3);
    }

    const double c = std::cos(phi);
    if (std::fabs(c) < regular_cosine)
        return mask;
    // r_i = (4 c / 9) times the second difference of the first quadratic piece of edge i.
    std::vector<MaskRow> r(edges, zero);
    for (Index i = 0; i < edges; ++i) {
        MaskRow& row = r[i];
        const double s = 4.0 * c / 9.0;
        if (!closed && (i == 0 || i == sectors)) {
            MaskRow q1 = mask.apex;
            add(q1, 1.0, i == 0 ? first : last);
            row[mask.edge_column(i, 0)] = 0.5 * s;
            add(row, (0.5 - 2.0) * s, q1);
        } else {
            row[mask.edge_column(i, 0)] = row[mask.edge_column(i, 1)] = 0.25 * s;
            // q1 is half the sum of the two legs, q2 a quarter of it and of the B.
            add(row, (0.25 - 1.0) * s, mask.leg[i]);
            add(row, (0.25 - 1.0) * s, mask.leg[(i + sectors - 1) % sectors]);
        }
        add(row, s, mask.apex);
    }
    if (!closed) {
        mask.twist = open_twists(r);
        return mask;
    }
    const std::vector<double> w = ring_weights(sectors);
    mask.twist.assign(sectors, zero);
    for (Index i = 0; i < sectors; ++i) {
        for (Index l = 0; l < sectors; ++l) {
            add(mask.twist[i], w[l], r[(i + sectors - l) % sectors]);
        }
    }
    return mask;
}

EckHoppeMask eck_hoppe_mask(Index n)
{
    enum { A, Bp, Bm, C };
    const auto column = [n](Index i, int what) { return 4 * (i % n) + what; };
    const MaskRow zero(4 * n, 0.0);
    const double phi = 2.0 * M_PI / n, c = std::cos(phi);
    const double a = c / (1.0 - c), al = 2.0 / (3.0 * (1.0 - c));

    EckHoppeMask mask;
    mask.apex = zero;
    for (Index i = 0; i < n; ++i)
        mask.apex[column(i, A)] = 1.0 / n;
    mask.edge1.assign(n, mask.apex);
    mask.edge2.assign(n, zero);
    std::vector<MaskRow> h3(n, zero);
    for (Index i = 0; i < n; ++i) {
        for (Index l = 0; l < n; ++l) {
            const double w = al / n * std::cos(l * phi);
            mask.edge1[i][column(i + l, A)] += w;
            mask.edge1[i][column(i + l + n - 1, A)] += w;
        }
        mask.edge2[i][column(i, Bp)] = mask.edge2[i][column(i, Bm)] = (1.0 - 2.0 * a) / 12.0;
        mask.edge2[i][column(i, A)] = mask.edge2[i][column(i + n - 1, A)] = (5.0 + 2.0 * a) / 12.0;
        add(h3[i], 1.0 - 2.0 * c / 3.0, mask.edge1[i]);
        add(h3[i], 2.0 * c / 3.0, mask.edge2[i]);
    }
    const std::vector<double> w = ring_weights(n);
    mask.b11.assign(n, zero);
    mask.b21 = mask.b12 = mask.b22 = mask.b11;
    for (Index i = 0; i < n; ++i) {
        // Twice the weights: b11_i + b11_(i-1) = 2 h3_i.
        for (Index l = 0; l < n; ++l)
            add(mask.b11[i], 2.0 * w[l], h3[(i + n - l) % n]);
        const Index j = i + 1;
        mask.b21[i][column(i, Bp)] = mask.b12[i][column(j, Bm)] = (5.0 - 10.0 * a) / 36.0;
        mask.b21[i][column(i, Bm)] = mask.b12[i][column(j, Bp)] = (1.0 + 2.0 * a) / 36.0;
        mask.b21[i][column(i, A)] = mask.b12[i][column(i, A)] = (25.0 + 6.0 * a) / 36.0;
        mask.b21[i][column(i + n - 1, A)] = mask.b12[i][column(j, A)] = (5.0 + 2.0 * a) / 36.0;
        mask.b22[i][column(i, Bp)] = mask.b22[i][column(j, Bm)] = 5.0 / 36.0;
        mask.b22[i][column(i, A)] = (25.0 + 4.0 * a) / 36.0;
        mask.b22[i][column(i, C)] = (1.0 - 4.0 * a) / 36.0;
    }
    return mask;
}

} // namespace bot2nurbs
