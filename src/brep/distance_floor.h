// SPDX-License-Identifier: MIT
#pragma once

//! Lower bounds of the distance from a point to a whole mesh or surface. A closest-point search can
//! end on a wrong sheet or lose digits; these cannot say too much, whatever was found.

#include "bot2nurbs/closest_point.h"
#include "brep/bezier_pieces.h"
#include "brep/cover_targets.h"
#include "mesh/box_tree.h"

namespace bot2nurbs {

struct SurfaceDistance {
    double floor = 0.0;          //!< At most the distance.
    Index piece = invalid_index; //!< One with a place that is nearer than what was found before,
    Vec2 at;                     //!< where that is,
    double distance = 0.0;       //!< and how near it is.
};

//! No point of a convex hull is nearer to p than a plane between: min_i n . (p - b_i) bounds the
//! distance to all b_i for any n of length one. With n towards the closest point nothing is lost.
class DistanceFloor {
public:
    //! All must outlive it. It must not be used when `context` was cancelled meanwhile.
    DistanceFloor(const PlacedMesh& mesh, const ClosestPoint& tree, const BezierPieces& pieces,
                  const Context* context = nullptr);

    //! At most the distance from p to the mesh. `found`: the distance to some point of it; the
    //! result is not above it, and equal to it up to rounding when nothing is nearer.
    double to_mesh(const Vec3& p, double found) const;
    //! The distance from p to the surface from below, up to a `share` of it. `found`: the distance
    //! to some point of it. Makes sure that no other is nearer by more than that share.
    SurfaceDistance to_surface(const Vec3& p, double found, double share) const;

private:
    const PlacedMesh& mesh_;
    const ClosestPoint& tree_;
    const BezierPieces& pieces_;
    BoxTree hulls_; //!< Of the control points of the pieces.
};

} // namespace bot2nurbs
