// SPDX-License-Identifier: MIT
#include "maps/overlay.h"

#include <algorithm>
#include <cassert>

namespace bot2nurbs {

std::array<double, 3> Overlay::bary_in(const ManifoldMesh& mesh, Index vertex, Index f) const
{
    const Vertex& v = vertices[vertex];
    if (v.face != invalid_index) {
        assert(v.face == f);
        return v.bary;
    }
    std::array<double, 3> w{};
    const auto& corner = mesh.triangle(f);
    for (int k = 0; k < 3; ++k) {
        if (v.mesh_vertex != invalid_index)
            w[k] = corner[k] == v.mesh_vertex ? 1.0 : 0.0;
        else if (corner[k] == mesh.from(v.edge))
            w[k] = 1.0 - v.t;
        else if (corner[k] == mesh.to(v.edge))
            w[k] = v.t;
    }
    return w;
}

void Overlay::find_opposites()
{
    // Half edges in lists by their smaller end; a list has about six entries.
    const Index count = static_cast<Index>(3 * triangles.size());
    std::vector<Index> head(vertices.size(), invalid_index), next(count);
    opposite.assign(count, invalid_index);
    for (Index t = 0, h = 0; t < triangles.size(); ++t)
        for (int k = 0; k < 3; ++k, ++h) {
            const Index a = triangles[t][k], b = triangles[t][(k + 1) % 3];
            const Index low = std::min(a, b);
            Index* link = &head[low];
            for (; *link != invalid_index; link = &next[*link]) {
                const Index g = *link;
                if (triangles[g / 3][g % 3] == b && triangles[g / 3][(g + 1) % 3] == a)
                    break;
            }
            if (*link != invalid_index) {
                opposite[h] = *link;
                opposite[*link] = h;
                *link = next[*link]; // Found: out of the list.
            } else {
                next[h] = head[low];
                head[low] = h;
            }
        }
}

OverlayBuilder::OverlayBuilder(const ManifoldMesh& mesh)
    : mesh_(mesh), vertex_stamp_(mesh.vertex_count(), 0), face_stamp_(mesh.face_count(), 0),
      vertex_local_(mesh.vertex_count(), invalid_index)
{
}

void OverlayBuilder::next_stamp()
{
    if (++stamp_ == 0) {
        std::fill(vertex_stamp_.begin(), vertex_stamp_.end(), 0);
        std::fill(face_stamp_.begin(), face_stamp_.end(), 0);
        stamp_ = 1;
    }
    edge_points_.clear();
    chords_.clear();
    blocked_.clear();
    pending_.clear();
    vertex_sides_.clear();
    midpoints_.clear();
}

Index OverlayBuilder::local_vertex(Overlay& overlay, Index mesh_vertex)
{
    if (vertex_stamp_[mesh_vertex] != stamp_) {
        vertex_stamp_[mesh_vertex] = stamp_;
        vertex_local_[mesh_vertex] = static_cast<Index>(overlay.vertices.size());
        Overlay::Vertex v;
        v.position = mesh_.position(mesh_vertex);
        v.mesh_vertex = mesh_vertex;
        overlay.vertices.push_back(v);
    }
    return vertex_local_[mesh_vertex];
}

bool OverlayBuilder::same_side(const Overlay& overlay, Index p, Index q) const
{
    if (p >= overlay.boundary_count || q >= overlay.boundary_count)
        return false;
    for (const Index s : vertex_sides_[p])
        for (const Index t : vertex_sides_[q])
            if (s == t && s != invalid_index)
                return true;
    return false;
}

void OverlayBuilder::split_same_side_edges(const Overlay& before, std::vector<Index>& polygon,
                                           Overlay& overlay)
{
    const Index count = before.boundary_count;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Index p = polygon[i], q = polygon[(i + 1) % polygon.size()];
        if (!same_side(before, p, q) || (p + 1) % count == q || (q + 1) % count == p)
            continue;
        const std::pair<Index, Index> key(std::min(p, q), std::max(p, q));
        auto found = std::find_if(midpoints_.begin(), midpoints_.end(),
                                  [&key](const auto& m) { return m.first == key; });
        if (found == midpoints_.end()) {
            const Overlay::Vertex& a = overlay.vertices[p];
            const Overlay::Vertex& b = overlay.vertices[q];
            // Both lie on one mesh edge: polygons get their inner edges only afterwards.
            Overlay::Vertex m;
            m.edge = a.edge != invalid_index ? a.edge : b.edge;
            if (m.edge == invalid_index)
                m.edge = mesh_.edge(mesh_.find_halfedge(a.mesh_vertex, b.mesh_vertex));
            const auto parameter = [&](const Overlay::Vertex& v) {
                if (v.mesh_vertex == invalid_index)
                    return v.t;
                return v.mesh_vertex == mesh_.from(m.edge) ? 0.0 : 1.0;
            };
            m.t = 0.5 * (parameter(a) + parameter(b));
            m.position = edge_point(mesh_, m.edge, m.t);
            midpoints_.emplace_back(key, static_cast<Index>(overlay.vertices.size()));
            found = midpoints_.end() - 1;
            overlay.vertices.push_back(m);
        }
        polygon.insert(polygon.begin() + static_cast<std::ptrdiff_t>(i) + 1, found->second);
        ++i;
    }
}

