// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/quad_complex.h"
#include "bot2nurbs/surface_samples.h"
#include "bot2nurbs/vec.h"

#include <string>
#include <vector>

namespace bot2nurbs {

//! Rows of a sparse matrix: row r has entries offset[r] .. offset[r + 1] - 1, columns ascending.
struct SparseRows {
    std::vector<std::size_t> offset{0};
    std::vector<Index> column;
    std::vector<double> weight;

    Index row_count() const { return static_cast<Index>(offset.size() - 1); }
};

//! Which spline space a network uses.
enum class SplineScheme {
    peters,    //!< Biquadratic away from vertices, 16 unknowns a quad; C1 inside every patch.
    eck_hoppe, //!< The masks of Eck and Hoppe 1996; closed smooth domains only.
    full,      //!< All bicubic patches with the joins of peters, about 60 unknowns a quad: closer
               //!< to dense data with fewer patches. Contains peters.
};

//! A spline space over a quadrilateral domain, as data: every Bezier coefficient of every patch is
//! a fixed combination of global unknowns, and smoothness holds for all unknowns that satisfy the
//! constraint rows. Nothing to the right of this header knows which scheme it is.
//!
//! Each quad carries a 13 x 13 Bezier grid: 4 x 4 bicubic pieces over [0, 4]^2, neighbours sharing
//! their border coefficients. Coefficient (i, j), i along u, j along v, of quad q is stencil row
//! 169 q + 13 i + j.
struct SplineNetwork {
    SplineScheme scheme = SplineScheme::peters;
    QuadComplex complex;
    Index unknown_count = 0;
    std::vector<char>
        is_point;        //!< Per unknown: 1 affine weight one (a point), 0 weight zero (a vector).
    SparseRows stencils; //!< 169 rows per quad.
    SparseRows constraints; //!< Rows that must vanish on the unknowns; disjoint supports.
    //! Per unknown: how it follows from the Bezier coefficients (columns: stencil rows) of any
    //! surface of this space. No rows for schemes whose unknowns are not read back.
    SparseRows recovery;
    bool c1_inside =
        true; //!< True: the 10 x 10 form with double knots represents the patches exactly.

    static constexpr Index grid = 13;
    static Index row(Index quad, Index i, Index j) { return 169 * quad + 13 * i + j; }
};

//! Builds the network of a scheme. `corner_angles`: per halfedge, the angle in radians of the quad
//! corner where it starts on the shape that will be fitted, as corner_angles() measures it, or
//! empty. Any gives exact joins; where sharp edges meet, the patches between them lie as the sum
//! of their angles says, and without it as in a corner of 120 degrees of two patches or 270 of
//! more: on a shape with other corners they fold. Errors: invalid_domain (a valence below 3 inside,
//! or a domain the scheme does not cover), naming the vertex; bad_option (another number of
//! angles). \cite peters_1994 \cite eck_hoppe_1996
Result<SplineNetwork> build_spline_network(const QuadComplex& complex, SplineScheme scheme,
                                           const std::vector<double>& corner_angles = {});

class SplineSurface;

//! The unknowns of a surface in the space of a network: those the network was fitted with, or, for
//! SplineScheme::full, those of any surface that a network of SplineScheme::peters gives over the
//! same complex. They give the surface back to rounding. Cost linear.
//! Errors: invalid_domain (not as many patches as quads), bad_option (the scheme cannot do this).
Result<std::vector<Vec3>> recover_unknowns(const SplineNetwork& network,
                                           const SplineSurface& surface);

//! Position and derivatives of a surface at one parameter, with respect to u, v in [0, 1].
struct SurfacePoint {
    Vec3 position, du, dv, duu, duv, dvv;
};

//! A spline surface: the Bezier grids that a network's stencils give for values of the unknowns.
class SplineSurface {
public:
    SplineSurface() = default;
    //! Applies the stencils. `unknowns` has network.unknown_count entries. Coefficients that two
    //! patches share have the same stencil row, summed in the same order: they agree to the bit.
    SplineSurface(const SplineNetwork& network, const std::vector<Vec3>& unknowns);

    Index patch_count() const { return static_cast<Index>(bezier_.size() / 169); }
    //! Bezier coefficient (i, j) of a patch, 0 <= i, j <= 12.
    const Vec3& bezier(Index patch, Index i, Index j) const
    {
        return bezier_[169 * patch + 13 * i + j];
    }
    const std::vector<Vec3>& bezier() const { return bezier_; }
    std::vector<Vec3>& bezier() { return bezier_; }
    Vec3 position(const DomainPoint& p) const;
    SurfacePoint evaluate(const DomainPoint& p) const;
    //! Scales all coefficients about the origin, then moves them: undoes the normalisation of
    //! input.
    void transform(double scale, const Vec3& offset);

private:
    std::vector<Vec3> bezier_;
};

//! The knots a B-spline patch is written with.
enum class KnotForm {
    paper, //!< 12 x 12 control points, knots of Eck and Hoppe (triple at 1 and 3, double at 2).
    c1,    //!< 10 x 10 control points, double knots: the same surface where c1_inside holds.
};

//! One bicubic B-spline patch: order 4, control point (i, j) at control[i * size + j].
struct BsplinePatch {
    Index size = 0;            //!< Control points per direction: 12 or 10.
    std::vector<double> knots; //!< openNURBS convention: size + 2 knots on [0, 4].
    std::vector<Vec3> control;
};

//! The B-spline form of a patch: a selection of its Bezier coefficients. \pre form is
//! representable.
BsplinePatch bspline_patch(const SplineSurface& surface, Index patch, KnotForm form);

//! Continuity measured at samples along every edge of a network, and inside the patches along their
//! inner knots. Angles are between the normals of the two sides, resolved down to rounding.
struct Continuity {
    double max_gap = 0.0;              //!< Between the two sides of any edge; 0 by construction.
    double max_g1_angle_deg = 0.0;     //!< Across smooth edges.
    Index worst_edge = invalid_index;  //!< Where max_g1_angle_deg is.
    Index crease_edges = 0;            //!< Inner edges across which only positions agree.
    double max_inner_angle_deg = 0.0;  //!< Across the inner knots of the patches.
    Index worst_patch = invalid_index; //!< Where max_inner_angle_deg is.
    //! Samples left out of the angles because the surface has no normal there (parallel or zero
    //! derivatives) that rounding of the coefficients would not drown.
    std::size_t undefined_normals = 0;
};
//! `samples` >= 2 parameters per Bezier piece and edge, both ends included. Cost O(samples) per
//! piece.
Continuity measure_continuity(const QuadComplex& complex, const SplineSurface& surface,
                              Index samples = 9);

} // namespace bot2nurbs
