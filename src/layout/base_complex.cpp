// SPDX-License-Identifier: MIT
#include "layout/base_complex.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace bot2nurbs {

namespace {

struct HalfPath {
    std::vector<PathNode> nodes;
    Index last_face = invalid_index; //!< The face it reaches the cut in; invalid: along the edge.
};

struct Cut {
    Index edge = invalid_index; //!< The mesh edge in whose middle the path crosses.
    HalfPath half[2];           //!< From the tile with the smaller, the larger label.
};

using CutKey = std::pair<Index, Index>;

// The border vertex in the middle of side s, by arc length, among those on mesh edges.
Index middle_of_side(const Overlay& tile, Index s)
{
    const Index first = tile.corners[s];
    const Index last = s + 1 < tile.side_count() ? tile.corners[s + 1] : tile.boundary_count;
    std::vector<double> arc{0.0};
    for (Index i = first; i < last; ++i)
        arc.push_back(arc.back() + norm(tile.vertices[(i + 1) % tile.boundary_count].position -
                                        tile.vertices[i].position));
    Index best = first + 1;
    for (Index i = first + 1; i < last; ++i)
        if (std::fabs(arc[i - first] - 0.5 * arc.back()) <
            std::fabs(arc[best - first] - 0.5 * arc.back()))
            best = i;
    return best;
}

SurfacePath join(const ManifoldMesh& mesh, Index a, Index b, const Cut& cut)
{
    SurfacePath path;
    path.a = a;
    path.b = b;
    path.nodes = cut.half[0].nodes;
    const Index f0 = cut.half[0].last_face, f1 = cut.half[1].last_face;
    // A half along the cut's own edge may pass it on either side: on that of the other half.
    if (f0 != invalid_index && f1 != invalid_index && f0 != f1) {
        PathNode node;
        node.halfedge = mesh.face(cut.edge) == f0 ? cut.edge : mesh.twin(cut.edge);
        node.t = 0.5;
        path.nodes.push_back(node);
    }
    for (auto n = cut.half[1].nodes.rbegin(); n != cut.half[1].nodes.rend(); ++n) {
        PathNode node = *n;
        node.halfedge = mesh.twin(node.halfedge);
        path.nodes.push_back(node);
    }
    reduce(mesh, path);
    return path;
}

// The way along the boundary from a site to the next one, the surface to the left.
SurfacePath boundary_path(const Tiles& tiles, Index site)
{
    const ManifoldMesh& mesh = tiles.mesh();
    SurfacePath path;
    path.a = tiles.sites()[site];
    path.b = mesh.to(mesh.halfedge_at(path.a));
    while (tiles.sites()[tiles.labels()[path.b]] != path.b) {
        PathNode node;
        node.vertex = path.b;
        path.nodes.push_back(node);
        path.b = mesh.to(mesh.halfedge_at(path.b));
    }
    return path;
}

// A path of mesh vertices, walked the other way.
SurfacePath reversed(SurfacePath path)
{
    std::swap(path.a, path.b);
    std::reverse(path.nodes.begin(), path.nodes.end());
    return path;
}

} // namespace

