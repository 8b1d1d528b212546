// SPDX-License-Identifier: MIT
#include "layout/quad_carrier.h"

#include "layout/refine_carrier.h"

#include <queue>
#include <tuple>

namespace bot2nurbs {

namespace {

// Carrier edges are at most this part of the edges of the quads there.
constexpr double resolution = 0.4;
// Splits at most, for a face of the source, and besides.
constexpr std::size_t max_refinement_factor = 4;
constexpr std::size_t max_refinement_floor = 20000;

// Longest edge wanted at each vertex of the source: that of the nearest place, over its edges.
std::vector<double> edge_limits(const ManifoldMesh& source, const std::vector<SourcePoint>& places,
                                const std::vector<double>& size)
{
    std::vector<double> limit(source.vertex_count(), 0.0);
    using Entry = std::tuple<double, Index, double>; // Distance, vertex, limit.
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (std::size_t v = 0; v < places.size(); ++v)
        for (const Index m : source.triangle(places[v].face))
            queue.emplace(norm(source.position(m) - source.at(places[v])), m, resolution * size[v]);
    while (!queue.empty()) {
        const auto [distance, m, value] = queue.top();
        queue.pop();
        if (limit[m] > 0.0)
            continue;
        limit[m] = value;
        Index h = source.halfedge_at(m);
        const Index first = h;
        do {
            for (const Index u : {source.to(h), source.from(ManifoldMesh::prev(h))})
                if (!(limit[u] > 0.0))
                    queue.emplace(distance + norm(source.position(u) - source.position(m)), u,
                                  value);
            h = source.twin(ManifoldMesh::prev(h));
        } while (h != first && h != invalid_index);
    }
    return limit;
}

} // namespace

QuadCarrier make_quad_carrier(const ManifoldMesh& source, const std::vector<SourcePoint>& places,
                              const std::vector<double>& size)
{
    CarrierPlan plan;
    plan.limit = edge_limits(source, places, size);
    plan.max_splits = max_refinement_floor + max_refinement_factor * source.face_count();
    plan.marks.assign(source.halfedge_count(), 0);
    plan.points = places;
    PlannedCarrier planned = refine_carrier(source, std::move(plan));
    return {std::move(planned.carrier), std::move(planned.point_vertices)};
}

} // namespace bot2nurbs
