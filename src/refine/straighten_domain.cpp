// SPDX-License-Identifier: MIT
#include "refine/straighten_domain.h"

#include "domain/domain_paths.h"
#include "layout/patch_complex.h"
#include "layout/straighten_paths.h"

#include <algorithm>
#include <map>
#include <utility>

namespace bot2nurbs {

namespace {

// A second one makes the layout no better, and each takes a map an edge.
constexpr int passes = 1;

bool runs_along_edges(const SurfacePath& path)
{
    return std::all_of(path.nodes.begin(), path.nodes.end(),
                       [](const PathNode& node) { return node.is_vertex(); });
}

// The domain with its edges drawn anew.
Result<QuadDomain> straightened(QuadDomain domain, Context& context)
{
    const QuadComplex& complex = domain.complex;
    PatchComplex patches(domain.carrier.mesh);
    for (Index e = 0; e < complex.edge_count(); ++e) {
        Result<SurfacePath> path = domain_path(domain, e);
        if (!path)
            return path.error();
        const bool fixed = complex.is_sharp(e) || runs_along_edges(*path);
        const Index p = patches.add_path(std::move(*path));
        if (fixed)
            patches.mark(p, 1);
    }
    for (Index q = 0; q < complex.quad_count(); ++q) {
        std::vector<PatchComplex::Side> sides;
        for (Index h = 4 * q; h < 4 * q + 4; ++h)
            sides.push_back({complex.edge(h), complex.from(h) != domain.edges[complex.edge(h)].a});
        patches.add_face(std::move(sides));
    }
    if (Status failed = straighten_paths(patches, passes, context))
        return *failed;
    // The numbers of paths have changed, but no two edges of a domain have the same ends.
    std::map<std::pair<Index, Index>, Index> edge_between;
    for (Index e = 0; e < complex.edge_count(); ++e)
        edge_between[std::minmax(domain.vertices[domain.edges[e].a],
                                 domain.vertices[domain.edges[e].b])] = e;
    for (const PatchComplex::Path& path : patches.paths()) {
        const SurfacePath& g = path.geometry;
        DomainEdge& edge = domain.edges[edge_between.at(std::minmax(g.a, g.b))];
        const PathSide walk{&g, g.a != domain.vertices[edge.a]};
        SurfacePath walked; // In the direction of the edge.
        walked.a = walk.start();
        walked.b = walk.end();
        for (std::size_t i = 0; i < walk.node_count(); ++i)
            walked.nodes.push_back(walk.node(domain.carrier.mesh, i));
        edge.path = path_points(domain.carrier.mesh, walked);
    }
    return domain;
}

} // namespace

Result<QuadDomain> straighten_domain(const ManifoldMesh& source, QuadDomain domain,
                                     Context& context)
{
    Result<QuadDomain> straight = straightened(domain, context);
    if (!straight)
        return straight;
    const Result<std::vector<QuadChart>> charts = compute_charts(source, *straight, context);
    if (charts)
        return straight;
    if (charts.error().code == ErrorCode::layout_failed)
        return domain;
    return charts.error();
}

} // namespace bot2nurbs
