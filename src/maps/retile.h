// SPDX-License-Identifier: MIT
#pragma once

#include "maps/convex_map.h"

#include <optional>
#include <vector>

namespace bot2nurbs {

//! A straight segment to be drawn in a mapped overlay between two of its vertices.
struct Segment {
    Index from, to; //!< Overlay vertices; both mesh vertices, or `to` a point on a mesh edge.
};

//! Draws straight segments in an injective map of an overlay to a convex polygon and pulls them
//! back to the mesh: for each, the mesh edges crossed in order. Segments may share ends but not
//! cross. Crossings of one stretch of a mesh edge are put in the order in which the segments
//! separate its ends, decided exactly, with distinct parameters. A segment through a vertex passes
//! to its right. Paths whose end lies on a mesh edge are left open there (b is invalid); all others
//! are reduced. Empty when a stretch is too short to hold distinct crossings.
std::optional<std::vector<SurfacePath>> draw_segments(const ManifoldMesh& mesh,
                                                      const Overlay& overlay,
                                                      const std::vector<Vec2>& uv,
                                                      const std::vector<Segment>& segments);

//! A disk and its map to a regular polygon (a square when it has four sides).
struct MappedDisk {
    Overlay overlay;
    std::vector<Vec2> uv;
};

//! Empty when the region to the left of the border is not a disk or cannot be mapped.
std::optional<MappedDisk> map_disk(OverlayBuilder& builder, const std::vector<PathSide>& border);

//! The one primitive of layout changes: new paths inside a mapped disk. `chords` join corners of
//! the border, by number; they may share ends but not cross. With `center`, a mesh vertex inside
//! the disk, a chord {k, invalid_index} joins corner k to it. Empty when the paths do not fit.
std::optional<std::vector<SurfacePath>> retile(const ManifoldMesh& mesh, const MappedDisk& disk,
                                               const std::vector<std::pair<Index, Index>>& chords,
                                               Index center = invalid_index);

} // namespace bot2nurbs
