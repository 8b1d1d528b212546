// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "bot2nurbs/spline_network.h"

#include <vector>

namespace bot2nurbs {

//! Counts places where a fitted surface faces the wrong way.
//!
//! The start map of the samples has no folds, so the mean source normal of the samples that start
//! on a Bezier piece says which way the piece should face. Distances from samples to the surface do
//! not see a fold between them; this does. Without source normals the first surface given serves.
class FoldGuard {
public:
    FoldGuard(Index quads, const std::vector<Vec3>& normals, const std::vector<DomainPoint>& where);

    //! True when there are reference normals.
    bool ready() const { return !reference_.empty(); }
    //! Takes the reference normals from a surface.
    void set_reference(const SplineSurface& surface);
    //! Per quad: places of a 3 x 3 grid on every piece whose normal turns away from the reference
    //! of the piece; pieces without a clear reference do not count. All zero when not ready.
    std::vector<Index> folds(const SplineSurface& surface, const Context& context) const;
    //! Per quad: the smallest Jacobian at those places, the part of du x dv along the reference,
    //! over the mean length of du x dv on the quad. 1 when not ready.
    std::vector<double> smallest_jacobians(const SplineSurface& surface,
                                           const Context& context) const;

private:
    std::vector<Vec3> reference_; //!< Per piece; zero: none.
};

} // namespace bot2nurbs
