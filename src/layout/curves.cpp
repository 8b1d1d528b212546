// SPDX-License-Identifier: MIT
#include "layout/curves.h"

#include <algorithm>
#include <cmath>

namespace bot2nurbs {

namespace {

constexpr double right_angle = 1.5707963267948966;
// Turning is measured on steps of this part of a piece's width, or of the whole length: it is that
// of the shape of a curve, not of its noise.
constexpr double turning_scale = 1.0 / 6.0;
constexpr double whole_turning_scale = 1.0 / 24.0;

// The marked edges at each vertex, as halfedges that start there or end there.
struct Incidence {
    std::vector<Index> offset, halfedge;

    Incidence(const ManifoldMesh& mesh, const std::vector<char>& marks)
        : offset(mesh.vertex_count() + 1, 0)
    {
        const auto each = [&](const auto& act) {
            for (Index h = 0; h < mesh.halfedge_count(); ++h)
                if (marks[h] && mesh.edge(h) == h) {
                    act(mesh.from(h), h);
                    act(mesh.to(h), h);
                }
        };
        each([this](Index v, Index) { ++offset[v + 1]; });
        for (std::size_t v = 0; v + 1 < offset.size(); ++v)
            offset[v + 1] += offset[v];
        halfedge.resize(offset.back());
        std::vector<Index> at(offset.begin(), offset.end() - 1);
        each([&](Index v, Index h) { halfedge[at[v]++] = h; });
    }
    Index degree(Index v) const { return offset[v + 1] - offset[v]; }
};

} // namespace

char mark_of(FeatureKind kind)
{
    return static_cast<char>(1 + static_cast<int>(kind));
}

std::vector<char> mark_edges(const ManifoldMesh& mesh, const std::vector<FeaturePath>& paths)
{
    std::vector<char> marks(mesh.halfedge_count(), 0);
    for (const FeaturePath& path : paths)
        for (std::size_t i = 0; i + 1 < path.vertices.size(); ++i) {
            Index h = mesh.find_halfedge(path.vertices[i], path.vertices[i + 1]);
            if (h == invalid_index)
                h = mesh.find_halfedge(path.vertices[i + 1], path.vertices[i]);
            marks[h] = mark_of(path.kind);
            if (mesh.twin(h) != invalid_index)
                marks[mesh.twin(h)] = marks[h];
        }
    for (Index h = 0; h < mesh.halfedge_count(); ++h)
        if (mesh.twin(h) == invalid_index)
            marks[h] = mark_of(FeatureKind::boundary);
    return marks;
}

std::vector<Curve> trace_curves(const ManifoldMesh& mesh, const std::vector<char>& marks,
                                const std::vector<char>& nodes)
{
    const Incidence at(mesh, marks);
    const auto is_node = [&](Index v) {
        return at.degree(v) != 2 || nodes[v] ||
               marks[at.halfedge[at.offset[v]]] != marks[at.halfedge[at.offset[v] + 1]];
    };
    std::vector<char> used(mesh.halfedge_count(), 0);
    std::vector<Curve> curves;
    const auto trace = [&](Index v, Index h) {
        Curve curve;
        curve.whole = marks[h] == joint_mark;
        curve.kind =
            curve.whole ? FeatureKind::smooth_seam : static_cast<FeatureKind>(marks[h] - 1);
        curve.vertices.push_back(v);
        const Index start = v;
        for (;;) {
            used[h] = 1;
            v = mesh.from(h) == v ? mesh.to(h) : mesh.from(h);
            curve.vertices.push_back(v);
            if (v == start || is_node(v))
                break;
            const Index first = at.halfedge[at.offset[v]], second = at.halfedge[at.offset[v] + 1];
            h = first == h ? second : first;
        }
        curves.push_back(std::move(curve));
    };
    const auto trace_from = [&](Index v) {
        for (Index i = at.offset[v]; i < at.offset[v + 1]; ++i)
            if (!used[at.halfedge[i]])
                trace(v, at.halfedge[i]);
    };
    for (Index v = 0; v < mesh.vertex_count(); ++v)
        if (at.degree(v) > 0 && is_node(v))
            trace_from(v);
    for (Index v = 0; v < mesh.vertex_count(); ++v)
        trace_from(v);
    return curves;
}

std::vector<std::size_t> divide_polyline(const std::vector<Vec3>& points,
                                         const std::vector<double>& density, double width,
                                         std::size_t least)
{
    const std::size_t edges = points.size() - 1;
    std::vector<double> arc{0.0};
    for (std::size_t i = 0; i < edges; ++i)
        arc.push_back(arc.back() +
                      0.5 * (density[i] + density[i + 1]) * norm(points[i + 1] - points[i]));
    double turn = 0.0;
    Vec3 direction;
    const double stride = std::min(turning_scale * width, whole_turning_scale * arc.back());
    for (std::size_t i = 1, from = 0; i <= edges; ++i) {
        if (arc[i] - arc[from] < stride && i < edges)
            continue;
        const Vec3 step = points[i] - points[from];
        if (from > 0)
            turn += std::atan2(norm(cross(direction, step)), dot(direction, step));
        direction = step;
        from = i;
    }
    const double wanted = std::max(std::round(arc.back() / width), std::ceil(turn / right_angle));
    const std::size_t pieces =
        std::min(edges, std::max(least, static_cast<std::size_t>(std::max(1.0, wanted))));
    std::vector<std::size_t> result{0};
    for (std::size_t k = 1; k < pieces; ++k) {
        const double place = arc.back() * static_cast<double>(k) / static_cast<double>(pieces);
        // Every later piece needs an edge too.
        std::size_t i = result.back() + 1;
        while (i < edges - (pieces - k) &&
               std::fabs(arc[i + 1] - place) <= std::fabs(arc[i] - place))
            ++i;
        result.push_back(i);
    }
    result.push_back(edges);
    return result;
}

} // namespace bot2nurbs
