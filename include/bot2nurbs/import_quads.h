// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/detect_features.h"
#include "bot2nurbs/polygon_mesh.h"
#include "bot2nurbs/quad_domain.h"

#include <array>
#include <vector>

namespace bot2nurbs {

//! One connected mesh of quads: manifold, consistently oriented, every vertex used.
struct QuadMesh {
    std::vector<Vec3> positions;
    std::vector<std::array<Index, 4>> quads;
    //! Numbers in the polygons it was made of, for messages.
    std::vector<Index> source_vertex, source_face;
};

//! The connected pieces of polygons that are all quads, in the order of their first faces. Boundary
//! vertices that agree are welded, faces turned to agree with the first of their piece, unused
//! vertices left out.
//! Errors: invalid_domain, naming the face, edge or vertex in the numbers of `mesh`: a face with
//! other than four corners, a corner used twice, an edge with more than two faces, faces that
//! cannot be turned to agree, a vertex where several fans meet, a T-junction.
Result<std::vector<QuadMesh>> split_quads(const PolygonMesh& mesh);

//! A domain made of a quad mesh.
struct QuadImport {
    QuadDomain domain;
    Index crease_edges = 0; //!< Edges of the domain that are creases.
    //! Edges of the source's creases that no quad edge runs along, as their vertices: smoothed
    //! over.
    std::vector<std::array<Index, 2>> smoothed;
    double largest_move = 0.0;             //!< Of a vertex, from where it was given to the source.
    Index farthest_vertex = invalid_index; //!< That vertex, as in `domain`.
};

//! Makes a quad mesh near the source its domain: the topology is that of the quads, numbered as
//! they are; vertices move to their closest points on the source (of those facing their way), and
//! edges become paths over it that do not cross, drawn anew as straight lines in the maps of their
//! two quads.
//!
//! The boundary of the quads becomes that of the source. Creases of the source that quad edges
//! follow become creases of the domain; the others are listed.
//!
//! Guarantee: what comes out is a valid domain (validate_domain). Errors, all invalid_domain and
//! naming the element as it was in the polygons: the quads differ from the source in genus or
//! number of boundary loops; a vertex farther from the source than its edges are long; an inner
//! vertex with fewer than three quads or one with too many; an edge that cannot be drawn, which is
//! possible only around handles. Also cancelled. Cost O(n log n).
Result<QuadImport> import_quads(const ManifoldMesh& source, const QuadMesh& quads,
                                const MeshFeatures& features, Context& context);

} // namespace bot2nurbs
