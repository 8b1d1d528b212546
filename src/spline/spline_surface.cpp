// SPDX-License-Identifier: MIT
#include "bot2nurbs/spline_network.h"

#include "spline/bernstein.h"

#include <cassert>

namespace bot2nurbs {

SplineSurface::SplineSurface(const SplineNetwork& network, const std::vector<Vec3>& unknowns)
{
    assert(unknowns.size() == network.unknown_count);
    const SparseRows& rows = network.stencils;
    bezier_.resize(rows.row_count());
    for (std::size_t r = 0; r < bezier_.size(); ++r) {
        Vec3 sum;
        for (std::size_t i = rows.offset[r]; i < rows.offset[r + 1]; ++i) {
            sum += rows.weight[i] * unknowns[rows.column[i]];
        }
        bezier_[r] = sum;
    }
}

Vec3 SplineSurface::position(const DomainPoint& p) const
{
    const PieceParameter pu = piece_parameter(p.u), pv = piece_parameter(p.v);
    const Cubic bu = bernstein(pu.t), bv = bernstein(pv.t);
    const Vec3* c = &bezier(p.quad, 3 * pu.piece, 3 * pv.piece);
    Vec3 sum;
    for (int a = 0; a < 4; ++a, c += SplineNetwork::grid) {
        sum += bu[a] * (bv[0] * c[0] + bv[1] * c[1] + bv[2] * c[2] + bv[3] * c[3]);
    }
    return sum;
}

SurfacePoint SplineSurface::evaluate(const DomainPoint& p) const
{
    constexpr double d = pieces_per_side; // dt / du
    const PieceParameter pu = piece_parameter(p.u), pv = piece_parameter(p.v);
    const Cubic u0 = bernstein(pu.t), u1 = bernstein_d(pu.t), u2 = bernstein_dd(pu.t);
    const Cubic v0 = bernstein(pv.t), v1 = bernstein_d(pv.t), v2 = bernstein_dd(pv.t);
    const Vec3* c = &bezier(p.quad, 3 * pu.piece, 3 * pv.piece);
    SurfacePoint out;
    for (int a = 0; a < 4; ++a, c += SplineNetwork::grid) {
        const Vec3 w0 = v0[0] * c[0] + v0[1] * c[1] + v0[2] * c[2] + v0[3] * c[3];
        const Vec3 w1 = v1[0] * c[0] + v1[1] * c[1] + v1[2] * c[2] + v1[3] * c[3];
        const Vec3 w2 = v2[0] * c[0] + v2[1] * c[1] + v2[2] * c[2] + v2[3] * c[3];
        out.position += u0[a] * w0;
        out.du += u1[a] * w0;
        out.dv += u0[a] * w1;
        out.duu += u2[a] * w0;
        out.duv += u1[a] * w1;
        out.dvv += u0[a] * w2;
    }
    out.du *= d;
    out.dv *= d;
    out.duu *= d * d;
    out.duv *= d * d;
    out.dvv *= d * d;
    return out;
}

void SplineSurface::transform(double scale, const Vec3& offset)
{
    for (Vec3& c : bezier_)
        c = scale * c + offset;
}

BsplinePatch bspline_patch(const SplineSurface& surface, Index patch, KnotForm form)
{
    // What remains of the 13 Bezier coefficients when a knot's multiplicity drops from three: at a
    // C1 joint the middle coefficient is the mean of its neighbours and goes.
    static constexpr std::array<Index, 12> kept_paper{0, 1, 2, 3, 4, 5, 7, 8, 9, 10, 11, 12};
    static constexpr std::array<Index, 10> kept_c1{0, 1, 2, 4, 5, 7, 8, 10, 11, 12};
    const bool paper = form == KnotForm::paper;
    const Index* kept = paper ? kept_paper.data() : kept_c1.data();
    BsplinePatch out;
    out.size = paper ? 12 : 10;
    out.knots = paper ? std::vector<double>{0, 0, 0, 1, 1, 1, 2, 2, 3, 3, 3, 4, 4, 4}
                      : std::vector<double>{0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4};
    out.control.reserve(std::size_t(out.size) * out.size);
    for (Index i = 0; i < out.size; ++i) {
        for (Index j = 0; j < out.size; ++j) {
            out.control.push_back(surface.bezier(patch, kept[i], kept[j]));
        }
    }
    return out;
}

} // namespace bot2nurbs
