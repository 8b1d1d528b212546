// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/manifold_mesh.h"

#include <functional>
#include <optional>
#include <vector>

namespace bot2nurbs {

//! A place in a quadrilateral domain: a quad and parameters in [0, 1]^2; u runs from corner 0 to
//! corner 1, v from corner 0 to corner 3.
struct DomainPoint {
    Index quad = invalid_index;
    double u = 0.0, v = 0.0;
};

//! The data a spline network is fitted to: one entry of every array per sample.
struct SurfaceSampleSet {
    std::vector<Vec3> positions;
    std::vector<Vec3> normals;       //!< Unit normals of the source; empty when unknown.
    std::vector<double> weights;     //!< Confidence times the area the sample stands for; > 0.
    std::vector<SourcePoint> source; //!< Where on the source mesh.
    std::vector<DomainPoint> domain; //!< Where in the domain (changes with parameter correction).
    //! Per sample, 1 when it lies on a crease or the boundary: it is then a sample of that curve,
    //! and its place stays on sharp edges of the domain. Empty: none does.
    std::vector<char> on_curve;

    std::size_t size() const { return positions.size(); }
};

//! A place of the source, and the unit normal of its face.
struct NearPlace {
    Vec3 position, normal;
};

//! The place of the source nearest to a point, of those whose faces look along a direction, or
//! nothing. May be called from several threads at once.
using NearestPlace = std::function<std::optional<NearPlace>(const Vec3& point, const Vec3& along)>;

} // namespace bot2nurbs
