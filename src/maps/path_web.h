// SPDX-License-Identifier: MIT
#pragma once

#include "maps/surface_path.h"

#include <vector>

namespace bot2nurbs {

//! Non-crossing paths over a mesh, laid one after the other.
//!
//! What is kept is order: of the crossings along every mesh edge, and of the paths around every
//! vertex where some end. So the paths cut each face into *cells*, and a new path that goes from
//! cell to cell through the *stretches* of mesh edges between crossings cannot cross an old one.
//! Where on its stretch a crossing lies never matters.
//!
//! Paths end at *sites*, mesh vertices named in advance. Other vertices are only touched by paths
//! along mesh edges (curves), which other paths cannot cross.
class PathWeb {
public:
    //! A corner of a cell: at the start of `halfedge`, in its face, counter-clockwise of the path
    //! end `after`, or of the halfedge itself when `after` is invalid.
    struct Wedge {
        Index halfedge = invalid_index, after = invalid_index;
        friend bool operator==(const Wedge& a, const Wedge& b)
        {
            return a.halfedge == b.halfedge && a.after == b.after;
        }
    };
    //! A stretch of a mesh edge as seen from the face of `halfedge`: it begins, in the direction of
    //! the halfedge, at crossing `start`, or where the halfedge does when that is invalid.
    struct Stretch {
        Index halfedge = invalid_index, start = invalid_index;
        friend bool operator==(const Stretch& a, const Stretch& b)
        {
            return a.halfedge == b.halfedge && a.start == b.start;
        }
    };
    //! What lies between two neighbouring path ends at a vertex: the corners of cells, and the mesh
    //! edges between them, as halfedges that start at the vertex.
    struct Sector {
        std::vector<Wedge> wedges;
        std::vector<Index> halfedges;
    };
    //! A way for a path that crosses no other: through stretches, each as seen from the face it
    //! leaves, or along mesh edges.
    struct Route {
        Index a = invalid_index, b = invalid_index; //!< Mesh vertices.
        Wedge from, to;
        std::vector<Stretch> stretches;
        std::vector<double> t; //!< Wanted place of each crossing, as PathNode::t.
        //! Where it needs no stretch: the mesh vertices from a to b, neighbours joined by edges.
        std::vector<Index> along;
    };

    //! `sites` are the mesh vertices where paths may end.
    PathWeb(const ManifoldMesh& mesh, const std::vector<Index>& sites);

    const ManifoldMesh& mesh() const { return mesh_; }
    Index path_count() const { return static_cast<Index>(paths_.size()); }

    //! Adds a path along mesh edges through the given vertices; only its ends may be sites.
    //! \pre no path uses those edges or runs through the vertices between
    void add_curve(const std::vector<Index>& vertices);
    //! Adds a path. \pre nothing was added since the route was found
    void add(const Route& route);
    //! Takes the path added last, which must not be a curve of the boundary, away again.
    void remove_last();

    //! Path ends are numbered 2 p at the start and 2 p + 1 at the end of path p.
    static Index end_of(Index path, bool last) { return 2 * path + (last ? 1 : 0); }
    //! The ends at a site, counter-clockwise.
    const std::vector<Index>& ends(Index site) const { return ends_[site_of_[site]]; }
    //! The sector counter-clockwise of a path end at a site; with invalid_index, where no path ends
    //! yet, all around.
    Sector sector(Index site, Index after) const;
    //! The path end whose sector a wedge at a site is part of; invalid_index where no path ends.
    Index sector_of(const Wedge& wedge) const;

    //! The corners of cells to both sides of a path where it starts.
    Wedge left_of(Index path) const;
    Wedge right_of(Index path) const;

    bool is_site(Index vertex) const { return site_of_[vertex] != invalid_index; }
    //! The number of a vertex among the sites.
    Index site_number(Index vertex) const { return site_of_[vertex]; }
    //! Whether a path along mesh edges runs through a vertex that is no site.
    bool on_curve(Index vertex) const { return on_curve_[vertex] != 0; }
    //! No path can cross the edge of h: it is part of a curve or the boundary.
    bool is_closed(Index h) const { return closed_[mesh_.edge(h)] != 0; }

