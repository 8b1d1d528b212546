// SPDX-License-Identifier: MIT
#include "maps/retile.h"

#include "core/predicates.h"
#include "maps/crossings.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace bot2nurbs {

namespace {

// Parameter on a mesh edge of an overlay vertex, if it lies on that edge.
std::optional<double> parameter_on(const ManifoldMesh& mesh, const Overlay::Vertex& v, Index edge)
{
    if (v.mesh_vertex != invalid_index) {
        if (v.mesh_vertex == mesh.from(edge))
            return 0.0;
        if (v.mesh_vertex == mesh.to(edge))
            return 1.0;
        return std::nullopt;
    }
    return v.edge == edge ? std::optional<double>(v.t) : std::nullopt;
}

// One crossing of a segment with a stretch of a mesh edge.
struct Hit {
    Index segment, position; // Which segment, and how many hits it had before.
    Index halfedge;          // Of the face it leaves.
    Index low, high;         // Ends of the stretch: overlay vertices in the edge's direction.
    double t_low, t_high, t;
};

class Drawer {
public:
    Drawer(const ManifoldMesh& mesh, const Overlay& overlay, const std::vector<Vec2>& uv)
        : mesh_(mesh), overlay_(overlay), uv_(uv), twin_(overlay.opposite),
          corner_of_(overlay.vertices.size(), invalid_index)
    {
        for (Index t = 0; t < overlay.triangles.size(); ++t)
            for (Index k = 0; k < 3; ++k) {
                Index& c = corner_of_[overlay.triangles[t][k]];
                // At the border start with the triangle that has the border to its right.
                if (c == invalid_index || twin_[3 * t + k] == invalid_index)
                    c = 3 * t + k;
            }
    }

    // Walks one segment; false when the walk does not arrive.
    bool walk(Index number, const Segment& s, std::vector<Hit>& hits) const
    {
        const auto left = [&](Index v) { return orient2d(uv_[s.from], uv_[s.to], uv_[v]) >= 0; };
        // The triangle at the start that the segment enters: right neighbour right, left left.
        Index h = corner_of_[s.from], leaving = invalid_index;
        const Index first = h;
        do {
            const Index p = to(h), q = from(prev(h));
            if (p == s.to || q == s.to)
                return true;
            if (!left(p) && left(q)) {
                leaving = next(h);
                break;
            }
            h = twin_[prev(h)];
        } while (h != first && h != invalid_index);
        if (leaving == invalid_index)
            return false;
        Index position = 0;
        for (std::size_t step = 0; step < overlay_.triangles.size(); ++step) {
            record(number, s, leaving, position, hits);
            const Index entered = twin_[leaving];
            if (entered == invalid_index)
                return false;
            const Index apex = from(prev(entered));
            if (apex == s.to)
                return true;
            // `entered` runs from left to right: the apex replaces one of them.
            leaving = left(apex) ? next(entered) : prev(entered);
        }
        return false;
    }

private:
    static Index next(Index h) { return h % 3 == 2 ? h - 2 : h + 1; }
    static Index prev(Index h) { return h % 3 == 0 ? h + 2 : h - 1; }
    Index from(Index h) const { return overlay_.triangles[h / 3][h % 3]; }
    Index to(Index h) const { return from(next(h)); }

    void record(Index number, const Segment& s, Index h, Index& position,
                std::vector<Hit>& hits) const
    {
        const Index f = overlay_.face[h / 3], p = from(h), q = to(h);
        for (Index k = 0; k < 3; ++k) {
            const Index edge = mesh_.edge(3 * f + k);
            const auto tp = parameter_on(mesh_, overlay_.vertices[p], edge);
            const auto tq = parameter_on(mesh_, overlay_.vertices[q], edge);
            if (!tp || !tq)
                continue;
            const Vec2 d = uv_[s.to] - uv_[s.from];
            const double dp = std::fabs(cross(d, uv_[p] - uv_[s.from]));
            const double dq = std::fabs(cross(d, uv_[q] - uv_[s.from]));
            const double share = dp + dq > 0.0 ? dp / (dp + dq) : 0.5;
            Hit hit{number, position++, 3 * f + k, p, q, *tp, *tq, *tp + share * (*tq - *tp)};
            if (hit.t_low > hit.t_high) {
                std::swap(hit.low, hit.high);
                std::swap(hit.t_low, hit.t_high);
            }
            hits.push_back(hit);
            return;
        }
    }

