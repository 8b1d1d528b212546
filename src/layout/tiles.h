// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "bot2nurbs/manifold_mesh.h"

#include <vector>

namespace bot2nurbs {

//! Voronoi tiles of a mesh, by labels on its vertices (Eck et al. 1995, section 4). Since a face
//! has at most three labels, at most three tiles meet at a point.
//!
//! Distances grow from all sites at once over edges and, across a face, from the unfolded source of
//! two corners, so that they do not follow the grain of the mesh. They are measured in the metric
//! scaled by `density`: where it is two, tiles are half as wide.
//!
//! Boundary vertices belong to sites on the boundary, each to the nearest along it: so a cut
//! between tiles meets the boundary only between two sites that follow each other there. Every
//! boundary loop needs a site.
class Tiles {
public:
    Tiles(const ManifoldMesh& mesh, std::vector<double> density);

    //! Sites at these vertices stay where they are when others are relaxed.
    void fix(const std::vector<Index>& vertices);
    //! The vertex farthest from its site at the cut between the tiles of two sites, itself no site;
    //! invalid_index when they have no cut or no such vertex.
    Index between(Index site_a, Index site_b) const;

    const ManifoldMesh& mesh() const { return mesh_; }
    const std::vector<Index>& sites() const { return sites_; }  //!< Per tile: its mesh vertex.
    const std::vector<Index>& labels() const { return label_; } //!< Per mesh vertex: its tile.
    const std::vector<double>& distances() const { return distance_; }

    //! Starts anew from the given sites. Cost O(n log n). \pre one on every boundary loop, and one
    //! in every component
    void grow(std::vector<Index> sites);
    //! Adds sites, changing only what is nearer to them.
    void add(const std::vector<Index>& sites);
    //! Adds the inner vertex farthest from all sites until there are `count`.
    void add_farthest(Index count);
    //! Moves every inner site to the vertex of its tile nearest to the tile's centroid, and grows
    //! anew (one round of Lloyd's relaxation).
    void relax();

    //! Vertices that must become sites because a condition fails: a tile that is not a disk, two
    //! tiles that share more than one connected cut, a tile with fewer than three neighbours (two
    //! at the boundary). Empty when the dual of the tiles is a simplicial complex. Adding them
    //! again and again ends: with every vertex a site the dual is the mesh itself.
    std::vector<Index> violations() const;

    //! Vertices of each tile, as one list in tile order: members[offset[i]] ..
    //! members[offset[i+1]-1].
    void list_members(std::vector<Index>& offset, std::vector<Index>& members) const;

private:
    // One tile while its conditions are looked at.
    struct Outline {
        bool disk = false;
        bool open = false;             //!< It has a part of the boundary.
        std::vector<Index> neighbours; //!< Once around, each run of a label once.
        std::vector<Index> farthest;   //!< Per run: the vertex at the cut farthest from its site.
        Index farthest_member = invalid_index;
    };
    Index farther(Index a, Index b) const;
    Outline outline(Index tile, const Index* members, const Index* end) const;

    void propagate(const std::vector<Index>& seeds, bool along_boundary);

    const ManifoldMesh& mesh_;
    std::vector<double> density_;
    std::vector<double> area_;      // Per vertex: a third of the faces around.
    std::vector<char> on_boundary_; // Per vertex.
    std::vector<char> fixed_;       // Per vertex: a site there does not move.
    std::vector<Index> sites_;
    std::vector<Index> label_;
    std::vector<double> distance_;
};

} // namespace bot2nurbs
