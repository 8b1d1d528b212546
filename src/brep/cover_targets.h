// SPDX-License-Identifier: MIT
#pragma once

//! What cover() needs to know of the two surfaces of a Hausdorff distance.

#include "bot2nurbs/manifold_mesh.h"
#include "brep/bezier_pieces.h"
#include "brep/cover_walk.h"
#include "mesh/closest_on_triangle.h"

#include <optional>

namespace bot2nurbs {

//! A mesh with its vertices moved: topology of one mesh, positions apart.
struct PlacedMesh {
    const ManifoldMesh& topology;
    std::vector<Vec3> positions;
    std::vector<Vec3> normals; //!< Per face, of length one; zero where the face has no area.

    PlacedMesh(const ManifoldMesh& mesh, std::vector<Vec3> positions);
    const Vec3& corner(Index face, int k) const { return positions[topology.triangle(face)[k]]; }
    TriangleCorners corners(Index face) const
    {
        return {corner(face, 0), corner(face, 1), corner(face, 2)};
    }
    //! The point corner 0 + s (corner 1 - corner 0) + t (corner 2 - corner 0).
    Vec3 at(Index face, const Vec2& st) const
    {
        const Vec3& a = corner(face, 0);
        return a + st.x * (corner(face, 1) - a) + st.y * (corner(face, 2) - a);
    }
};

//! A cell of a Bezier piece is covered by triangles of a mesh. Between two triangles the cut
//! follows the plane that halves the angle between them, where both are equally far.
class MeshTarget {
public:
    MeshTarget(const PlacedMesh& mesh, const BezierPieces& pieces, Index piece);

    struct Place {
        Index face = invalid_index;
        Index entry = invalid_index; //!< Halfedge of `face` that was crossed.
    };
    struct Cut {
        Place next;
        Vec3 origin, normal;
        double excess(const CoverVertex& v) const { return dot(v.point - origin, normal); }
    };
    static constexpr int sides = 3;

    void attach(const Place& place, CoverVertex& v) const;
    void enter(const Place&, CoverVertex&) const {}
    PartBound bound(const Place& place, const CoverPolygon& polygon) const;
    Index patch(const Place&) const { return BezierPieces::patch(piece_); }
    std::optional<Cut> cut(const Place& place, int k) const;
    CoverVertex between(const CoverVertex& a, const CoverVertex& b, double t) const;
    //! The vertex at parameters `at`, not attached.
    CoverVertex vertex(const Vec2& at) const;

private:
    const PlacedMesh& mesh_;
    const BezierPieces& pieces_;
    Index piece_;
};

//! A cell of a mesh face is covered by Bezier pieces. Between two pieces the cut follows the line
//! over which the foot crosses their common side.
class SplineTarget {
public:
    SplineTarget(const PlacedMesh& mesh, const BezierPieces& pieces, Index face);

    using Place = BezierPieces::Side; //!< The side is the one entered through, 4 for none.
    static constexpr Index no_side = 4;
    struct Cut {
        Place next;
        Index side = 0;     //!< Of the piece that is left.
        double speed = 0.0; //!< Length per parameter.
        double excess(const CoverVertex& v) const;
    };
    static constexpr int sides = 4;

    void attach(const Place& place, CoverVertex& v) const;
    void enter(const Place& place, CoverVertex& v) const;
    PartBound bound(const Place& place, const CoverPolygon& polygon) const;
    Index patch(const Place& place) const { return BezierPieces::patch(place.piece); }
    std::optional<Cut> cut(const Place& place, int k) const;
    CoverVertex between(const CoverVertex& a, const CoverVertex& b, double t) const;
    //! The vertex at parameters `at`, not attached. `foot`: where its foot may be.
    CoverVertex vertex(const Vec2& at, const Vec2& foot) const;

private:
    const PlacedMesh& mesh_;
    const BezierPieces& pieces_;
    Index face_;
};

} // namespace bot2nurbs
