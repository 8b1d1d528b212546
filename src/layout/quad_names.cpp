// SPDX-License-Identifier: MIT
#include "layout/quad_names.h"

#include "bot2nurbs/validate_domain.h"
#include "layout/quad_boundary.h"

namespace bot2nurbs {

std::string vertex_name(const QuadMesh& quads, Index vertex)
{
    return "vertex " + std::to_string(quads.source_vertex[vertex]) +
           " of the quad mesh (counted from 0)";
}

std::string edge_name(const QuadMesh& quads, const QuadComplex& complex, Index edge)
{
    const Index h = complex.halfedge_of_edge(edge);
    return "edge " + std::to_string(quads.source_vertex[complex.from(h)]) + "-" +
           std::to_string(quads.source_vertex[complex.to(h)]) +
           " of the quad mesh (vertices counted from 0)";
}

Status check_valences(const QuadComplex& complex, const QuadMesh& quads)
{
    const Index most = ValidateOptions().max_valence;
    for (Index v = 0; v < complex.vertex_count(); ++v) {
        std::string wrong;
        if (!is_boundary_vertex(complex, v) && complex.valence(v) < 3)
            wrong = " has two faces only: dissolve it, or add an edge";
        else if (complex.valence(v) > most)
            wrong = " has " + std::to_string(complex.valence(v)) + " faces: at most " +
                    std::to_string(most) + " may meet";
        else
            continue;
        return Error{ErrorCode::invalid_domain, vertex_name(quads, v) + wrong,
                     quads.source_vertex[v]};
    }
    return {};
}

} // namespace bot2nurbs
