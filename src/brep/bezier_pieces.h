// SPDX-License-Identifier: MIT
#pragma once

//! The bicubic Bezier pieces of a spline surface one by one: evaluation, feet, neighbours, and
//! bounds of their derivatives. Everything is with respect to parameters in [0, 1] of the piece.

#include "bot2nurbs/context.h"
#include "bot2nurbs/spline_network.h"
#include "spline/bernstein.h"

#include <vector>

namespace bot2nurbs {

inline constexpr Index pieces_per_patch = pieces_per_side * pieces_per_side;

//! 4 x 4 control points, (i, j) at control[i * stride + j].
struct BezierView {
    const Vec3* control;
    Index stride;

    const Vec3& operator()(Index i, Index j) const { return control[i * stride + j]; }
    Vec3 position(const Vec2& at) const;
};

//! Where a piece comes close to a point.
struct PieceFoot {
    Vec2 at;       //!< In the unit square.
    Vec2 beyond;   //!< Where the foot would be if the tangent plane at `at` went on.
    Vec3 position; //!< Of the piece at `at`.
};

//! A foot of p on a piece: a local minimum of the distance in practice, and in any case a place on
//! the piece.
PieceFoot foot_on_piece(const BezierView& piece, const Vec3& p, const Vec2& start = {0.5, 0.5});

//! The second derivative at a place.
struct SecondDerivative {
    Vec3 uu, uv, vv;

    //! In a direction.
    Vec3 of(const Vec2& d) const
    {
        return (d.x * d.x) * uu + (2.0 * d.x * d.y) * uv + (d.y * d.y) * vv;
    }
};
SecondDerivative second_derivative(const BezierView& piece, const Vec2& at);

//! Upper bounds of the lengths of first and third derivatives on a piece.
struct DerivativeBounds {
    double u = 0.0, v = 0.0, uuu = 0.0, uuv = 0.0, uvv = 0.0, vvv = 0.0;
};

class BezierPieces {
public:
    //! Both must outlive the pieces. Bounds are missing when `context` is cancelled meanwhile.
    BezierPieces(const QuadComplex& complex, const SplineSurface& surface, const Context& context);

    //! Piece 16 q + 4 a + b covers [a / 4, (a + 1) / 4] x [b / 4, (b + 1) / 4] of patch q.
    Index count() const { return pieces_per_patch * surface_.patch_count(); }
    static Index patch(Index piece) { return piece / pieces_per_patch; }
    BezierView view(Index piece) const;
    Vec3 position(Index piece, const Vec2& at) const { return view(piece).position(at); }

    //! A side of a piece, numbered as the sides of its patch.
    struct Side {
        Index piece = invalid_index, side = 0;
    };
    //! The piece on the other side, and which of its sides that is; no piece at a boundary.
    Side across(const Side& side) const;

    //! The place at t of a side, which runs counter-clockwise, and the t of a place seen from
    //! there.
    static Vec2 on_side(Index side, double t);
    static double along_side(Index side, const Vec2& at);

    //! The place in the patch of a place in a piece, and back.
    static DomainPoint domain_point(Index piece, const Vec2& at);
    static Index piece_at(const DomainPoint& p);
    static Vec2 place_in_piece(const DomainPoint& p);

    const DerivativeBounds& bounds(Index piece) const { return bounds_[piece]; }

private:
    const QuadComplex& complex_;
    const SplineSurface& surface_;
    std::vector<DerivativeBounds> bounds_;
};

} // namespace bot2nurbs
