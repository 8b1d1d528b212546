// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/quad_domain.h"
#include "bot2nurbs/surface_samples.h"

#include <array>
#include <vector>

namespace bot2nurbs {

//! What cutting quads costs, for close_marks(): any unit, none negative.
struct MarkCosts {
    //! Per quad: of halving its sides 0 and 2 (its range of u), and its sides 1 and 3 (of v).
    //! Halving all four sides costs the sum.
    std::vector<std::array<double, 2>> halve;
    //! Per quad and corner k: of halving the two sides that do not meet corner k, which makes three
    //! quads and gives corner k one quad more. At opposite corners together at least as much as
    //! halving all sides.
    std::vector<std::array<double, 4>> turn;
    //! No vertex gets more quads than this, unless it had more before.
    Index max_valence = 8;

    //! Costs in numbers of new quads, with a surcharge for irregular vertices: a vertex that gets a
    //! fifth quad is dear, a sixth dearer, one that gets its fourth is cheap. Between sharp edges
    //! there should be a quad for every right angle of `corner_angles` (see
    //! build_spline_network()), or two where they are not given.
    static MarkCosts of_regularity(const QuadComplex& complex,
                                   const std::vector<double>& corner_angles = {});
    //! The sum over all quads for marked edges of which every quad has none, two or four.
    double total(const QuadComplex& complex, const std::vector<char>& marks) const;
};

//! Adds to marked edges (one entry an edge, not zero: marked) what it takes to leave every quad
//! with none, two or four: of all ways to do so the cheapest. Always possible.
//!
//! Marked edges are the edges of a subgraph of the dual graph with even degrees: what is added is a
//! minimum-weight T-join, found as a perfect matching \cite edmonds_1973. Where that would give a
//! vertex too many quads its turns are put out of reach and the rest is found anew. Cost O(n^2 log
//! n) in the worst case for n quads, in practice little more than linear.
std::vector<char> close_marks(const QuadComplex& complex, const std::vector<char>& marks,
                              const MarkCosts& costs);

//! A quad of a refined complex, as a piece of the quad it was part of.
struct QuadPiece {
    Index parent = invalid_index;
    //! In the unit square of the parent, counter-clockwise from the quad's corner 0; u and v run
    //! roughly as the parent's.
    std::array<Vec2, 4> corners{};
};

//! Which piece of which quad each quad of a refined complex is.
struct PieceMap {
    std::vector<QuadPiece> pieces; //!< Per quad of the refined complex.
    //! Per old quad: its first piece; its pieces follow each other. One more entry at the end.
    std::vector<Index> first_piece;

    //! The same place in the old complex: bilinear in the piece's corners.
    DomainPoint to_parent(const DomainPoint& place) const;
    //! The same place in the refined complex, the inverse of to_parent() up to rounding. A place on
    //! several pieces goes to the first of them. Places of two quads that are one point of their
    //! common edge stay one point.
    DomainPoint to_piece(const DomainPoint& place) const;
};

//! A complex after one round of refinement.
struct RefinedComplex {
    QuadComplex complex;
    PieceMap map;
    std::vector<Index> middle; //!< Per old edge: the vertex in its middle, or invalid_index.
    std::vector<Index> center; //!< Per old quad: the vertex inside it, or invalid_index.
};

//! Cuts the quads with marked edges: two opposite marks make two quads, two adjacent ones three
//! around a new vertex, four make two by two (Eck and Hoppe 1996, section 5). Vertices keep their
//! numbers; those in the middle of edges follow in the order of the edges, then those inside quads.
//! Halves of a crease are creases. Errors: bad_option naming a quad with one or three marks.
Result<RefinedComplex> refine_complex(const QuadComplex& complex, const std::vector<char>& marks);

//! A domain after one round of refinement.
struct RefinedDomain {
    QuadDomain domain;
    PieceMap map;
};

//! Refines a domain on its source: its complex as refine_complex() does, with paths drawn straight
//! in the charts of the quads they cut.
//!
//! 1. The result satisfies every rule of validate_domain() that the domain does; carrier vertices
//!    keep their numbers, and so do domain vertices.
//! 2. Paths of edges that are not cut run where they ran, those of edges that are cut go through
//!    the new vertex, which is within a tenth of their length of their middle.
//! 3. The carrier grows by a number of faces proportional to that of the new quads: where these
//!    would have too few, its longest edges are halved.
//! 4. The same for any thread count.
//!
//! \pre the domain is valid. Errors: bad_option naming a quad with one or three marks,
//! layout_failed naming a quad that cannot be cut, cancelled.
Result<RefinedDomain> refine_domain(const ManifoldMesh& source, const QuadDomain& domain,
                                    const std::vector<char>& marks, Context& context);

} // namespace bot2nurbs
