// SPDX-License-Identifier: MIT
#pragma once

#include "maps/retile.h"

#include <optional>
#include <utility>
#include <vector>

namespace bot2nurbs {

//! A division of a closed mesh into disks by non-crossing paths: K_tri while all faces have three
//! sides, K once all have four. Changed only by exchanging paths inside a disk, which either
//! succeeds or leaves everything as it was, so that every state is a valid complex with its exact
//! map to the mesh.
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
        bool alive() const { return !sides.empty(); }
    };
    struct Path {
        SurfacePath geometry;                              //!< Ends are mesh vertices.
        Index left = invalid_index, right = invalid_index; //!< Faces when walked forward.
        bool alive = false;
    };

    PatchComplex(const ManifoldMesh& mesh) : builder_(mesh) {}

    const ManifoldMesh& mesh() const { return builder_.mesh(); }
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
    Index face_at(const Side& s) const
    {
        return s.reversed ? paths_[s.path].right : paths_[s.path].left;
    }
    //! Position of a side in its face.
    Index position(const Side& s) const;
    //! The side after or before s in its face.
    Side next(const Side& s) const;
    Side previous(const Side& s) const;
    //! Sides that start at the start of s, counter-clockwise, s first.
    std::vector<Side> star(const Side& s) const;
    std::vector<Index> corners(Index face) const;

    //! Replaces a set of faces that form a disk. `border` lists the disk's outer sides
    //! counter-clockwise, `inner` the paths inside that go, `chords` the new paths as in retile().
    //! The new faces are the last ones of faces().
    //! \return false when the disk cannot be mapped; nothing is changed then.
    bool replace(const std::vector<Index>& old_faces, const std::vector<Side>& border,
                 const std::vector<std::pair<Index, Index>>& chords);
    //! The same in a disk that was mapped before.
    bool replace(const std::vector<Index>& old_faces, const std::vector<Side>& border,
                 const std::vector<std::pair<Index, Index>>& chords, const MappedDisk& disk,
                 Index center = invalid_index);
    //! Number of faces the last replace() made.
    Index new_face_count() const
    {
        return static_cast<Index>(faces_.size()) - last_.first_new_face;
    }
    //! Takes the last replace() back. At most once after each.
    void undo();

    //! The border of a set of faces, counter-clockwise, when they form a disk with distinct
    //! corners.
    std::optional<std::vector<Side>> border(const std::vector<Index>& faces) const;

    std::optional<Overlay> overlay(Index face);
    //! The overlay of a disk, derived by a builder of the caller's own: safe from several threads.
    std::optional<Overlay> overlay(const std::vector<Side>& border, OverlayBuilder& builder) const;
    std::optional<MappedDisk> mapped(const std::vector<Side>& border);

    //! Drops dead faces and paths and numbers the rest anew, in order.
    void compact();

private:
    //! What the last replace() did.
    struct Change {
        std::vector<std::pair<Index, std::vector<Side>>> removed_faces;
        std::vector<Index> removed_paths;
        Index first_new_face = 0, first_new_path = 0;
    };

    std::vector<PathSide> geometry(const std::vector<Side>& sides) const;
    void exchange(const std::vector<Index>& old_faces, const std::vector<Side>& border,
                  const std::vector<std::pair<Index, Index>>& chords,
                  std::vector<SurfacePath> drawn);

    OverlayBuilder builder_;
    std::vector<Face> faces_;
    std::vector<Path> paths_;
    Index alive_faces_ = 0;
    Change last_;
};

} // namespace bot2nurbs
