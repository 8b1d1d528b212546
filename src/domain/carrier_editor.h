// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/quad_domain.h"
#include "maps/surface_path.h"

#include <vector>

namespace bot2nurbs {

//! A carrier and paths on it, while edges of the carrier are split. The paths stay where they are:
//! where a new carrier edge meets one, that gets a crossing, and the order of crossings along each
//! edge is found from how paths separate the edge's ends, without rounding. Numbers of vertices
//! never change; halfedges 3 f + k as in ManifoldMesh, but a split renumbers those of its faces.
class CarrierEditor {
public:
    //! A point of a path: a carrier vertex, or a crossing of a carrier edge.
    struct Node {
        Index vertex = invalid_index;
        Index halfedge = invalid_index; //!< Crossing: of the face the path leaves, walking forward.
        double t = 0.0; //!< Crossing: of its edge, from the start that the edge has.
        Index previous = invalid_index, next = invalid_index; //!< On the path.

        bool is_vertex() const { return vertex != invalid_index; }
    };

    //! Paths may not cross each other or themselves. The source must outlive the editor.
    CarrierEditor(const ManifoldMesh& source, const CarrierMesh& carrier,
                  const std::vector<SurfacePath>& paths);

    static Index next(Index h) { return h % 3 == 2 ? h - 2 : h + 1; }
    static Index prev(Index h) { return h % 3 == 0 ? h + 2 : h - 1; }
    Index face_count() const { return static_cast<Index>(triangles_.size()); }
    Index from(Index h) const { return triangles_[h / 3][h % 3]; }
    Index to(Index h) const { return from(next(h)); }
    Index twin(Index h) const { return twin_[h]; }
    double length(Index h) const { return norm(positions_[to(h)] - positions_[from(h)]); }
    //! The longest side of a face; of equally long ones the first.
    Index longest_side(Index face) const;

    const Node& node(Index n) const { return nodes_[n]; }
    Index first_node(Index path) const { return first_[path]; }
    Vec3 position(Index n) const;
    //! The edge to halve so that the path gets a node between this one and the next, if not at once
    //! then after a few times: the one it runs along, or the longest of the face it crosses.
    Index halfedge_to_halve(Index n) const;

    //! Splits an edge near its middle, between its crossings. The side of h gets the next face
    //! number, that of the twin the one after. \return the new vertex.
    Index halve(Index h);
    //! Splits the edge that a path crosses where it does: the crossing becomes a carrier vertex.
    //! \return that vertex; that of the node where it is one already.
    Index make_vertex(Index n);

    //! The carrier as it is now.
    CarrierMesh carrier() const;
    //! The paths on `mesh`, the mesh of carrier().
    std::vector<SurfacePath> paths(const ManifoldMesh& mesh) const;

private:
    //! What lies on a carrier edge.
    struct Edge {
        Index start = invalid_index;  //!< The vertex from which t counts.
        std::vector<Index> crossings; //!< Nodes, t ascending.
        Index run = invalid_index;    //!< The node after which a path runs along the edge, if any.
    };
    //! A step of a path that a new edge cuts.
    struct Cut {
        Index node;        //!< The step runs from this node to the next one.
        Index right, left; //!< Places of its ends around the face, from the new vertex on.
        bool from_right;   //!< It starts at the right end.
        double t;          //!< Where on the new edge, from the new vertex on.
    };
    //! What a split does on one side of the edge.
    struct Side {
        Index halfedge = invalid_index;
        std::vector<Cut> cuts;       //!< In order from the new vertex on.
        Index run = invalid_index;   //!< The step that runs along the new edge.
        Index added = invalid_index; //!< The new face.
    };

    //! Where an edge is split, in terms of its record.
    struct Split {
        double t;
        std::size_t before, after; //!< Crossings before it; the first one after it.
        Index crossing;            //!< The node that becomes the vertex, if any.
    };

    Index split(Index h, double t, Index crossing);
    Side plan_side(Index h, const Split& split) const;
    void split_edge(Index edge, const Split& split, Index vertex);
    void split_side(Side& side, Index vertex);
    double parameter(Index h, const Node& node) const;
    void add_cuts(const Side& side, Index vertex);
    void space(Edge& edge);
    void rename(const Edge& edge, Index from, Index to);
    void insert_after(Index n, Index added);
    void join(Index g, Index h);
    Index find_halfedge(Index a, Index b) const;

    const ManifoldMesh& source_;
    CarrierMesh carrier_; //!< Its mesh is the one before all splits.
    std::vector<Vec3> positions_;
    std::vector<std::array<Index, 3>> triangles_;
    std::vector<Index> twin_;
    std::vector<Index> halfedge_at_; //!< Per vertex: one that starts there.
    std::vector<Index> edge_of_;     //!< Per halfedge, in edges_.
    std::vector<Edge> edges_;
    std::vector<Node> nodes_;
    std::vector<Index> first_; //!< Per path: its first node.
};

} // namespace bot2nurbs
