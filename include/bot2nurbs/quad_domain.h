// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "bot2nurbs/manifold_mesh.h"
#include "bot2nurbs/map_level.h"
#include "bot2nurbs/quad_complex.h"
#include "bot2nurbs/surface_samples.h"

#include <array>
#include <string>
#include <vector>

namespace bot2nurbs {

//! One inner point of a path over the carrier mesh: a crossing of the mesh edge from -> to at
//! (1 - t) from + t to with 0 < t < 1, or (from == to) a mesh vertex the path runs through.
struct PathPoint {
    Index from = invalid_index, to = invalid_index;
    double t = 0.0;

    bool is_vertex() const { return from == to; }
};

//! An edge of the domain: a polyline on the carrier mesh from domain vertex a to b. Two consecutive
//! points always lie on one mesh face; a path without inner points runs along a mesh edge.
struct DomainEdge {
    Index a = invalid_index, b = invalid_index;
    std::vector<PathPoint> path;
    bool crease = false;
};

//! The mesh the paths are drawn on: the source mesh, or a refinement of it (faces split where the
//! source has too few triangles for the patches wanted). Vertices 0 .. source vertex count - 1 are
//! the source's own.
struct CarrierMesh {
    ManifoldMesh mesh;
    std::vector<SourcePoint> vertex_source; //!< Per carrier vertex: its place on the source mesh.
    std::vector<Index> face_source;         //!< Per carrier face: the source face it is part of.
    bool refined = false;                   //!< False: the carrier is the source itself.

    //! The source mesh as its own carrier.
    static CarrierMesh from_source(const ManifoldMesh& source);

    //! Weights of a carrier vertex in a source face that it lies on.
    std::array<double, 3> weights(const ManifoldMesh& source, Index vertex, Index face) const;
};

//! A quadrilateral domain K with its map to the source mesh M0: vertices are carrier vertices,
//! edges are non-crossing paths, and each quad's region is mapped to the unit square by the convex
//! harmonic map with sides by arc length (`compute_charts`), so that vertices and paths say all.
struct QuadDomain {
    std::string source_signature; //!< signature() of the source mesh.
    CarrierMesh carrier;
    std::vector<Index> vertices;   //!< Per domain vertex: its carrier vertex.
    std::vector<DomainEdge> edges; //!< Numbered as the edges of `complex`.
    QuadComplex complex;
    std::string origin; //!< "eck", "supplied", ...
};

//! The map of one quad's region to the unit square: the overlay of the carrier's faces with the
//! region, each vertex with its place on the source and its parameters.
struct QuadChart {
    struct Vertex {
        Vec3 position;
        Vec2 uv;
    };
    std::vector<Vertex> vertices;
    std::vector<std::array<Index, 3>> triangles;
    std::vector<Index> source_face; //!< Per triangle.
    MapLevel level = MapLevel::harmonic;
    std::vector<std::array<std::array<double, 3>, 3>>
        bary; //!< Per triangle corner: weights in source_face.
};

//! Charts of all quads, each proved injective: every overlay triangle is positively oriented in uv,
//! decided exactly. Charts of neighbours agree along their common side. Errors: layout_failed
//! naming the quad, cancelled. Same result for any thread count.
Result<std::vector<QuadChart>> compute_charts(const ManifoldMesh& source, const QuadDomain& domain,
                                              Context& context);

//! Per halfedge of the complex: the angle in radians, on the source, of the corner of its quad
//! where it starts. Cost linear.
std::vector<double> corner_angles(const std::vector<QuadChart>& charts);

} // namespace bot2nurbs
