// SPDX-License-Identifier: MIT
#include "bot2nurbs/quad_domain.h"

#include <numeric>

namespace bot2nurbs {

CarrierMesh CarrierMesh::from_source(const ManifoldMesh& source)
{
    CarrierMesh carrier;
    carrier.mesh = source;
    carrier.vertex_source.resize(source.vertex_count());
    for (Index v = 0; v < source.vertex_count(); ++v) {
        const Index h = source.halfedge_at(v);
        SourcePoint& point = carrier.vertex_source[v];
        point.face = ManifoldMesh::face(h);
        point.bary[h % 3] = 1.0;
    }
    carrier.face_source.resize(source.face_count());
    std::iota(carrier.face_source.begin(), carrier.face_source.end(), Index{0});
    return carrier;
}

std::array<double, 3> CarrierMesh::weights(const ManifoldMesh& source, Index vertex,
                                           Index face) const
{
    const SourcePoint& point = vertex_source[vertex];
    if (point.face == face)
        return point.bary;
    // It lies on an edge or vertex that both faces have: match corners.
    std::array<double, 3> w{};
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            if (source.triangle(point.face)[i] == source.triangle(face)[k])
                w[k] = point.bary[i];
    return w;
}

} // namespace bot2nurbs
