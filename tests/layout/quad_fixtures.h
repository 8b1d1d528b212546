// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/import_quads.h"
#include "mesh_fixtures.h"

#include <functional>

namespace bot2nurbs::fixtures {

//! The quads of a mesh whose triangles 2 k and 2 k + 1 are (a, b, c) and (a, c, d), as those of the
//! grids, tori and polycubes are.
inline PolygonMesh polygons_of_pairs(const ManifoldMesh& mesh)
{
    PolygonMesh polygons;
    polygons.positions = mesh.positions();
    for (Index f = 0; f < mesh.face_count(); f += 2) {
        const auto& t = mesh.triangle(f);
        for (const Index v : {t[0], t[1], t[2], mesh.triangle(f + 1)[2]})
            polygons.polygons.corners.push_back(v);
        polygons.polygons.close();
    }
    return polygons;
}

//! The same as the one piece they must be.
inline QuadMesh quads_of_pairs(const ManifoldMesh& mesh)
{
    Result<std::vector<QuadMesh>> pieces = split_quads(polygons_of_pairs(mesh));
    if (!pieces || pieces->size() != 1)
        std::abort();
    return std::move(pieces->front());
}

inline QuadMesh moved(QuadMesh quads, const std::function<Vec3(const Vec3&)>& f)
{
    for (Vec3& p : quads.positions)
        p = f(p);
    return quads;
}

inline PolygonMesh polygons(std::vector<Vec3> positions,
                            const std::vector<std::vector<Index>>& faces)
{
    PolygonMesh mesh;
    mesh.positions = std::move(positions);
    for (const std::vector<Index>& face : faces) {
        mesh.polygons.corners.insert(mesh.polygons.corners.end(), face.begin(), face.end());
        mesh.polygons.close();
    }
    return mesh;
}

} // namespace bot2nurbs::fixtures