    //! The first stretch of the border of the cell at a wedge.
    Stretch border_start(const Wedge& wedge) const;
    //! The same stretch seen from the other face. \pre it is not closed
    Stretch across(const Stretch& s) const;
    //! A number for a stretch, the same from both faces: below stretch_count().
    Index number(const Stretch& s) const;
    Index stretch_count() const
    {
        return mesh_.halfedge_count() + static_cast<Index>(crossings_.size());
    }
    //! Ends of a stretch as parameters on its edge, ascending.
    std::pair<double, double> range(const Stretch& s) const;

    //! Once around the cell left of a stretch, counter-clockwise: on_stretch for each stretch of
    //! its border that can be crossed, on_wedge for each corner.
    template <class OnStretch, class OnWedge>
    void walk_cell(const Stretch& start, const OnStretch& on_stretch, const OnWedge& on_wedge) const
    {
        Stretch s = start;
        do {
            if (!is_closed(s.halfedge))
                on_stretch(s);
            const Wedge w = next_wedge(s);
            if (w.halfedge != invalid_index) {
                on_wedge(w);
                s = border_start(w);
            }
        } while (!(s == start));
    }

    //! Whether the whole edge of h is free: closed to nobody, and crossed by no path.
    bool is_free(Index h) const
    {
        return !is_closed(h) && first_on_[mesh_.edge(h)] == invalid_index;
    }

    //! All paths, in the order of adding them, their crossings apart from each other by
    //! 0.02 of an edge where there is room.
    std::vector<SurfacePath> paths() const;

private:
    struct Crossing {
        Index halfedge = invalid_index; //!< Of the face the path leaves.
        Index path = invalid_index;
        Index before = invalid_index, after = invalid_index; //!< Along the path.
        Index low = invalid_index, high = invalid_index;     //!< Along the edge.
        double t = 0.0;
    };
    struct Path {
        Index a = invalid_index, b = invalid_index;
        Index first = invalid_index, last = invalid_index; //!< Crossings.
        std::vector<Index> inner; //!< Along mesh edges: vertices on the way.
    };
    //! How a path leaves the vertex where it ends.
    struct End {
        //! The halfedge from the vertex, in whose face or along which; none at the last edge of a
        //! boundary.
        Index corner = invalid_index;
        Index crossing = invalid_index; //!< Across that face to here; invalid: along the edge.
        Index rank = 0; //!< Number of faces counter-clockwise before it at the vertex.

        bool is_along() const { return crossing == invalid_index; }
    };

    Index rank(Index corner) const;
    //! The last end in a corner of a face, and the end before another there; or invalid_index.
    Index last_in(Index corner) const;
    Index before_in(Index corner, Index end) const;
    Index first_in(Index corner) const;
    Index after_in(Index corner, Index end) const;
    //! The crossing after another in the direction of a halfedge.
    Index following(Index h, Index crossing) const;
    //! The halfedge of a face that a crossing lies on.
    Index in_face(Index crossing, Index face) const;
    //! Goes on along the border of a cell behind a stretch: as far as a corner, or, with an invalid
    //! wedge, as far as the next stretch, which s becomes.
    Wedge next_wedge(Stretch& s) const;
    void add_end(Index end, Index vertex, const Wedge& wedge, Index crossing);
    void add_end_along(Index end, Index vertex, Index other);
    void drop_end(Index end, Index vertex);
    //! Closes the mesh edges of a path along them, or opens them again.
    void set_closed(const Path& path, bool closed);
    Index insert_crossing(const Stretch& s, double t, Index path);
    void space_evenly(Index edge);

    const ManifoldMesh& mesh_;
    std::vector<Index> site_of_; //!< Per vertex: its place in ends_.
    std::vector<std::vector<Index>> ends_;
    std::vector<End> end_; //!< Per path end.
    std::vector<Path> paths_;
    std::vector<Crossing> crossings_;
    std::vector<Index> first_on_, last_on_; //!< Per edge, by its name.
    std::vector<char> closed_;              //!< Per edge, by its name.
    std::vector<char> on_curve_;            //!< Per vertex.
};

} // namespace bot2nurbs
