// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/quad_complex.h"
#include "bot2nurbs/spline_network.h"

#include <vector>

namespace bot2nurbs {

//! The normals of the source over a domain, by cells of its quads, nine on every Bezier piece.
class SourceNormals {
public:
    //! Takes unit normals of the source at places of the domain.
    SourceNormals(const QuadComplex& complex, const std::vector<Vec3>& normals,
                  const std::vector<DomainPoint>& where);

    //! Whether a normal, of any length, at a place is more than a right angle outside the cone of
    //! those of the source: in its cell or, where there are none, on its piece; and of those in
    //! each of the cells around, over smooth edges too, as the surface may turn within a cell.
    //! False where nothing is known.
    bool far(Index quad, double u, double v, const Vec3& normal) const;

private:
    struct Cell {
        Vec3 normal;         //!< Unit mean; zero: nothing is known.
        double slack = 0.0;  //!< Minus the cosine of the angle from which normals are far from it.
        bool filled = false; //!< Of normals in the cell itself.
    };
    std::vector<Cell> cells_; //!< Of each quad, with those around it.
};

} // namespace bot2nurbs
