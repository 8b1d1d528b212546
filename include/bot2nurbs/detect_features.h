// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "bot2nurbs/manifold_mesh.h"

#include <array>
#include <optional>
#include <vector>

namespace bot2nurbs {

//! When an edge of a mesh is a crease of its shape. All angles in degrees.
struct FeatureOptions {
    //! An edge whose two sides meet at this angle or more, 0 to 180 between their normals, starts a
    //! crease.
    double angle = 35.0;
    //! A crease goes on over edges down to this share of `angle` (hysteresis), and ends there.
    double weak_share = 0.5;
    //! Within the sides normals may spread by this share of the angle between them: beyond, the
    //! edge is a facet of a curved or rough surface, not a crease. 1 turns this test off.
    double spread_share = 0.4;
    //! A crease that ends inside the surface is kept from this length on, as a fraction of the box
    //! diagonal, if it has three edges at least.
    double least_length = 0.03;
    //! Nothing is kept when less than this share of the length of all creases is in clear ones:
    //! connected, sharp throughout, ridges or valleys from end to end, between smooth sides,
    //! without loose ends. Then what is sharp is the grain of a scan or the ends of ridges, not the
    //! edges of a part. 0 keeps them all the same.
    double least_clear_share = 0.8;
    //! A crease or boundary has a corner where it turns by this angle or more.
    double corner_angle = 45.0;

    std::optional<Error> check() const;
};

//! Creases of a mesh as chains of its edges.
struct MeshFeatures {
    std::vector<std::vector<Index>> creases; //!< Vertices in order; the first is repeated at the
                                             //!< end of a closed one.
    std::vector<Index> corners;              //!< Where a crease or the boundary turns; ascending.
    Index sharp_edges = 0; //!< Edges whose faces meet at `angle` or more, whatever is around them.
    Index kept_edges = 0;  //!< Edges of `creases`.
    double clear_share = 1.0; //!< See FeatureOptions::least_clear_share.
    //! Sharp edges that are no part of a crease, as their two vertices, in order of the first.
    std::vector<std::array<Index, 2>> smoothed;
};

//! Finds creases by the angle between the two sides of an edge, each side averaged over the faces
//! within a few rings that no sharp edge divides from it, with hysteresis; cleans jagged ones and
//! drops short branches; decides whether they are the edges of a part; and marks corners.
//! Cost O(n log n). Errors: bad_option, cancelled.
Result<MeshFeatures> detect_features(const ManifoldMesh& mesh, const FeatureOptions& options,
                                     Context& context);

} // namespace bot2nurbs
