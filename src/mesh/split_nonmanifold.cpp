// SPDX-License-Identifier: MIT
#include "mesh/split_nonmanifold.h"

#include <algorithm>

namespace bot2nurbs {

namespace {

//! A triangle at an edge, seen against the edge's direction.
struct Spoke {
    double angle = 0.0;
    Index halfedge = invalid_index;
    bool forward = false; //!< Its halfedge runs along the edge: its back is on the clockwise side.
};

std::vector<Spoke> spokes(const std::vector<Vec3>& positions, const SoupTopology& topology, Index e)
{
    const auto [first, last] = topology.halfedges(e);
    const Index a = std::min(topology.from(*first), topology.from(SoupTopology::next(*first)));
    const Index b = std::max(topology.from(*first), topology.from(SoupTopology::next(*first)));
    const Vec3 along = normalized(positions[b] - positions[a]);
    Vec3 u, v;
    std::vector<Spoke> list;
    for (const Index* h = first; h != last; ++h) {
        const Index apex = topology.from(SoupTopology::next(SoupTopology::next(*h)));
        Vec3 d = positions[apex] - positions[a];
        d -= dot(d, along) * along;
        if (h == first) {
            u = normalized(d);
            v = cross(along, u);
        }
        list.push_back({std::atan2(dot(d, v), dot(d, u)), *h, topology.from(*h) == a});
    }
    std::sort(list.begin(), list.end(), [](const Spoke& x, const Spoke& y) {
        return x.angle < y.angle || (x.angle == y.angle && x.halfedge < y.halfedge);
    });
    return list;
}

} // namespace

SplitCount split_nonmanifold(const std::vector<Vec3>& positions, SoupTopology& topology)
{
    SplitCount count;
    for (Index e = 0; e < topology.edge_count(); ++e) {
        if (topology.face_count(e) <= 2)
            continue;
        ++count.edges;
        const std::vector<Spoke> list = spokes(positions, topology, e);
        for (std::size_t i = 0; i < list.size(); ++i) {
            const Spoke &above = list[(i + 1) % list.size()], &below = list[i];
            // The solid lies clockwise of a forward triangle and counter-clockwise of another.
            if (above.forward && !below.forward)
                topology.join(above.halfedge, below.halfedge);
        }
    }
    if (count.edges > 0)
        topology.update();
    for (const Index fans : topology.fans_per_vertex(static_cast<Index>(positions.size())))
        count.vertices += fans > 1;
    return count;
}

} // namespace bot2nurbs
