// SPDX-License-Identifier: MIT
#pragma once

#include "layout/trace_faces.h"
#include "maps/retile.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace bot2nurbs {

//! Angle of a mesh at a boundary vertex: the sum over its faces.
double boundary_angle(const ManifoldMesh& mesh, Index vertex);

//! A division of a mesh into disks by non-crossing paths: K_tri while all faces have three sides, K
//! once all have four. The boundary of an open mesh consists of paths, each with one face. Changed
//! only by exchanging paths inside a disk: a change is planned, which either succeeds or not and
//! leaves everything as it is, and then applied, so that every state is a valid complex with its
//! exact map to the mesh.
class PatchComplex {
public:
    //! A side of a face: a path, traversed with the face to the left.
    struct Side {
        Index path = invalid_index;
        bool reversed = false;
        friend bool operator==(const Side& a, const Side& b)
        {
            return a.path == b.path && a.reversed == b.reversed;
        }
    };
    struct Face {
        std::vector<Side> sides; //!< Counter-clockwise; empty when the face is gone.
        bool frozen = false;     //!< No change may touch it.
        bool alive() const { return !sides.empty(); }
    };
    struct Path {
        SurfacePath geometry;                              //!< Ends are mesh vertices.
        Index left = invalid_index, right = invalid_index; //!< Faces when walked forward.
        bool alive = false;
        char mark = 0; //!< Other than 0: part of a curve of that kind (mark_of); stays as it is.
    };

    //! An exchange of the paths inside a disk, worked out but not done. Stays good until one of
    //! its faces goes.
    struct Change {
        std::vector<Index> faces;       //!< Those that go: together the disk.
        std::vector<Side> border;       //!< Outer sides of the disk, counter-clockwise.
        std::vector<Chord> chords;      //!< The new paths inside, as in retile().
        std::vector<SurfacePath> drawn; //!< Their geometry.
    };

    explicit PatchComplex(const ManifoldMesh& mesh) : mesh_(&mesh) {}

    const ManifoldMesh& mesh() const { return *mesh_; }
    const std::vector<Face>& faces() const { return faces_; }
    const std::vector<Path>& paths() const { return paths_; }
    Index face_count() const { return alive_faces_; }

    Index add_path(SurfacePath geometry);
    //! Adds a face; its paths must exist and be free on that side.
    Index add_face(std::vector<Side> sides);

    Index start(const Side& s) const
    {
        const SurfacePath& g = paths_[s.path].geometry;
        return s.reversed ? g.b : g.a;
    }
    Index end(const Side& s) const { return start({s.path, !s.reversed}); }
    //! The face to the left of a side; invalid_index where the mesh ends.
    Index face_at(const Side& s) const
    {
        return s.reversed ? paths_[s.path].right : paths_[s.path].left;
    }
    bool is_boundary(Index path) const
    {
        return paths_[path].left == invalid_index || paths_[path].right == invalid_index;
    }
    bool is_fixed(Index path) const { return paths_[path].mark != 0 || is_boundary(path); }
    //! Whether the start of s must stay: it is pinned, or a fixed path ends there.
    bool is_fixed_vertex(const Side& s) const;
    //! Makes a mesh vertex one that no change moves or removes.
    void pin(Index mesh_vertex) { pinned_.insert(mesh_vertex); }
    //! From now on no change joins these mesh vertices.
    void keep_apart(Index a, Index b) { apart_.insert(std::minmax(a, b)); }
    bool may_join(Index a, Index b) const { return apart_.count(std::minmax(a, b)) == 0; }
    //! Wanted number of faces of K at a mesh vertex inside; a hint.
    void want(Index mesh_vertex, Index quads) { wanted_[mesh_vertex] = quads; }
    const std::map<Index, Index>& wanted() const { return wanted_; }
    //! Says what the angle at a boundary vertex is, where it is not that of the mesh.
    void set_boundary_angle(Index mesh_vertex, double angle) { angle_[mesh_vertex] = angle; }
    //! The angle of the surface at a boundary vertex.
    double boundary_angle(Index mesh_vertex) const;
    void freeze(Index face) { faces_[face].frozen = true; }
    //! A path between two mesh vertices, if there is one.
    std::optional<Index> path_between(Index a, Index b) const;
    void mark(Index path, char mark) { paths_[path].mark = mark; }
    static Side opposite(const Side& s) { return {s.path, !s.reversed}; }
    //! Position of a side in its face.
    Index position(const Side& s) const;
    //! The side after or before s in its face.
    Side next(const Side& s) const;
    Side previous(const Side& s) const;
    //! Sides that start at the start of s, counter-clockwise: s first, or at the boundary the one
    //! with no face to its right first and the one with no face to its left last.
    std::vector<Side> star(const Side& s) const;
    //! The faces at the start of s, in the order of its star.
    std::vector<Index> faces_around(const Side& s) const;
    std::vector<Index> corners(Index face) const;
    //! One side that starts at each vertex, in order of the mesh vertices.
    std::vector<Side> vertex_sides() const;
    std::vector<PathSide> geometry(const std::vector<Side>& sides) const;

    //! The border of a set of faces, counter-clockwise, when they form a disk with distinct
    //! corners.
    std::optional<std::vector<Side>> border(const std::vector<Index>& faces) const;

    //! Plans new paths in a disk made of whole faces. `border` lists its outer sides
    //! counter-clockwise; `chords`, `disk` and `center` are those of retile().
    //! Empty when the paths do not fit.
    std::optional<Change> plan(std::vector<Index> faces, std::vector<Side> border,
                               std::vector<Chord> chords, const MappedDisk& disk,
                               Index center = invalid_index) const;
    //! The same, mapping the disk first (unless there are no chords).
    std::optional<Change> plan(std::vector<Index> faces, std::vector<Side> border,
                               std::vector<Chord> chords, OverlayBuilder& builder) const;
    //! The borders of the faces that a change makes. \pre the change outlives the result.
    std::vector<std::vector<PathSide>> faces_after(const Change& change) const;
    //! Does a change. Faces and paths that go keep their numbers, as dead ones.
    //! \return the number of the first new face; the others follow.
    Index apply(Change change);

    //! Drops dead faces and paths and numbers the rest anew, in order.
    void compact();

private:
    const ManifoldMesh* mesh_;
    std::vector<Face> faces_;
    std::vector<Path> paths_;
    Index alive_faces_ = 0;
    std::set<Index> pinned_;
    std::set<std::pair<Index, Index>> apart_;
    std::map<Index, Index> wanted_;
    std::map<Index, double> angle_; // Boundary vertices where it is not that of the mesh.
};

} // namespace bot2nurbs
