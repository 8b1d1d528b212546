// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/domain_constraints.h"
#include "mesh_fixtures.h"

#include <cmath>

namespace bot2nurbs::fixtures {

//! The edges of a mesh that turn by more than 60 degrees, each as a path of its own.
inline std::vector<FeaturePath> crease_paths(const ManifoldMesh& mesh)
{
    std::vector<FeaturePath> paths;
    for (Index h = 0; h < mesh.halfedge_count(); ++h) {
        const Index t = mesh.twin(h);
        if (t != invalid_index && h < t &&
            dot(normalized(mesh.area_vector(h / 3)), normalized(mesh.area_vector(t / 3))) < 0.5)
            paths.push_back({FeatureKind::crease, {mesh.from(h), mesh.to(h)}});
    }
    return paths;
}

//! A straight chain of `edges` edges inside an open mesh, away from its boundary.
inline std::vector<Index> straight_run(const ManifoldMesh& mesh, std::size_t edges)
{
    const auto inside = [&mesh](Index v) { return !mesh.is_boundary_vertex(v); };
    for (Index h = 0; h < mesh.halfedge_count(); ++h) {
        std::vector<Index> run{mesh.from(h), mesh.to(h)};
        const Vec3 d = normalized(mesh.position(run[1]) - mesh.position(run[0]));
        bool grown = inside(run[0]) && inside(run[1]);
        while (grown && run.size() <= edges) {
            grown = false;
            Index g = mesh.halfedge_at(run.back());
            const Index first = g;
            do {
                const Vec3 e = normalized(mesh.position(mesh.to(g)) - mesh.position(run.back()));
                if (dot(d, e) > 1.0 - 1e-12 && inside(mesh.to(g))) {
                    run.push_back(mesh.to(g));
                    grown = true;
                    break;
                }
                g = mesh.twin(ManifoldMesh::prev(g));
            } while (g != first && g != invalid_index);
        }
        if (run.size() == edges + 1)
            return run;
    }
    return {};
}

} // namespace bot2nurbs::fixtures
