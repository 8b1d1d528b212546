// SPDX-License-Identifier: MIT
#pragma once

#include "layout/layout_level.h"
#include "layout/patch_complex.h"

#include <memory>

namespace bot2nurbs {

//! A coarse mesh that stands for a fine one while a layout is made: the base complex of many small
//! tiles, its vertices vertices of the fine mesh, its edges paths over it, its faces disks on it
//! with injective maps. So a layout drawn on the coarse mesh is one on the fine mesh, up to
//! straightness at the scale of the tiles, at a cost that no longer depends on how fine the fine
//! mesh is.
class Proxy {
public:
    //! Tiles are about `width` wide, in the metric of the level's density. `fine` must outlive it.
    //! Errors: layout_failed when a tile cannot be mapped; cancelled.
    static Result<Proxy> build(const LayoutLevel& fine, double width, Context& context);

    //! The coarse mesh, with names and curves of the fine one.
    const LayoutLevel& level() const { return *level_; }

    //! A complex on the coarse mesh as one on the fine mesh. Faces and paths keep their order.
    //! Inside each coarse face paths are straight in its map; only which fine edges they cross, and
    //! in which order, matters, so paths that did not cross do not.
    //! Errors: layout_failed when a face cannot be mapped; cancelled.
    Result<PatchComplex> lift(const PatchComplex& complex, Context& context) const;

private:
    Proxy(const LayoutLevel& fine, PatchComplex base) : fine_(&fine), base_(std::move(base)) {}

    const LayoutLevel* fine_;
    PatchComplex base_;                  // The coarse mesh's edges and faces, on the fine mesh.
    std::unique_ptr<ManifoldMesh> mesh_; // The coarse mesh; face f is face f of base_.
    std::unique_ptr<LayoutLevel> level_;
    std::vector<Index> fine_vertex_;       // Per coarse vertex.
    std::vector<PatchComplex::Side> side_; // Per coarse halfedge.
};

} // namespace bot2nurbs
