// SPDX-License-Identifier: MIT
#include "maps/lift_chords.h"

#include <algorithm>

namespace bot2nurbs {

namespace {

// A mapped overlay with more points on its border.
class RefinedBorder {
public:
    RefinedBorder(const ManifoldMesh& mesh, const MappedDisk& disk, std::vector<BorderPlace> places)
        : mesh_(mesh), before_(disk.overlay), uv_(disk.uv), places_(std::move(places)),
          on_step_(before_.boundary_count), triangle_at_(before_.boundary_count)
    {
        std::sort(places_.begin(), places_.end());
        const Index border = before_.boundary_count;
        for (Index i = 0; i < places_.size(); ++i)
            on_step_[before_.corners[places_[i].side] + places_[i].step].push_back(i);
        for (Index h = 0; h < before_.opposite.size(); ++h)
            if (before_.opposite[h] == invalid_index)
                triangle_at_[before_.triangles[h / 3][h % 3]] = h / 3;
        number_.resize(before_.vertices.size());
        number_of_place_.resize(places_.size());
        for (Index v = 0; v < border; ++v) {
            number_[v] = add(before_.vertices[v], uv_[v]);
            if (std::binary_search(before_.corners.begin(), before_.corners.end(), v))
                result_.overlay.corners.push_back(number_[v]);
            for (const Index i : on_step_[v])
                number_of_place_[i] = add_between(v, (v + 1) % border, places_[i].share);
        }
        result_.overlay.boundary_count = static_cast<Index>(result_.overlay.vertices.size());
        for (Index v = border; v < before_.vertices.size(); ++v)
            number_[v] = add(before_.vertices[v], uv_[v]);
        for (Index t = 0; t < before_.triangles.size(); ++t)
            add_triangle(t);
        result_.overlay.find_opposites();
    }

    const MappedDisk& disk() const { return result_; }
    // Overlay vertex at a place or corner.
    Index vertex_at(const BorderPlace& place) const
    {
        if (place.is_corner())
            return result_.overlay.corners[place.side];
        const auto found = std::lower_bound(places_.begin(), places_.end(), place);
        return number_of_place_[static_cast<std::size_t>(found - places_.begin())];
    }
    // The mesh halfedge that the border runs along at a place, the region to its left; or invalid.
    Index halfedge_at(const BorderPlace& place) const
    {
        const Index v = before_.corners[place.side] + place.step;
        return halfedge_between(v, (v + 1) % before_.boundary_count);
    }

private:
    Index halfedge_between(Index a, Index b) const
    {
        const Index p = before_.vertices[a].mesh_vertex, q = before_.vertices[b].mesh_vertex;
        return p == invalid_index || q == invalid_index ? invalid_index : mesh_.find_halfedge(p, q);
    }
    Index add(const Overlay::Vertex& v, const Vec2& uv)
    {
        result_.overlay.vertices.push_back(v);
        result_.uv.push_back(uv);
        return static_cast<Index>(result_.uv.size() - 1);
    }
    // A point on the border between two vertices: on a mesh edge, or inside a mesh face.
    Index add_between(Index a, Index b, double share)
    {
        Overlay::Vertex v;
        const Index h = halfedge_between(a, b);
        if (h != invalid_index) {
            v.edge = mesh_.edge(h);
            v.t = v.edge == h ? share : 1.0 - share;
            v.position = edge_point(mesh_, v.edge, v.t);
        } else {
            v.face = before_.face[triangle_at_[a]];
            const auto wa = before_.bary_in(mesh_, a, v.face),
                       wb = before_.bary_in(mesh_, b, v.face);
            for (int k = 0; k < 3; ++k)
                v.bary[k] = (1.0 - share) * wa[k] + share * wb[k];
            v.position = mesh_.at({v.face, v.bary});
        }
        return add(v, (1.0 - share) * uv_[a] + share * uv_[b]);
    }
    // A triangle with new points on one side becomes a fan around the corner opposite; with points
    // on more sides, around its middle.
    void add_triangle(Index t)
    {
        const auto& corner = before_.triangles[t];
        std::vector<Index> rim;
        Index divided = 0, apex = 0;
        for (Index k = 0; k < 3; ++k) {
            rim.push_back(number_[corner[k]]);
            if (before_.opposite[3 * t + k] != invalid_index || on_step_[corner[k]].empty())
                continue;
            ++divided;
            apex = (k + 2) % 3;
            for (const Index i : on_step_[corner[k]])
                rim.push_back(number_of_place_[i]);
        }
        if (divided <= 1) {
            const auto at = std::find(rim.begin(), rim.end(), number_[corner[apex]]);
            std::rotate(rim.begin(), at, rim.end());
            for (std::size_t i = 1; i + 1 < rim.size(); ++i)
                push({rim[0], rim[i], rim[i + 1]}, before_.face[t]);
            return;
        }
        Overlay::Vertex middle;
        middle.face = before_.face[t];
        Vec2 uv;
        for (const Index v : corner) {
            const auto w = before_.bary_in(mesh_, v, middle.face);
            for (int k = 0; k < 3; ++k)
                middle.bary[k] += w[k] / 3.0;
            uv = uv + (1.0 / 3.0) * uv_[v];
        }
        middle.position = mesh_.at({middle.face, middle.bary});
        const Index m = add(middle, uv);
        for (std::size_t i = 0; i < rim.size(); ++i)
            push({rim[i], rim[(i + 1) % rim.size()], m}, before_.face[t]);
    }
    void push(const std::array<Index, 3>& triangle, Index face)
    {
        result_.overlay.triangles.push_back(triangle);
        result_.overlay.face.push_back(face);
    }

    const ManifoldMesh& mesh_;
    const Overlay& before_;
    const std::vector<Vec2>& uv_;
    std::vector<BorderPlace> places_;
    std::vector<std::vector<Index>> on_step_; // Per border vertex: the places on the step after it.
    std::vector<Index> triangle_at_; // Per border vertex: the triangle at the step after it.
    std::vector<Index> number_;      // Per vertex before: its number now.
    std::vector<Index> number_of_place_;
    MappedDisk result_;
};

} // namespace

std::optional<std::vector<std::vector<PathNode>>>
lift_chords(const std::vector<PathSide>& border, const std::vector<BorderChord>& chords,
            OverlayBuilder& builder)
{
    const ManifoldMesh& mesh = builder.mesh();
    const std::optional<MappedDisk> mapped = map_disk(builder, border);
    if (!mapped)
        return std::nullopt;
    std::vector<BorderPlace> places;
    for (const BorderChord& c : chords)
        for (const BorderPlace& place : {c.from, c.to})
            if (!place.is_corner())
                places.push_back(place);
    const RefinedBorder refined(mesh, *mapped, std::move(places));
    const Overlay& overlay = refined.disk().overlay;
    std::vector<Segment> segments;
    for (const BorderChord& c : chords)
        segments.push_back({refined.vertex_at(c.from), refined.vertex_at(c.to)});
    auto drawn = draw_segments(mesh, overlay, refined.disk().uv, segments);
    if (!drawn)
        return std::nullopt;
    std::vector<std::vector<PathNode>> result;
    for (std::size_t i = 0; i < segments.size(); ++i) {
        result.push_back(std::move((*drawn)[i].nodes));
        const BorderPlace& end = chords[i].to;
        const Index along = end.is_corner() ? invalid_index : refined.halfedge_at(end);
        if (along != invalid_index) {
            PathNode node;
            node.halfedge = along;
            node.t = overlay.vertices[segments[i].to].t;
            result.back().push_back(node);
        }
    }
    return result;
}

} // namespace bot2nurbs