    const ManifoldMesh& mesh_;
    const Overlay& overlay_;
    const std::vector<Vec2>& uv_;
    const std::vector<Index>& twin_;
    std::vector<Index> corner_of_;
};

// Whether segment a crosses the stretch nearer to its low end than segment b does, both crossing it
// and not each other: b's line end that is not shared lies beyond a, on the side of the high end.
bool crosses_before(const std::vector<Vec2>& uv, const Segment& a, const Segment& b, Index high)
{
    const auto beyond = [&](const Segment& s, const Segment& other) -> int {
        const int high_side = orient2d(uv[s.from], uv[s.to], uv[high]) >= 0 ? 1 : -1;
        for (const Index end : {other.from, other.to})
            if (end != s.from && end != s.to) {
                const int side = orient2d(uv[s.from], uv[s.to], uv[end]);
                if (side != 0)
                    return side == high_side ? 1 : -1;
            }
        return 0;
    };
    const int forward = beyond(a, b);
    return forward != 0 ? forward > 0 : beyond(b, a) < 0;
}

} // namespace

std::optional<std::vector<SurfacePath>> draw_segments(const ManifoldMesh& mesh,
                                                      const Overlay& overlay,
                                                      const std::vector<Vec2>& uv,
                                                      const std::vector<Segment>& segments)
{
    const Drawer drawer(mesh, overlay, uv);
    std::vector<Hit> hits;
    for (Index i = 0; i < segments.size(); ++i)
        if (!drawer.walk(i, segments[i], hits))
            return std::nullopt;

    // Order the crossings of each stretch and keep them apart.
    std::sort(hits.begin(), hits.end(), [&](const Hit& p, const Hit& q) {
        if (p.low != q.low)
            return p.low < q.low;
        if (p.high != q.high)
            return p.high < q.high;
        if (p.segment != q.segment)
            return crosses_before(uv, segments[p.segment], segments[q.segment], p.high);
        return p.position < q.position;
    });
    std::vector<double> t;
    for (std::size_t i = 0; i < hits.size();) {
        std::size_t j = i + 1;
        while (j < hits.size() && hits[j].low == hits[i].low && hits[j].high == hits[i].high)
            ++j;
        t.clear();
        for (std::size_t k = i; k < j; ++k)
            t.push_back(hits[k].t);
        if (!keep_apart(t, hits[i].t_low, hits[i].t_high))
            return std::nullopt;
        for (std::size_t k = i; k < j; ++k)
            hits[k].t = t[k - i];
        i = j;
    }
    std::sort(hits.begin(), hits.end(), [](const Hit& p, const Hit& q) {
        return p.segment != q.segment ? p.segment < q.segment : p.position < q.position;
    });

    std::vector<SurfacePath> paths(segments.size());
    for (std::size_t i = 0; i < segments.size(); ++i) {
        paths[i].a = overlay.vertices[segments[i].from].mesh_vertex;
        paths[i].b = overlay.vertices[segments[i].to].mesh_vertex;
    }
    for (const Hit& hit : hits) {
        PathNode node;
        node.halfedge = hit.halfedge;
        node.t = hit.t;
        paths[hit.segment].nodes.push_back(node);
    }
    for (SurfacePath& path : paths)
        if (path.b != invalid_index)
            reduce(mesh, path);
    return paths;
}

std::optional<MappedDisk> map_disk(OverlayBuilder& builder, const std::vector<PathSide>& border)
{
    std::optional<Overlay> overlay = builder.disk(border);
    if (!overlay)
        return std::nullopt;
    const Index sides = overlay->side_count();
    auto map = map_to_polygon(*overlay, sides == 4 ? unit_square() : regular_polygon(sides));
    if (!map)
        return std::nullopt;
    return MappedDisk{std::move(*overlay), std::move(map->uv)};
}

std::optional<std::vector<SurfacePath>> retile(const ManifoldMesh& mesh, const MappedDisk& disk,
                                               const std::vector<std::pair<Index, Index>>& chords,
                                               Index center)
{
    const Overlay& overlay = disk.overlay;
    Index center_vertex = invalid_index;
    if (center != invalid_index) {
        for (Index v = overlay.boundary_count; v < overlay.vertices.size(); ++v)
            if (overlay.vertices[v].mesh_vertex == center)
                center_vertex = v;
        if (center_vertex == invalid_index)
            return std::nullopt;
    }
    std::vector<Segment> segments;
    for (const auto& [a, b] : chords)
        segments.push_back(
            {overlay.corners[a], b == invalid_index ? center_vertex : overlay.corners[b]});
    return draw_segments(mesh, overlay, disk.uv, segments);
}

} // namespace bot2nurbs