void OverlayBuilder::add_polygon(Overlay& overlay, Index face, std::vector<Index>& p)
{
    int border = 0;
    for (const Index v : p)
        border += v < overlay.boundary_count;
    if (border >= 2)
        split_same_side_edges(overlay, p, overlay);
    const auto add = [&](Index a, Index b, Index c) {
        overlay.triangles.push_back({a, b, c});
        overlay.face.push_back(face);
    };
    if (p.size() == 3) {
        add(p[0], p[1], p[2]);
        return;
    }
    if (p.size() == 4) {
        // The diagonal with fewer ends on the border, then the shorter one.
        const auto rank = [&](Index a, Index b) {
            return (a < overlay.boundary_count) + (b < overlay.boundary_count);
        };
        const auto length = [&](Index a, Index b) {
            return norm(overlay.vertices[a].position - overlay.vertices[b].position);
        };
        const int rank0 = rank(p[0], p[2]), rank1 = rank(p[1], p[3]);
        const bool first =
            rank0 != rank1 ? rank0 < rank1 : length(p[0], p[2]) <= length(p[1], p[3]);
        if (std::min(rank0, rank1) < 2) {
            if (first)
                add(p[0], p[1], p[2]), add(p[0], p[2], p[3]);
            else
                add(p[1], p[2], p[3]), add(p[1], p[3], p[0]);
            return;
        }
    }
    // A new vertex in the middle never joins two border points.
    Overlay::Vertex middle;
    middle.face = face;
    for (const Index v : p) {
        const auto w = overlay.bary_in(mesh_, v, face);
        for (int k = 0; k < 3; ++k)
            middle.bary[k] += w[k] / static_cast<double>(p.size());
    }
    middle.position = mesh_.at({face, middle.bary});
    const Index m = static_cast<Index>(overlay.vertices.size());
    overlay.vertices.push_back(middle);
    for (std::size_t i = 0; i < p.size(); ++i)
        add(p[i], p[(i + 1) % p.size()], m);
}

