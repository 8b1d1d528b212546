// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "bot2nurbs/spline_network.h"
#include "fit/source_normals.h"

#include <optional>
#include <vector>

namespace bot2nurbs {

//! Finds where a surface runs back over itself, at the places of a 5 x 5 grid on every Bezier
//! piece. Distances from samples to the surface do not see this between them.
//!
//! A *fold* is a line in a patch where du x dv passes through zero. A surface may turn by any angle
//! without one, over a rim narrower than a patch say; but then the normals on both sides come
//! together as one looks closer, and at a fold they become opposite. A *curl* turns without a fold
//! and without samples, as where a patch goes over its rim and comes back: its normals are far
//! from those of the source around.
class FoldGuard {
public:
    //! The complex must outlive this.
    explicit FoldGuard(const QuadComplex& complex) : complex_(complex) {}

    //! Takes unit normals of the source at places of the domain, to know curls by.
    void set_source(const std::vector<Vec3>& normals, const std::vector<DomainPoint>& where);

    //! Per quad: places on the wrong side of folds (the side with fewer places) or in curls.
    std::vector<Index> folds(const SplineSurface& surface, const Context& context) const;
    //! Per quad: the smallest |du x dv| at the places, negative where they count as folds, over its
    //! mean on the quad. 0 where all is one point.
    std::vector<double> smallest_jacobians(const SplineSurface& surface,
                                           const Context& context) const;

private:
    const QuadComplex& complex_;
    std::optional<SourceNormals> source_;
};

} // namespace bot2nurbs
