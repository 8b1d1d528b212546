// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/quad_domain.h"

#include <vector>

namespace bot2nurbs {

//! A chain of mesh edges by arc length: a boundary loop or a crease.
struct CurveLine {
    std::vector<Index> vertices; //!< The first is repeated at the end of a closed one.
    std::vector<double> arc;     //!< Per vertex: length from the start.
    bool boundary = false;

    CurveLine(const ManifoldMesh& mesh, std::vector<Index> chain, bool is_boundary);

    bool closed() const { return vertices.front() == vertices.back(); }
    double length() const { return arc.back(); }
    //! The point at a length, taken modulo the whole on a closed line.
    Vec3 at(const ManifoldMesh& mesh, double s) const;
    //! Length at which the line is nearest to a point; the first such.
    double closest(const ManifoldMesh& mesh, const Vec3& p) const;
};

//! Lines of the source over a carrier: their vertices with those that the carrier has between.
std::vector<std::vector<Index>> lines_on_carrier(const std::vector<CurveLine>& lines,
                                                 const ManifoldMesh& source,
                                                 const CarrierMesh& carrier);

} // namespace bot2nurbs