Result<PatchComplex> build_base_complex(const Tiles& tiles, Context& context)
{
    const ManifoldMesh& mesh = tiles.mesh();
    std::vector<Index> offset, members;
    tiles.list_members(offset, members);
    std::map<CutKey, Cut> cuts;
    OverlayBuilder builder(mesh);
    for (Index i = 0; i < tiles.sites().size(); ++i) {
        if (context.cancelled())
            return Context::cancelled_error("base complex");
        const std::vector<Index> own(members.begin() + offset[i], members.begin() + offset[i + 1]);
        std::vector<Index> neighbour;
        const auto failed = [&](const char* why) {
            return Error{ErrorCode::layout_failed,
                         "tile " + std::to_string(i) + " around vertex " +
                             std::to_string(tiles.sites()[i]) + " " + why,
                         tiles.sites()[i]};
        };
        const Index site = tiles.sites()[i];
        const std::optional<Overlay> tile = builder.tile(tiles.labels(), own, site, neighbour);
        if (!tile)
            return failed("is not a disk");
        const auto map = map_to_polygon(*tile, regular_polygon(tile->side_count()));
        if (!map)
            return failed("cannot be mapped to a polygon");
        // A site at the boundary is the first corner of its tile; the cuts that begin and end there
        // are crossed along the boundary.
        const bool open = neighbour.front() == invalid_index;
        Index center = open ? 0 : invalid_index;
        for (Index v = tile->boundary_count; v < tile->vertices.size(); ++v)
            if (tile->vertices[v].mesh_vertex == site)
                center = v;
        std::vector<Segment> spokes;
        std::vector<Index> side_of;
        for (Index s = 0; s < tile->side_count(); ++s) {
            if (open && (s <= 1 || s + 2 >= tile->side_count()))
                continue;
            Cut& cut = cuts[{std::min(i, neighbour[s]), std::max(i, neighbour[s])}];
            Index target = middle_of_side(*tile, s);
            if (cut.edge == invalid_index) {
                cut.edge = tile->vertices[target].edge;
            } else {
                for (Index v = 0; v < tile->boundary_count; ++v)
                    if (tile->vertices[v].edge == cut.edge)
                        target = v;
            }
            spokes.push_back({center, target});
            side_of.push_back(s);
        }
        auto drawn = draw_segments(mesh, *tile, map->uv, spokes);
        if (!drawn)
            return failed("cannot hold its spokes");
        for (std::size_t k = 0; k < side_of.size(); ++k) {
            const Index other = neighbour[side_of[k]];
            Cut& cut = cuts[{std::min(i, other), std::max(i, other)}];
            HalfPath& half = cut.half[i < other ? 0 : 1];
            half.nodes = std::move((*drawn)[k].nodes);
            if (!half.nodes.empty()) {
                half.last_face = mesh.face(mesh.twin(half.nodes.back().halfedge));
            } else {
                // Straight from the site: it is opposite to the cut's edge, or an end of it.
                for (const Index h : {cut.edge, mesh.twin(cut.edge)})
                    if (mesh.from(mesh.prev(h)) == site)
                        half.last_face = mesh.face(h);
            }
        }
    }

    PatchComplex complex(mesh);
    std::map<CutKey, Index> path_of;
    for (const auto& [key, cut] : cuts)
        path_of[key] =
            complex.add_path(join(mesh, tiles.sites()[key.first], tiles.sites()[key.second], cut));
    const auto& label = tiles.labels();
    for (Index i = 0; i < tiles.sites().size(); ++i)
        if (mesh.is_boundary_vertex(tiles.sites()[i])) {
            SurfacePath path = boundary_path(tiles, i);
            const Index j = label[path.b];
            if (j < i)
                path = reversed(std::move(path));
            path_of[{std::min(i, j), std::max(i, j)}] = complex.add_path(std::move(path));
        }
    for (Index f = 0; f < mesh.face_count(); ++f) {
        const auto& t = mesh.triangle(f);
        const Index l[3] = {label[t[0]], label[t[1]], label[t[2]]};
        if (l[0] == l[1] || l[1] == l[2] || l[2] == l[0])
            continue;
        std::vector<PatchComplex::Side> sides;
        for (int k = 0; k < 3; ++k) {
            const Index a = l[k], b = l[(k + 1) % 3];
            sides.push_back({path_of.at({std::min(a, b), std::max(a, b)}), a > b});
        }
        complex.add_face(std::move(sides));
    }
    return complex;
}

void straighten_triangles(PatchComplex& complex, Context& context)
{
    OverlayBuilder builder(complex.mesh());
    const Index count = static_cast<Index>(complex.paths().size());
    for (Index p = 0; p < count && !context.cancelled(); ++p) {
        const PatchComplex::Path& path = complex.paths()[p];
        if (!path.alive || complex.is_boundary(p))
            continue;
        const std::vector<Index> faces{path.left, path.right};
        const auto border = complex.border(faces);
        if (!border || border->size() != 4)
            continue;
        Index a = 0;
        while (complex.start((*border)[a]) != path.geometry.a)
            ++a;
        auto change = complex.plan(faces, *border, {{a, (a + 2) % 4}}, builder);
        if (change)
            complex.apply(std::move(*change));
    }
    complex.compact();
}

} // namespace bot2nurbs
