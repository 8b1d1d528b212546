// SPDX-License-Identifier: MIT
#include "layout/straighten_domain.h"

#include "domain/domain_paths.h"
#include "layout/curves.h"
#include "layout/straighten_paths.h"

#include <algorithm>
#include <map>
#include <utility>

namespace bot2nurbs {

namespace {

bool runs_along_edges(const SurfacePath& path)
{
    return std::all_of(path.nodes.begin(), path.nodes.end(),
                       [](const PathNode& n) { return n.is_vertex(); });
}

// A domain as a complex of patches. What runs along carrier edges is straight, or a curve that must
// stay.
Result<PatchComplex> patches_of(const QuadDomain& domain)
{
    const QuadComplex& complex = domain.complex;
    PatchComplex patches(domain.carrier.mesh);
    for (Index e = 0; e < complex.edge_count(); ++e) {
        Result<SurfacePath> path = domain_path(domain, e);
        if (!path)
            return path.error();
        const bool stays = runs_along_edges(*path);
        const Index p = patches.add_path(std::move(*path));
        if (stays)
            patches.mark(p, mark_of(FeatureKind::smooth_seam));
    }
    for (Index q = 0; q < complex.quad_count(); ++q) {
        std::vector<PatchComplex::Side> sides;
        for (Index h = 4 * q; h < 4 * q + 4; ++h)
            sides.push_back({complex.edge(h), complex.from(h) != domain.edges[complex.edge(h)].a});
        patches.add_face(std::move(sides));
    }
    return patches;
}

} // namespace

Status straighten_domain(QuadDomain& domain, int passes, Context& context)
{
    Result<PatchComplex> patches = patches_of(domain);
    if (!patches)
        return patches.error();
    if (Status failed = straighten_paths(*patches, passes, context))
        return failed;
    // Paths have other numbers now, but no two edges of a domain have the same ends.
    std::map<std::pair<Index, Index>, Index> edge_between;
    for (Index e = 0; e < domain.edges.size(); ++e)
        edge_between[std::minmax(domain.vertices[domain.edges[e].a],
                                 domain.vertices[domain.edges[e].b])] = e;
    const ManifoldMesh& mesh = domain.carrier.mesh;
    for (const PatchComplex::Path& path : patches->paths()) {
        const SurfacePath& g = path.geometry;
        DomainEdge& edge = domain.edges[edge_between.at(std::minmax(g.a, g.b))];
        const PathSide walk{&g, g.a != domain.vertices[edge.a]};
        SurfacePath walked; // In the direction of the edge.
        walked.a = walk.start();
        walked.b = walk.end();
        for (std::size_t i = 0; i < walk.node_count(); ++i)
            walked.nodes.push_back(walk.node(mesh, i));
        edge.path = path_points(mesh, walked);
    }
    return {};
}

} // namespace bot2nurbs
