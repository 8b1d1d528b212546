// SPDX-License-Identifier: MIT
#pragma once

#include "maps/surface_path.h"

#include <array>
#include <optional>
#include <utility>
#include <vector>

namespace bot2nurbs {

//! A triangulated piece of a mesh with disk topology whose border need not follow mesh edges: the
//! mesh faces inside, and those on the border cut along it. Derived when needed and thrown away.
struct Overlay {
    //! Where a vertex lies: on a mesh vertex, on a mesh edge, or inside a mesh face.
    struct Vertex {
        Vec3 position;
        Index mesh_vertex = invalid_index;
        Index edge = invalid_index; //!< With t as in PathNode.
        double t = 0.0;
        Index face = invalid_index; //!< With weights of the face's corners.
        std::array<double, 3> bary{};
    };
    std::vector<Vertex> vertices; //!< The first `boundary_count` are the border, counter-clockwise.
    std::vector<std::array<Index, 3>> triangles; //!< Counter-clockwise.
    std::vector<Index> face;                     //!< Per triangle: the mesh face it is part of.
    Index boundary_count = 0;
    std::vector<Index> corners; //!< Border vertices where a side starts; corners[0] is 0.

    //! Per half edge 3 t + k, side k of triangle t: that of the neighbour, or invalid on the
    //! border.
    std::vector<Index> opposite;

    //! Finds `opposite`. Cost linear. The builder does it for the overlays it makes.
    void find_opposites();
    Index side_count() const { return static_cast<Index>(corners.size()); }
    //! Weights of the corners of mesh face f at a vertex that lies on that face.
    std::array<double, 3> bary_in(const ManifoldMesh& mesh, Index vertex, Index f) const;
};

//! Derives overlays. Keeps scratch arrays of the size of the mesh, so one object serves many calls
//! from one thread; each call costs only what lies inside.
class OverlayBuilder {
public:
    explicit OverlayBuilder(const ManifoldMesh& mesh);

    //! The overlay of the disk to the left of a closed chain of paths, which must not cross and
    //! have distinct corners. Mesh edges inside that join two border points of one side are split
    //! in the middle, so that a convex border does not force triangles to collapse. Empty when the
    //! region is not a disk.
    std::optional<Overlay> disk(const std::vector<PathSide>& sides);

    //! The overlay of the tile of one label, whose vertices are `members`: mixed edges are cut in
    //! the middle, faces with three labels in their centroid; those junctions are the corners. A
    //! tile at the boundary must have `site`, a member there, and has it as its first corner; the
    //! ends of its part of the boundary are corners too. `side_label` receives the label across
    //! each side, invalid_index at the boundary. Empty when the tile is not a disk or has no
    //! junction.
    std::optional<Overlay> tile(const std::vector<Index>& label, const std::vector<Index>& members,
                                Index site, std::vector<Index>& side_label);

    const ManifoldMesh& mesh() const { return mesh_; }

private:
    struct EdgePoint {
        Index edge;
        double t;
        Index id;
    };
    struct Chord {
        Index face, from, to;
    };
    // A point of the border of a tile: a mesh vertex, the middle of an edge, or a junction.
    struct Station {
        Index vertex = invalid_index;
        Index halfedge = invalid_index;
        Index face = invalid_index;
        bool corner = false;
        Index across = invalid_index; //!< Label across the side that follows, where known.
    };
    // A point on the rim of a mesh face while it is being cut: a corner or a border point.
    struct RimPoint {
        Index id;     // Overlay vertex; invalid for a corner that is not one (yet).
        Index corner; // 0, 1, 2, or invalid.
    };
    // What cutting one face needs, kept so that its memory serves the next.
    struct FaceCut {
        std::vector<RimPoint> rim;
        std::vector<std::pair<std::size_t, std::size_t>> ends; // Of each chord, on the rim.
        std::vector<char> done;                                // Chords.
        std::vector<std::size_t> path;                         // Around a piece, on the rim.
    };
    std::vector<Station> walk_around(const std::vector<Index>& label,
                                     const std::vector<Index>& members, Index site) const;

    void next_stamp();
    Index local_vertex(Overlay& overlay, Index mesh_vertex);
    // A polygon of overlay vertices, which may get more.
    void add_polygon(Overlay& overlay, Index face, std::vector<Index>& polygon);
    void split_same_side_edges(const Overlay& before, std::vector<Index>& polygon,
                               Overlay& overlay);
    bool same_side(const Overlay& overlay, Index p, Index q) const;
    bool cut_face(Overlay& overlay, Index face, const Chord* chords, std::size_t count);
    void flood(Overlay& overlay);
    static bool is_disk(const Overlay& overlay);

    const ManifoldMesh& mesh_;
    std::uint32_t stamp_ = 0;
    std::vector<std::uint32_t> vertex_stamp_, face_stamp_;
    std::vector<Index> vertex_local_;
    // State of one call.
    std::vector<EdgePoint> edge_points_;
    std::vector<Chord> chords_;
    std::vector<Index> blocked_; // Halfedges of faces inside that lie on the border; sorted.
    std::vector<Index> pending_; // Faces to visit.
    std::vector<std::array<Index, 2>> vertex_sides_; // Per border vertex: its one or two sides.
    std::vector<std::pair<std::pair<Index, Index>, Index>> midpoints_;
    FaceCut cut_;
    std::vector<Index> polygon_; // Of the face, or the piece of one, that is added next.
};

} // namespace bot2nurbs
