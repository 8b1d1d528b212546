// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/spline_network.h"

#include <array>
#include <string>
#include <vector>

namespace bot2nurbs {

//! A non-rational B-spline curve in openNURBS convention (no superfluous end knots).
struct BrepCurve3 {
    int order = 4;
    std::vector<double> knots; //!< control.size() + order - 2.
    std::vector<Vec3> control;
};

//! A straight trim curve from a to b in a face's parameter plane, over the domain [0, length].
struct BrepCurve2 {
    Vec2 a, b;
    double t0 = 0.0, t1 = 1.0;
};

struct BrepVertex {
    Vec3 point;
    std::vector<Index> edges; //!< Ends at this vertex; a closed edge is listed twice.
};

struct BrepEdge {
    Index curve = invalid_index; //!< In curves3.
    std::array<Index, 2> vertex{};
    std::vector<Index> trims;
    double t0 = 0.0, t1 = 1.0;
};

enum class TrimType { boundary = 1, mated = 2, seam = 3, singular = 4 };
enum class TrimIso { west = 3, south = 4, east = 5, north = 6 };

struct BrepTrim {
    Index curve = invalid_index; //!< In curves2.
    Index edge = invalid_index;
    std::array<Index, 2> vertex{};
    bool reversed = false; //!< The edge runs against the loop.
    TrimType type = TrimType::mated;
    TrimIso iso = TrimIso::south;
    Index loop = invalid_index;
    double t0 = 0.0, t1 = 1.0;
};

struct BrepLoop {
    std::vector<Index> trims;
    Index face = invalid_index;
};

struct BrepFace {
    std::vector<Index> loops;
    Index surface = invalid_index;
    bool reversed = false;
};

//! A boundary representation in the arrays of ON_Brep: C2, C3, S, V, E, T, L, F.
struct Brep {
    std::vector<BrepCurve2> curves2;
    std::vector<BrepCurve3> curves3;
    std::vector<BsplinePatch> surfaces;
    std::vector<BrepVertex> vertices;
    std::vector<BrepEdge> edges;
    std::vector<BrepTrim> trims;
    std::vector<BrepLoop> loops;
    std::vector<BrepFace> faces;
    bool solid = false; //!< Closed, oriented, outward: set by assemble_brep.
    std::string name;   //!< Object name in files; may be empty.
};

//! One face per patch over its whole parameter rectangle, one edge per domain edge with the curve
//! both patches share, one vertex per domain vertex. Face, edge and vertex numbers are those of the
//! quads, edges and vertices of the complex. A closed B-Rep whose normals point inward gets all its
//! faces reversed, so that the result is outward.
//! Errors: brep_failed when two patches disagree on a shared border, or when check_brep finds a
//! defect; bad_option when the complex and the surface differ in size.
Result<Brep> assemble_brep(const QuadComplex& complex, const SplineSurface& surface, KnotForm form);

//! One violated rule: what and which element of which array.
struct BrepDefect {
    std::string rule; //!< Stable name, such as "trim_iso" or "mated_orientation".
    std::string message;
    Index element = invalid_index;
};

//! What openNURBS' IsValid and IsSolid and BRL-CAD's ON_Brep_Quality_Check look at.
struct BrepReport {
    bool valid = false; //!< No defects.
    bool solid = false; //!< Valid, closed, consistently oriented, normals outward.
    Index boundary_edges = 0;
    Index nonmanifold_edges = 0;
    Index components = 0;         //!< Sets of faces connected over edges.
    int euler_characteristic = 0; //!< V - E + F.
    double max_edge_gap = 0.0;    //!< Largest distance between an edge curve and its faces' sides.
    double volume = 0.0;          //!< Signed, exact for the surfaces up to rounding; 0 when open.
    std::vector<BrepDefect> defects;
    std::vector<BrepDefect> warnings; //!< Worth telling, no reason to refuse.

    //! Sum of the genera of a closed B-Rep's components. \pre valid and closed
    int genus() const { return static_cast<int>(components) - euler_characteristic / 2; }
};

//! Looks at every rule of docs/formats/brep_checks.md. Never fails: a B-Rep with indices out of
//! range gets those defects alone. Cost O(n log n) and one evaluation of every patch.
BrepReport check_brep(const Brep& brep);

} // namespace bot2nurbs
