// SPDX-License-Identifier: MIT
#include "bot2nurbs/manifold_mesh.h"

#include <algorithm>
#include <cstring>

namespace bot2nurbs {

namespace {

Error face_error(ErrorCode code, Index face, const std::string& what)
{
    return {code, "triangle " + std::to_string(face) + " " + what, face};
}

//! The first triangle with an impossible corner, or a vertex that is not finite or not used.
Status check_elements(const std::vector<Vec3>& positions,
                      const std::vector<std::array<Index, 3>>& triangles)
{
    if (triangles.empty())
        return Error{ErrorCode::empty_input, "the mesh has no triangles", invalid_index};
    // The last halfedge and every index must stay below invalid_index.
    if (triangles.size() >= invalid_index / 3 || positions.size() >= invalid_index)
        return Error{ErrorCode::bad_geometry,
                     "the mesh has more elements than 32-bit indices allow", invalid_index};
    std::vector<char> used(positions.size(), 0);
    for (std::size_t f = 0; f < triangles.size(); ++f) {
        const auto& t = triangles[f];
        for (const Index v : t) {
            if (v >= positions.size())
                return face_error(ErrorCode::bad_geometry, static_cast<Index>(f),
                                  "uses vertex " + std::to_string(v) + " of " +
                                      std::to_string(positions.size()));
            used[v] = 1;
        }
        if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0])
            return face_error(ErrorCode::not_manifold, static_cast<Index>(f),
                              "uses a vertex twice");
    }
    for (std::size_t v = 0; v < positions.size(); ++v) {
        if (!used[v])
            return Error{ErrorCode::bad_geometry,
                         "vertex " + std::to_string(v) + " is not used by any triangle",
                         static_cast<Index>(v)};
        if (!is_finite(positions[v]))
            return Error{ErrorCode::bad_geometry,
                         "vertex " + std::to_string(v) + " has a coordinate that is not finite",
                         static_cast<Index>(v)};
    }
    return std::nullopt;
}

} // namespace

Result<ManifoldMesh> ManifoldMesh::build(std::vector<Vec3> positions,
                                         std::vector<std::array<Index, 3>> triangles)
{
    if (Status bad = check_elements(positions, triangles))
        return *bad;
    ManifoldMesh mesh;
    mesh.positions_ = std::move(positions);
    mesh.triangles_ = std::move(triangles);
    const Index vertices = mesh.vertex_count();
    const Index halfedges = mesh.halfedge_count();

    // Outgoing halfedges by start vertex, in ascending order within each vertex.
    std::vector<Index> first(vertices + 1, 0);
    for (Index h = 0; h < halfedges; ++h)
        ++first[mesh.from(h) + 1];
    for (Index v = 0; v < vertices; ++v)
        first[v + 1] += first[v];
    std::vector<std::pair<Index, Index>> outgoing(halfedges); // (end vertex, halfedge)
    {
        std::vector<Index> next_slot(first.begin(), first.end() - 1);
        for (Index h = 0; h < halfedges; ++h)
            outgoing[next_slot[mesh.from(h)]++] = {mesh.to(h), h};
    }
    Index repeated = invalid_index; // smallest halfedge that repeats a directed edge
    for (Index v = 0; v < vertices; ++v) {
        std::sort(outgoing.begin() + first[v], outgoing.begin() + first[v + 1]);
        for (Index i = first[v] + 1; i < first[v + 1]; ++i)
            if (outgoing[i].first == outgoing[i - 1].first)
                repeated = std::min(repeated, outgoing[i].second);
    }
    if (repeated != invalid_index)
        return face_error(ErrorCode::not_manifold, face(repeated),
                          "repeats the edge from vertex " + std::to_string(mesh.from(repeated)) +
                              " to " + std::to_string(mesh.to(repeated)) +
                              " in the direction of another triangle");

    mesh.twin_.assign(halfedges, invalid_index);
    for (Index h = 0; h < halfedges; ++h) {
        if (mesh.twin_[h] != invalid_index)
            continue;
        const Index a = mesh.from(h), b = mesh.to(h);
        const auto begin = outgoing.begin() + first[b], end = outgoing.begin() + first[b + 1];
        const auto found = std::lower_bound(begin, end, std::make_pair(a, Index{0}));
        if (found != end && found->first == a) {
            mesh.twin_[h] = found->second;
            mesh.twin_[found->second] = h;
        }
    }
    for (Index f = 0; f < mesh.face_count(); ++f) {
        const Index g = mesh.twin_[3 * f];
        if (g != invalid_index && mesh.twin_[3 * f + 1] != invalid_index &&
            mesh.twin_[3 * f + 2] != invalid_index && face(g) == face(mesh.twin_[3 * f + 1]) &&
            face(g) == face(mesh.twin_[3 * f + 2]))
            return face_error(ErrorCode::not_manifold, std::max(f, face(g)),
                              "repeats triangle " + std::to_string(std::min(f, face(g))));
    }

    Index boundary = 0, twinned = 0;
    mesh.vertex_halfedge_.assign(vertices, invalid_index);
    for (Index h = 0; h < halfedges; ++h) {
        Index& at = mesh.vertex_halfedge_[mesh.from(h)];
        if (mesh.twin_[h] == invalid_index) {
            ++boundary;
            // A second boundary halfedge at v shows as an unvisited fan below.
            if (at == invalid_index || mesh.twin_[at] != invalid_index)
                at = h;
        } else {
            ++twinned;
            if (at == invalid_index)
                at = h;
        }
    }
    mesh.boundary_halfedges_ = boundary;
    mesh.edge_count_ = boundary + twinned / 2;

    // One fan per vertex: turning visits as many faces as the vertex has outgoing halfedges.
    for (Index v = 0; v < vertices; ++v) {
        const Index start = mesh.vertex_halfedge_[v];
        Index visited = 0;
        for (Index h = start; h != invalid_index;) {
            ++visited;
            h = mesh.twin_[prev(h)];
            if (h == start)
                break;
        }
        if (visited != first[v + 1] - first[v]) {
            Index offending = invalid_index;
            for (Index i = first[v]; i < first[v + 1]; ++i)
                offending = std::min(offending, face(outgoing[i].second));
            return face_error(ErrorCode::not_manifold, offending,
                              "meets other triangles at vertex " + std::to_string(v) +
                                  " in that point only: the faces there form more than one fan");
        }
    }
    return mesh;
}

