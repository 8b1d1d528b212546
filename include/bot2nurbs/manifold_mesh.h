// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/result.h"
#include "bot2nurbs/vec.h"

#include <array>
#include <string>
#include <vector>

namespace bot2nurbs {

//! Triangles as a reader found them: no topology is promised.
struct TriangleSoup {
    std::vector<Vec3> positions;
    std::vector<std::array<Index, 3>> triangles;
    std::vector<Index> source_face; //!< Per triangle: the face or polygon of the file it came from.
    std::string units;              //!< "mm", "m", ...; empty when the file does not say.
};

//! A point of a mesh surface: a face and barycentric weights of its three corners (sum 1).
struct SourcePoint {
    Index face = invalid_index;
    std::array<double, 3> bary{};
};

//! An oriented two-manifold triangle mesh with halfedges in flat arrays.
//!
//! Halfedge h = 3 f + k runs from corner k of face f to corner k + 1. Guarantees:
//! 1. every edge has one or two faces, traversed in opposite directions;
//! 2. the faces at a vertex form one fan (closed inside, open at a boundary);
//! 3. no face is repeated or uses a vertex twice, no vertex is unused;
//! 4. coordinates are finite.
class ManifoldMesh {
public:
    ManifoldMesh() = default;

    //! Builds the topology. Errors name the first offending element of `triangles`:
    //! bad_geometry, not_manifold, empty_input. Cost O(F log F).
    static Result<ManifoldMesh> build(std::vector<Vec3> positions,
                                      std::vector<std::array<Index, 3>> triangles);

    Index vertex_count() const { return static_cast<Index>(positions_.size()); }
    Index face_count() const { return static_cast<Index>(triangles_.size()); }
    Index halfedge_count() const { return 3 * face_count(); }
    Index edge_count() const { return edge_count_; }

    const std::vector<Vec3>& positions() const { return positions_; }
    const std::vector<std::array<Index, 3>>& triangles() const { return triangles_; }
    const Vec3& position(Index v) const { return positions_[v]; }
    const std::array<Index, 3>& triangle(Index f) const { return triangles_[f]; }

    static Index face(Index h) { return h / 3; }
    static Index next(Index h) { return h % 3 == 2 ? h - 2 : h + 1; }
    static Index prev(Index h) { return h % 3 == 0 ? h + 2 : h - 1; }
    Index from(Index h) const { return triangles_[h / 3][h % 3]; }
    Index to(Index h) const { return from(next(h)); }
    //! The opposite halfedge, or invalid_index at a boundary.
    Index twin(Index h) const { return twin_[h]; }
    //! The smaller of h and its twin: a unique name of the undirected edge.
    Index edge(Index h) const { return twin_[h] < h ? twin_[h] : h; }
    //! A halfedge that starts at v; at a boundary vertex the one with no face to its right, so that
    //! turning counter-clockwise by twin(prev(h)) visits every face at v.
    Index halfedge_at(Index v) const { return vertex_halfedge_[v]; }
    bool is_boundary_vertex(Index v) const { return twin_[vertex_halfedge_[v]] == invalid_index; }
    //! The halfedge from a to b, or invalid_index. Cost O(valence of a).
    Index find_halfedge(Index a, Index b) const;

    bool closed() const { return boundary_halfedges_ == 0; }
    Vec3 at(const SourcePoint& p) const
    {
        const auto& t = triangles_[p.face];
        return p.bary[0] * positions_[t[0]] + p.bary[1] * positions_[t[1]] +
               p.bary[2] * positions_[t[2]];
    }
    //! Twice the area vector of a face.
    Vec3 area_vector(Index f) const
    {
        const auto& t = triangles_[f];
        return cross(positions_[t[1]] - positions_[t[0]], positions_[t[2]] - positions_[t[0]]);
    }
    Box3 box() const;
    //! Signed volume of a closed mesh; positive when faces turn outward.
    double volume() const;
    //! Genus of a closed connected mesh.
    int genus() const;

private:
    std::vector<Vec3> positions_;
    std::vector<std::array<Index, 3>> triangles_;
    std::vector<Index> twin_;
    std::vector<Index> vertex_halfedge_;
    Index edge_count_ = 0;
    Index boundary_halfedges_ = 0;
};

//! 16 hexadecimal digits that depend on every coordinate and index of the mesh (FNV-1a, 64 bit,
//! over the little-endian bytes). Domain and constraint files carry it, so that a file made for
//! another mesh is refused.
std::string signature(const ManifoldMesh& mesh);

} // namespace bot2nurbs
