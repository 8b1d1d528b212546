// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/layout.h"
#include "layout/constraints_on_carrier.h"
#include "layout/cut_mesh.h"
#include "layout/layout_level.h"

#include <memory>

namespace bot2nurbs {

//! What a layout is drawn on: the carrier with its curves, and how large patches should be on it.
struct Ground {
    //! On the heap, since what is below refers to it.
    std::unique_ptr<CarrierMesh> carrier;
    std::vector<char> marks;  //!< Per halfedge of the carrier: see mark_of.
    std::vector<char> corner; //!< Per vertex of the carrier: a crease or the boundary turns there.
    std::unique_ptr<CutMesh> cut;       //!< The carrier cut open along all curves.
    std::unique_ptr<LayoutLevel> level; //!< On the cut carrier, named by carrier vertices.
    double width = 0.0;                 //!< Of a patch, in the metric of the level's density.
    CarrierConstraints constraints;
};

//! Measures the shape, chooses the number of patches unless one is asked for, splits edges of the
//! source that are too long for them, and cuts it open. Cost O(n log n). Errors:
//! constraint_conflict.
Result<Ground> prepare_ground(const ManifoldMesh& source, const LayoutOptions& options,
                              LayoutSummary& summary, const Context& context);

//! V - E + F.
int euler_characteristic(const ManifoldMesh& mesh);

} // namespace bot2nurbs
