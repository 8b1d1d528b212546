// SPDX-License-Identifier: MIT
#include "layout/base_complex.h"

#include "core/parallel.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <oneapi/tbb/enumerable_thread_specific.h>

namespace bot2nurbs {

namespace {

// Tiles mapped before any of their spokes are drawn: enough for all threads, few to keep.
constexpr std::size_t tiles_per_batch = 256;
constexpr std::size_t tiles_per_task = 4;

struct HalfPath {
    std::vector<PathNode> nodes;
    Index last_face = invalid_index; //!< The face it reaches the cut in; invalid: along the edge.
};

struct Cut {
    Index edge = invalid_index; //!< The mesh edge in whose middle the path crosses.
    HalfPath half[2];           //!< From the tile with the smaller, the larger label.
};

using CutKey = std::pair<Index, Index>;

CutKey key_of(Index i, Index j)
{
    return std::minmax(i, j);
}

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

// Maps tiles to polygons and draws their spokes.
class TileSpokes {
public:
    explicit TileSpokes(const Tiles& tiles)
        : tiles_(tiles), builders_([&tiles] { return OverlayBuilder(tiles.mesh()); })
    {
        tiles.list_members(offset_, members_);
    }

    Status run(Context& context)
    {
        const std::size_t count = tiles_.sites().size();
        for (std::size_t first = 0; first < count; first += tiles_per_batch) {
            batch_.assign(std::min(tiles_per_batch, count - first), {});
            const auto for_each_tile = [&](auto body) {
                return for_each_chunk(context, batch_.size(), tiles_per_task,
                                      [&](std::size_t begin, std::size_t end) {
                                          for (std::size_t k = begin; k < end; ++k)
                                              body(static_cast<Index>(first + k), batch_[k]);
                                      });
            };
            if (!for_each_tile([this](Index i, Tile& tile) { map(i, tile); }))
                return Context::cancelled_error("base complex");
            for (std::size_t k = 0; k < batch_.size(); ++k)
                choose_crossings(static_cast<Index>(first + k), batch_[k]);
            if (!for_each_tile([this](Index i, Tile& tile) { draw(i, tile); }))
                return Context::cancelled_error("base complex");
            for (std::size_t k = 0; k < batch_.size(); ++k)
                if (batch_[k].failed) {
                    const Index i = static_cast<Index>(first + k), site = tiles_.sites()[i];
                    return Error{ErrorCode::layout_failed,
                                 "tile " + std::to_string(i) + " around vertex " +
                                     std::to_string(site) + " " + batch_[k].failed,
                                 site};
                }
        }
        return {};
    }

    const std::map<CutKey, Cut>& cuts() const { return cuts_; }

private:
    struct Tile {
        const char* failed = nullptr; // Why, when it cannot be mapped or drawn.
        Overlay overlay;
        std::vector<Index> neighbour; // Per side.
        std::vector<Vec2> uv;
        bool open = false; // It is at the boundary, its site its first corner.
    };

    void map(Index i, Tile& tile)
    {
        const std::vector<Index> own(members_.begin() + offset_[i],
                                     members_.begin() + offset_[i + 1]);
        std::optional<Overlay> overlay =
            builders_.local().tile(tiles_.labels(), own, tiles_.sites()[i], tile.neighbour);
        if (!overlay) {
            tile.failed = "is not a disk";
            return;
        }
        tile.overlay = std::move(*overlay);
        tile.open = tile.neighbour.front() == invalid_index;
        std::optional<ConvexMap> map =
            map_to_polygon(tile.overlay, regular_polygon(tile.overlay.side_count()));
        if (map)
            tile.uv = std::move(map->uv);
        else
            tile.failed = "cannot be mapped to a polygon";
    }

    // The cuts that begin and end at a site at the boundary are crossed along the boundary.
    static bool has_spoke(const Tile& tile, Index side)
    {
        return !tile.open || (side > 1 && side + 2 < tile.overlay.side_count());
    }

    // The first tile at a cut says where it is crossed.
    void choose_crossings(Index i, const Tile& tile)
    {
        for (Index s = 0; !tile.failed && s < tile.overlay.side_count(); ++s)
            if (has_spoke(tile, s)) {
                Index& edge = cuts_[key_of(i, tile.neighbour[s])].edge;
                if (edge == invalid_index)
                    edge = tile.overlay.vertices[middle_of_side(tile.overlay, s)].edge;
            }
    }

    void draw(Index i, Tile& tile)
    {
        if (tile.failed)
            return;
        const ManifoldMesh& mesh = tiles_.mesh();
        const Overlay& overlay = tile.overlay;
        const Index site = tiles_.sites()[i];
        Index center = tile.open ? 0 : invalid_index;
        for (Index v = overlay.boundary_count; v < overlay.vertices.size(); ++v)
            if (overlay.vertices[v].mesh_vertex == site)
                center = v;
        std::vector<Segment> spokes;
        std::vector<Index> side_of;
        for (Index s = 0; s < overlay.side_count(); ++s) {
            if (!has_spoke(tile, s))
                continue;
            const Index edge = cuts_.at(key_of(i, tile.neighbour[s])).edge;
            Index target = middle_of_side(overlay, s);
            for (Index v = 0; v < overlay.boundary_count; ++v)
                if (overlay.vertices[v].edge == edge)
                    target = v;
            spokes.push_back({center, target});
            side_of.push_back(s);
        }
        auto drawn = draw_segments(mesh, overlay, tile.uv, spokes);
        if (!drawn) {
            tile.failed = "cannot hold its spokes";
            return;
        }
        for (std::size_t k = 0; k < side_of.size(); ++k) {
            const Index other = tile.neighbour[side_of[k]];
            Cut& cut = cuts_.at(key_of(i, other)); // Each tile writes its own half.
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

    const Tiles& tiles_;
    std::vector<Index> offset_, members_;
    oneapi::tbb::enumerable_thread_specific<OverlayBuilder> builders_;
    std::vector<Tile> batch_;
    std::map<CutKey, Cut> cuts_;
};

} // namespace

Result<PatchComplex> build_base_complex(const Tiles& tiles, Context& context)
{
    const ManifoldMesh& mesh = tiles.mesh();
    TileSpokes spokes(tiles);
    if (Status failed = spokes.run(context))
        return *failed;

    PatchComplex complex(mesh);
    std::map<CutKey, Index> path_of;
    for (const auto& [key, cut] : spokes.cuts())
        path_of[key] =
            complex.add_path(join(mesh, tiles.sites()[key.first], tiles.sites()[key.second], cut));
    const auto& label = tiles.labels();
    for (Index i = 0; i < tiles.sites().size(); ++i)
        if (mesh.is_boundary_vertex(tiles.sites()[i])) {
            SurfacePath path = boundary_path(tiles, i);
            const Index j = label[path.b];
            if (j < i)
                path = reversed(std::move(path));
            path_of[key_of(i, j)] = complex.add_path(std::move(path));
        }
    for (Index f = 0; f < mesh.face_count(); ++f) {
        const auto& t = mesh.triangle(f);
        const Index l[3] = {label[t[0]], label[t[1]], label[t[2]]};
        if (l[0] == l[1] || l[1] == l[2] || l[2] == l[0])
            continue;
        std::vector<PatchComplex::Side> sides;
        for (int k = 0; k < 3; ++k) {
            const Index a = l[k], b = l[(k + 1) % 3];
            sides.push_back({path_of.at(key_of(a, b)), a > b});
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
