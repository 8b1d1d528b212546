// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "bot2nurbs/manifold_mesh.h"

#include <array>
#include <string>
#include <vector>

namespace bot2nurbs {

struct CheckOptions {
    double sharp_angle_deg = 40.0;  //!< Edges whose normals differ by more are counted as sharp.
    bool self_intersections = true; //!< Look for faces that cross; the costliest check.
    Index kept_pairs = 100;         //!< Intersecting pairs kept in the report; all are counted.
};

//! One kind of defect.
struct MeshDefect {
    std::string code;              //!< Stable name: see check_mesh.
    std::string message;           //!< What it is, how often, and where the first one is.
    Index element = invalid_index; //!< The first bad face or vertex, as the message says.
    Index count = 0;
};

//! Faces that hang together across edges with exactly two faces.
struct ComponentReport {
    Index first_face = invalid_index; //!< Smallest face index of the component.
    Index faces = 0, vertices = 0, edges = 0;
    bool closed = false;    //!< Every edge has two faces.
    bool orientable = true; //!< The faces can be turned so that neighbours agree.
    bool oriented = true;   //!< They agree already.
    int genus = 0;          //!< Handles if orientable, cross-caps if not.
    Index boundary_loops = 0;
    double volume = 0.0; //!< Signed, of closed oriented components; 0 of others.
    bool inward = false; //!< Closed, oriented, and the volume is negative.
};

//! What check_mesh found. The mesh is used as it is, but vertices at equal positions count as one
//! in the search for self-intersections.
struct MeshReport {
    Index vertices = 0, faces = 0;
    bool closed = false;     //!< No edge has a single face.
    bool manifold = false;   //!< Two-manifold edges and vertices (boundaries allowed).
    bool orientable = false; //!< All components are.
    bool oriented = false;   //!< All components are.
    std::vector<MeshDefect> defects;
    std::vector<ComponentReport> components;        //!< In the order of their first faces.
    std::vector<std::vector<Index>> boundary_loops; //!< Vertices in order round each hole.
    std::uint64_t self_intersecting_pairs = 0;
    std::vector<std::array<Index, 2>> self_intersections; //!< The first pairs of faces, ascending.
    Index sharp_edges = 0;
    bool complete = true; //!< False when the search for self-intersections was cut short.

    bool has(const std::string& code) const
    {
        for (const MeshDefect& d : defects)
            if (d.code == code)
                return true;
        return false;
    }
};

//! Every check of an input mesh: looks, changes nothing, never fails. Codes of defects:
//! empty, invalid_index, non_finite, repeated_vertex (a face uses a vertex twice), zero_area,
//! duplicate_face, unreferenced_vertex, weldable_vertex (another vertex within the weld tolerance),
//! nonmanifold_edge, nonmanifold_vertex, inconsistent_orientation, non_orientable, open_boundary,
//! inward_component, self_intersection. Faces with an invalid index, a vertex that is not finite or
//! a repeated vertex take no part in the later checks. Cost O(F log F) in practice.
MeshReport check_mesh(const TriangleSoup& soup, const CheckOptions& options, Context& context);
MeshReport check_mesh(const TriangleSoup& soup, Context& context);

} // namespace bot2nurbs