bool OverlayBuilder::cut_face(Overlay& overlay, Index face, const Chord* chords, std::size_t count)
{
    // The rim of the face, counter-clockwise: corners, and border points on each edge in order.
    auto& [rim, ends, done, path] = cut_;
    rim.clear();
    for (Index k = 0; k < 3; ++k) {
        const Index v = mesh_.triangle(face)[k];
        const bool known = vertex_stamp_[v] == stamp_ && vertex_local_[v] < overlay.boundary_count;
        rim.push_back({known ? vertex_local_[v] : invalid_index, k});
        const Index h = 3 * face + k, e = mesh_.edge(h);
        const auto lower =
            std::lower_bound(edge_points_.begin(), edge_points_.end(), e,
                             [](const EdgePoint& p, Index edge) { return p.edge < edge; });
        auto upper = lower;
        while (upper != edge_points_.end() && upper->edge == e)
            ++upper;
        if (h == e)
            for (auto p = lower; p != upper; ++p)
                rim.push_back({p->id, invalid_index});
        else
            for (auto p = upper; p != lower; --p)
                rim.push_back({(p - 1)->id, invalid_index});
    }
    const std::size_t n = rim.size();
    const auto place = [&rim = rim](Index id) {
        for (std::size_t i = 0; i < rim.size(); ++i)
            if (rim[i].id == id)
                return i;
        return rim.size();
    };
    ends.resize(count);
    for (std::size_t c = 0; c < count; ++c) {
        ends[c] = {place(chords[c].from), place(chords[c].to)};
        if (ends[c].first == n || ends[c].second == n)
            return false;
    }
    done.assign(count, 0);
    for (std::size_t c = 0; c < count; ++c) {
        if (done[c])
            continue;
        // The piece to the left of chord c: at each point take the chord that turns left most.
        std::size_t previous = ends[c].first, current = ends[c].second;
        const std::size_t start = previous;
        done[c] = 1;
        path.assign(1, previous);
        while (current != start) {
            if (path.size() > n)
                return false;
            path.push_back(current);
            const std::size_t limit = (previous + n - current) % n;
            std::size_t best = 1, chord = count;
            for (std::size_t d = 0; d < count; ++d) {
                std::size_t other = n;
                if (ends[d].first == current)
                    other = ends[d].second;
                else if (ends[d].second == current)
                    other = ends[d].first;
                if (other == n)
                    continue;
                const std::size_t offset = (other + n - current) % n;
                if (offset < limit && (offset > best || (offset == best && chord == count))) {
                    best = offset;
                    chord = d;
                }
            }
            const std::size_t target = (current + best) % n;
            if (chord != count) {
                if (ends[chord].first != current)
                    return false; // The right of one border chord and the left of another.
                done[chord] = 1;
            }
            previous = current;
            current = target;
        }
        if (path.size() < 3)
            continue; // The border runs along an edge: nothing between.
        polygon_.clear();
        for (const std::size_t i : path) {
            if (rim[i].id == invalid_index)
                rim[i].id = local_vertex(overlay, mesh_.triangle(face)[rim[i].corner]);
            polygon_.push_back(rim[i].id);
        }
        for (std::size_t i = 0; i < path.size(); ++i) {
            const RimPoint& a = rim[path[i]];
            const RimPoint& b = rim[path[(i + 1) % path.size()]];
            if (a.corner == invalid_index || b.corner == invalid_index ||
                b.corner != (a.corner + 1) % 3 || (path[i] + 1) % n != path[(i + 1) % path.size()])
                continue;
            const Index h = 3 * face + a.corner;
            if (!std::binary_search(blocked_.begin(), blocked_.end(), h))
                pending_.push_back(mesh_.face(mesh_.twin(h)));
        }
        add_polygon(overlay, face, polygon_);
    }
    return true;
}

void OverlayBuilder::flood(Overlay& overlay)
{
    for (std::size_t i = 0; i < pending_.size(); ++i) {
        const Index f = pending_[i];
        if (face_stamp_[f] == stamp_)
            continue;
        face_stamp_[f] = stamp_;
        polygon_.resize(3);
        for (Index k = 0; k < 3; ++k)
            polygon_[k] = local_vertex(overlay, mesh_.triangle(f)[k]);
        add_polygon(overlay, f, polygon_);
        for (Index k = 0; k < 3; ++k) {
            const Index h = 3 * f + k;
            if (std::binary_search(blocked_.begin(), blocked_.end(), h))
                continue;
            const Index t = mesh_.twin(h);
            if (t != invalid_index && face_stamp_[mesh_.face(t)] != stamp_)
                pending_.push_back(mesh_.face(t));
        }
    }
}

bool OverlayBuilder::is_disk(const Overlay& overlay)
{
    const auto faces = static_cast<std::int64_t>(overlay.triangles.size());
    const auto vertices = static_cast<std::int64_t>(overlay.vertices.size());
    const auto twice_edges = 3 * faces + static_cast<std::int64_t>(overlay.boundary_count);
    return faces > 0 && twice_edges % 2 == 0 && vertices - twice_edges / 2 + faces == 1;
}

