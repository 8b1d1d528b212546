// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/manifold_mesh.h"

#include <memory>
#include <vector>

namespace bot2nurbs {

//! A mesh cut open along some of its edges: the same faces with the same numbers and corners in the
//! same order, so halfedges keep their numbers, but a vertex for every run of faces around a vertex
//! that no cut divides. What crosses no cut is the same path on both.
class CutMesh {
public:
    //! Cuts along the edges with a mark on their halfedges. An edge whose two ends have no other
    //! cut and no boundary does not open. Cost O(n); without marks none, and `mesh` must outlive
    //! it.
    CutMesh(const ManifoldMesh& mesh, const std::vector<char>& marks);

    const ManifoldMesh& mesh() const { return cut_ ? *cut_ : *whole_; }
    //! The vertex of the mesh before that a vertex was.
    Index original(Index vertex) const { return cut_ ? original_[vertex] : vertex; }

private:
    const ManifoldMesh* whole_;
    std::unique_ptr<ManifoldMesh> cut_; // None where nothing is cut.
    std::vector<Index> original_;
};

} // namespace bot2nurbs