Index ManifoldMesh::find_halfedge(Index a, Index b) const
{
    const Index start = vertex_halfedge_[a];
    for (Index h = start;;) {
        if (to(h) == b)
            return h;
        const Index p = prev(h);
        h = twin_[p];
        if (h == start)
            return invalid_index;
        if (h == invalid_index) // the last face of a boundary fan: its incoming edge has no twin
            return invalid_index;
    }
}

Box3 ManifoldMesh::box() const
{
    Box3 box;
    for (const Vec3& p : positions_)
        box.add(p);
    return box;
}

double ManifoldMesh::volume() const
{
    if (positions_.empty())
        return 0.0;
    // About the centre of the box: a model far from the origin keeps its digits.
    const Vec3 origin = box().center();
    double six_volumes = 0.0;
    for (const auto& t : triangles_) {
        const Vec3 a = positions_[t[0]] - origin, b = positions_[t[1]] - origin,
                   c = positions_[t[2]] - origin;
        six_volumes += dot(a, cross(b, c));
    }
    return six_volumes / 6.0;
}

int ManifoldMesh::genus() const
{
    const long long euler = static_cast<long long>(vertex_count()) - edge_count() + face_count();
    return static_cast<int>((2 - euler) / 2);
}

std::string signature(const ManifoldMesh& mesh)
{
    std::uint64_t hash = 14695981039346656037ull;
    const auto feed = [&hash](std::uint64_t word, int bytes) {
        for (int i = 0; i < bytes; ++i) {
            hash ^= (word >> (8 * i)) & 0xffu;
            hash *= 1099511628211ull;
        }
    };
    feed(mesh.vertex_count(), 4);
    feed(mesh.face_count(), 4);
    for (const Vec3& p : mesh.positions())
        for (int k = 0; k < 3; ++k) {
            std::uint64_t word;
            const double x = p[k];
            std::memcpy(&word, &x, sizeof word);
            feed(word, 8);
        }
    for (const auto& t : mesh.triangles())
        for (const Index v : t)
            feed(v, 4);
    static const char digits[] = "0123456789abcdef";
    std::string text(16, '0');
    for (int i = 0; i < 16; ++i)
        text[i] = digits[(hash >> (60 - 4 * i)) & 0xfu];
    return text;
}

} // namespace bot2nurbs