std::optional<Overlay> OverlayBuilder::disk(const std::vector<PathSide>& sides)
{
    next_stamp();
    Overlay overlay;
    // Border vertices, and what the traveller leaves each by (a halfedge; invalid at a mesh
    // vertex).
    std::vector<Index> leaving;
    const Index side_count = static_cast<Index>(sides.size());
    for (Index s = 0; s < side_count; ++s) {
        const PathSide& side = sides[s];
        overlay.corners.push_back(static_cast<Index>(overlay.vertices.size()));
        for (std::size_t i = 0; i <= side.node_count(); ++i) {
            const PathNode node =
                i == 0 ? PathNode{invalid_index, side.start(), 0.0} : side.node(mesh_, i - 1);
            const Index id = static_cast<Index>(overlay.vertices.size());
            vertex_sides_.push_back(
                {s, i == 0 ? (s + side_count - 1) % side_count : invalid_index});
            if (node.is_vertex()) {
                if (vertex_stamp_[node.vertex] == stamp_)
                    return std::nullopt; // The border touches itself.
                local_vertex(overlay, node.vertex);
                leaving.push_back(invalid_index);
            } else {
                Overlay::Vertex v;
                v.edge = mesh_.edge(node.halfedge);
                v.t = node.t;
                v.position = edge_point(mesh_, v.edge, v.t);
                overlay.vertices.push_back(v);
                edge_points_.push_back({v.edge, v.t, id});
                leaving.push_back(node.halfedge);
            }
        }
    }
    overlay.boundary_count = static_cast<Index>(overlay.vertices.size());
    const Index n = overlay.boundary_count;
    std::sort(edge_points_.begin(), edge_points_.end(), [](const EdgePoint& p, const EdgePoint& q) {
        return p.edge != q.edge ? p.edge < q.edge : (p.t != q.t ? p.t < q.t : p.id < q.id);
    });

    for (Index i = 0; i < n; ++i) {
        const Index j = (i + 1) % n;
        if (leaving[j] != invalid_index) {
            chords_.push_back({mesh_.face(leaving[j]), i, j});
        } else if (leaving[i] != invalid_index) {
            chords_.push_back({mesh_.face(mesh_.twin(leaving[i])), i, j});
        } else {
            const Index h = mesh_.find_halfedge(overlay.vertices[i].mesh_vertex,
                                                overlay.vertices[j].mesh_vertex);
            if (h == invalid_index)
                return std::nullopt;
            blocked_.push_back(h);
        }
    }
    std::sort(blocked_.begin(), blocked_.end());
    std::sort(chords_.begin(), chords_.end(), [](const Chord& a, const Chord& b) {
        return a.face != b.face ? a.face < b.face : a.from < b.from;
    });
    for (const Chord& c : chords_)
        face_stamp_[c.face] = stamp_;
    for (std::size_t i = 0; i < chords_.size();) {
        std::size_t j = i;
        while (j < chords_.size() && chords_[j].face == chords_[i].face)
            ++j;
        if (!cut_face(overlay, chords_[i].face, &chords_[i], j - i))
            return std::nullopt;
        i = j;
    }
    for (const Index h : blocked_)
        pending_.push_back(mesh_.face(h));
    flood(overlay);
    if (!is_disk(overlay))
        return std::nullopt;
    overlay.find_opposites();
    return overlay;
}

// Once around the tile, which stays to the left: from the first junction, or at the boundary from
// the site. Empty where the tile has no simple outline.
std::vector<OverlayBuilder::Station> OverlayBuilder::walk_around(const std::vector<Index>& label,
                                                                 const std::vector<Index>& members,
                                                                 Index site) const
{
    const Index own = label[members.front()];
    // Mixed halfedges run from the tile to another label; the walk must meet each.
    Index start = invalid_index, mixed = 0;
    bool open = false;
    for (const Index u : members) {
        Index h = mesh_.halfedge_at(u);
        const Index first = h;
        do {
            if (label[mesh_.to(h)] != own) {
                ++mixed;
                const bool begins = mesh_.twin(h) == invalid_index;
                if (begins && open)
                    return {}; // Two parts of the boundary.
                if (begins || start == invalid_index)
                    start = h;
                open = open || begins;
            }
            h = mesh_.twin(mesh_.prev(h));
        } while (h != first && h != invalid_index);
    }
    if (start == invalid_index)
        return {};

    std::vector<Station> stations;
    const auto add_middle = [&](Index halfedge, Index across) {
        Station s;
        s.halfedge = halfedge;
        s.across = across;
        stations.push_back(s);
    };
    if (open) {
        // From the site along the boundary to where the cuts begin.
        Station s;
        s.vertex = site;
        s.corner = true;
        stations.push_back(s);
        s.corner = false;
        for (Index v = site; v != mesh_.from(start); stations.push_back(s)) {
            v = mesh_.to(mesh_.halfedge_at(v));
            if (label[v] != own)
                return {}; // The site is not on this part of the boundary.
            s.vertex = v;
        }
    }
    const std::size_t first_middle = stations.size();
    std::size_t first_junction = 0;
    Index walked = 0, h = start;
    do {
        add_middle(h, label[mesh_.to(h)]);
        ++walked;
        const Index third = mesh_.from(mesh_.prev(h));
        const bool inside = label[third] == own;
        if (!inside && label[third] != label[mesh_.to(h)]) {
            if (first_junction == 0)
                first_junction = stations.size();
            Station s;
            s.face = mesh_.face(h);
            s.corner = true;
            stations.push_back(s);
        }
        const Index leaving = inside ? mesh_.next(h) : mesh_.prev(h);
        h = mesh_.twin(leaving);
        if (h == invalid_index) {
            add_middle(leaving, inside ? label[mesh_.from(leaving)] : label[third]);
            h = leaving;
            break;
        }
    } while (h != start && walked <= mixed);
    if (walked != mixed || first_junction == 0 || open != (mesh_.twin(h) == invalid_index))
        return {};
    if (!open) {
        std::rotate(stations.begin(),
                    stations.begin() + static_cast<std::ptrdiff_t>(first_junction), stations.end());
        return stations;
    }
    stations[first_middle].corner = true;
    stations.back().corner = true;
    stations.back().across = invalid_index;
    // Back along the boundary.
    Index v = label[mesh_.to(h)] == own ? mesh_.to(h) : mesh_.from(h);
    for (; v != site; v = mesh_.to(mesh_.halfedge_at(v))) {
        if (label[v] != own)
            return {};
        Station s;
        s.vertex = v;
        stations.push_back(s);
    }
    return stations;
}

