// SPDX-License-Identifier: MIT
#include "bot2nurbs/refine_domain.h"

#include "core/parallel.h"
#include "domain/domain_paths.h"
#include "domain/quad_marks.h"
#include "domain/refine_vertices.h"
#include "maps/retile.h"

#include <oneapi/tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cassert>
#include <map>
#include <string>

namespace bot2nurbs {

namespace {

//! A path from its other end, or as it is.
SurfacePath walked(const ManifoldMesh& mesh, const SurfacePath& path, bool reversed)
{
    const PathSide side{&path, reversed};
    SurfacePath result;
    result.a = side.start();
    result.b = side.end();
    for (std::size_t i = 0; i < side.node_count(); ++i)
        result.nodes.push_back(side.node(mesh, i));
    return result;
}

//! The two parts of a path at a mesh vertex that it runs through.
std::array<SurfacePath, 2> parts(const SurfacePath& path, Index vertex)
{
    const auto cut = std::find_if(path.nodes.begin(), path.nodes.end(),
                                  [vertex](const PathNode& n) { return n.vertex == vertex; });
    assert(cut != path.nodes.end());
    return {{{path.a, vertex, {path.nodes.begin(), cut}},
             {vertex, path.b, {cut + 1, path.nodes.end()}}}};
}

//! Where the edges of the refined complex run.
class Drawing {
public:
    Drawing(const QuadDomain& domain, const std::vector<char>& marks,
            const RefinedComplex& topology, const RefinedVertices& placed)
        : domain_(domain), marks_(marks), topology_(topology), placed_(placed),
          paths_(topology.complex.edge_count())
    {
    }

    //! The pieces of a quad's chart, cut straight. \return why not, if it fails. Calls for
    //! different quads may run at once.
    const char* cut_quad(Index q, OverlayBuilder& builder)
    {
        const auto disk = map_disk(builder, quad_border(domain_, placed_.paths, q));
        if (!disk)
            return "its region cannot be mapped";
        const QuadComplex& k = topology_.complex;
        const auto place = [&](Index vertex) {
            const auto& all = disk->overlay.vertices;
            const auto found = std::find_if(all.begin(), all.end(), [&](const Overlay::Vertex& v) {
                return v.mesh_vertex == placed_.vertex[vertex];
            });
            assert(found != all.end());
            return static_cast<Index>(found - all.begin());
        };
        const Index begin = topology_.map.first_piece[q], end = topology_.map.first_piece[q + 1];
        std::vector<Segment> segments;
        std::vector<Index> edges;
        for (Index h = 4 * begin; h < 4 * end; ++h) {
            // Each edge between two pieces once, in its own direction.
            const Index twin = k.twin(h), e = k.edge(h);
            const bool between = twin != invalid_index && QuadComplex::quad_of(twin) >= begin &&
                                 QuadComplex::quad_of(twin) < end;
            if (!between || k.halfedge_of_edge(e) != h)
                continue;
            segments.push_back({place(k.from(h)), place(k.to(h))});
            edges.push_back(e);
        }
        auto drawn = draw_segments(placed_.carrier.mesh, disk->overlay, disk->uv, segments);
        if (!drawn)
            return "carrier edges are too short to be crossed once more";
        for (std::size_t i = 0; i < edges.size(); ++i)
            paths_[edges[i]] = std::move((*drawn)[i]);
        return nullptr;
    }

    //! Old edges as they were, or in two parts.
    void keep_old_edges()
    {
        const QuadComplex &old = domain_.complex, &k = topology_.complex;
        std::map<std::pair<Index, Index>, Index> edge_between;
        for (Index e = 0; e < k.edge_count(); ++e) {
            const Index h = k.halfedge_of_edge(e);
            edge_between[std::minmax(k.from(h), k.to(h))] = e;
        }
        const auto put = [&](Index a, Index b, const SurfacePath& path) {
            const Index e = edge_between.at(std::minmax(a, b));
            paths_[e] = walked(placed_.carrier.mesh, path, k.from(k.halfedge_of_edge(e)) != a);
        };
        for (Index e = 0; e < old.edge_count(); ++e) {
            const Index a = domain_.edges[e].a, b = domain_.edges[e].b;
            if (!marks_[e]) {
                put(a, b, placed_.paths[e]);
                continue;
            }
            const Index middle = topology_.middle[e];
            const auto half = parts(placed_.paths[e], placed_.vertex[middle]);
            put(a, middle, half[0]);
            put(middle, b, half[1]);
        }
    }

    std::vector<DomainEdge> edges() const
    {
        const QuadComplex& k = topology_.complex;
        std::vector<DomainEdge> result(k.edge_count());
        for (Index e = 0; e < k.edge_count(); ++e) {
            const Index h = k.halfedge_of_edge(e);
            result[e] = {k.from(h), k.to(h), path_points(placed_.carrier.mesh, paths_[e]),
                         k.is_crease(e)};
        }
        return result;
    }

private:
    const QuadDomain& domain_;
    const std::vector<char>& marks_;
    const RefinedComplex& topology_;
    const RefinedVertices& placed_;
    std::vector<SurfacePath> paths_; // Per edge of the refined complex, in its direction.
};

} // namespace

Result<RefinedDomain> refine_domain(const ManifoldMesh& source, const QuadDomain& domain,
                                    const std::vector<char>& marks, Context& context)
{
    Result<RefinedComplex> topology = refine_complex(domain.complex, marks);
    if (!topology)
        return topology.error();
    Result<RefinedVertices> placed = place_vertices(source, domain, marks, *topology, context);
    if (!placed)
        return placed.error();

    std::vector<Index> quads;
    for (Index q = 0; q < domain.complex.quad_count(); ++q)
        if (marked_sides(domain.complex, marks, q) > 0)
            quads.push_back(q);
    Drawing drawing(domain, marks, *topology, *placed);
    std::vector<const char*> failure(quads.size(), nullptr);
    oneapi::tbb::enumerable_thread_specific<OverlayBuilder> builders(
        [&placed] { return OverlayBuilder(placed->carrier.mesh); });
    if (!for_each_chunk(context, quads.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                failure[i] = drawing.cut_quad(quads[i], builders.local());
        }))
        return Context::cancelled_error("refinement");
    for (std::size_t i = 0; i < quads.size(); ++i)
        if (failure[i])
            return Error{ErrorCode::layout_failed,
                         "quad " + std::to_string(quads[i]) + " cannot be cut: " + failure[i],
                         quads[i]};
    drawing.keep_old_edges();

    RefinedDomain refined;
    refined.domain.source_signature = domain.source_signature;
    refined.domain.origin = domain.origin;
    refined.domain.edges = drawing.edges();
    refined.domain.vertices = std::move(placed->vertex);
    refined.domain.carrier = std::move(placed->carrier);
    refined.domain.complex = std::move(topology->complex);
    refined.map = std::move(topology->map);
    return refined;
}

} // namespace bot2nurbs
