// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "bot2nurbs/manifold_mesh.h"

#include <array>
#include <memory>
#include <vector>

namespace bot2nurbs {

//! Closest points on the surface of a mesh, over a box tree of its triangles.
//!
//! Keeps what it needs of the mesh. Queries cost O(log F) in practice and may run on many threads
//! at once. Building costs O(F log F); when the given context is cancelled meanwhile, nothing will
//! be found.
class ClosestPoint {
public:
    explicit ClosestPoint(const ManifoldMesh& mesh, const Context* context = nullptr);
    //! Over triangles that need not be joined.
    ClosestPoint(const std::vector<Vec3>& positions,
                 const std::vector<std::array<Index, 3>>& triangles,
                 const Context* context = nullptr);

    struct Hit {
        SourcePoint where; //!< where.face is invalid_index when nothing lies within the limit.
        Vec3 position;
        double distance = 0.0;
    };

    //! The closest point; of several equally close triangles the one with the smallest index.
    Hit query(const Vec3& p) const;
    //! The closest point at most `distance_limit` away. Faster the smaller the limit.
    Hit query(const Vec3& p, double distance_limit) const;
    //! The closest point on triangles whose normals lean towards `direction`: at a thin wall that
    //! on its near side. where.face is invalid_index when there is none.
    Hit query_facing(const Vec3& p, const Vec3& direction) const;
    //! All triangles that come within `distance` of p, and others near it, in no useful order.
    std::vector<Index> faces_near(const Vec3& p, double distance) const;

private:
    struct Tree;
    template <class Accept>
    Hit search(const Vec3& p, double distance_limit, const Accept& accept) const;
    std::shared_ptr<const Tree> tree_;
};

} // namespace bot2nurbs