std::optional<Overlay> OverlayBuilder::tile(const std::vector<Index>& label,
                                            const std::vector<Index>& members, Index site,
                                            std::vector<Index>& side_label)
{
    next_stamp();
    side_label.clear();
    const Index own = label[members.front()];
    const std::vector<Station> stations = walk_around(label, members, site);
    if (stations.empty())
        return std::nullopt;

    Overlay overlay;
    std::vector<std::pair<Index, Index>> junctions; // Face, overlay vertex.
    for (const Station& s : stations) {
        const Index id = static_cast<Index>(overlay.vertices.size());
        if (s.corner) {
            overlay.corners.push_back(id);
            side_label.push_back(invalid_index);
        }
        if (s.across != invalid_index)
            side_label.back() = s.across;
        if (s.vertex != invalid_index) {
            local_vertex(overlay, s.vertex);
            continue;
        }
        Overlay::Vertex v;
        if (s.halfedge == invalid_index) {
            v.face = s.face;
            v.bary = {1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0};
            v.position = mesh_.at({s.face, v.bary});
            junctions.emplace_back(s.face, id);
        } else {
            v.edge = mesh_.edge(s.halfedge);
            v.t = 0.5;
            v.position = edge_point(mesh_, v.edge, v.t);
            edge_points_.push_back({v.edge, v.t, id});
        }
        overlay.vertices.push_back(v);
    }
    overlay.boundary_count = static_cast<Index>(overlay.vertices.size());
    const Index side_count = overlay.side_count();
    for (Index s = 0, i = 0; s < side_count; ++s) {
        const Index end = s + 1 < side_count ? overlay.corners[s + 1] : overlay.boundary_count;
        vertex_sides_.push_back({s, (s + side_count - 1) % side_count});
        for (++i; i < end; ++i)
            vertex_sides_.push_back({s, invalid_index});
    }
    std::sort(edge_points_.begin(), edge_points_.end(),
              [](const EdgePoint& p, const EdgePoint& q) { return p.edge < q.edge; });
    std::sort(junctions.begin(), junctions.end());
    const auto midpoint = [this](Index halfedge) {
        const Index e = mesh_.edge(halfedge);
        return std::lower_bound(edge_points_.begin(), edge_points_.end(), e,
                                [](const EdgePoint& p, Index edge) { return p.edge < edge; })
            ->id;
    };

    for (const Index u : members) {
        Index g = mesh_.halfedge_at(u);
        const Index first = g;
        do {
            const Index f = mesh_.face(g);
            if (face_stamp_[f] != stamp_) {
                face_stamp_[f] = stamp_;
                polygon_.clear();
                for (Index k = 0; k < 3; ++k) {
                    const Index halfedge = 3 * f + k;
                    const bool inside = label[mesh_.from(halfedge)] == own;
                    const bool next_inside = label[mesh_.to(halfedge)] == own;
                    if (inside)
                        polygon_.push_back(local_vertex(overlay, mesh_.from(halfedge)));
                    if (inside != next_inside)
                        polygon_.push_back(midpoint(halfedge));
                    // Outside on both ends: the junction lies between the two midpoints.
                    if (!inside && !next_inside &&
                        label[mesh_.from(halfedge)] != label[mesh_.to(halfedge)]) {
                        const auto j = std::lower_bound(junctions.begin(), junctions.end(),
                                                        std::pair<Index, Index>(f, 0));
                        polygon_.push_back(j->second);
                    }
                }
                add_polygon(overlay, f, polygon_);
            }
            g = mesh_.twin(mesh_.prev(g));
        } while (g != first && g != invalid_index);
    }
    if (!is_disk(overlay))
        return std::nullopt;
    overlay.find_opposites();
    return overlay;
}

} // namespace bot2nurbs
