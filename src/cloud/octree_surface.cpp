// SPDX-License-Identifier: MIT
//
// Lorensen, Cline, Marching Cubes, 1987; ambiguous faces by the sign of the bilinear function at
// its saddle (Nielson, Hamann 1991), which both sides of a face see alike.
#include "cloud/octree_surface.h"

#include "cloud/key_sort.h"
#include "cloud/loop_triangles.h"
#include "core/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace bot2nurbs {

namespace {

constexpr std::size_t cells_per_chunk = 1024;
//! How near to the end of its edge a vertex may lie, as a share of the edge.
constexpr double least_share = 0.1;

//! The corners of the side of a cell (0: x low, 1: x high, 2: y low, ...), counter-clockwise as
//! seen from outside.
constexpr int side_corners[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                    {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};

//! A vertex of the surface in a cell: its edge's key, and the sides of the cell it lies on, a bit
//! each.
struct Crossing {
    std::uint64_t key = 0;
    Vec3 position;
    unsigned sides = 0;
};

//! A corner of a face: its place on the grid of its level, and the function there.
struct FaceCorner {
    Lattice place{};
    double value = 0.0;
};

class CellSurface {
public:
    CellSurface(const Octree& tree, const OctreeFunction& function)
        : tree_(tree), function_(function)
    {
    }

    //! A polygon of the surface in a leaf.
    struct Polygon {
        std::vector<Crossing> corners;
    };

    //! The polygons of a leaf; none where its corners are all on one side.
    void find(int l, Index cell, std::vector<Polygon>& polygons)
    {
        polygons.clear();
        segments_.clear();
        if (!crossed(l, cell))
            return;
        const Lattice place = morton::decode(tree_.level(l).cells[cell]);
        for (int side = 0; side < 6; ++side)
            cut_side(l, cell, place, side);
        join(polygons);
    }

private:
    struct Segment {
        Crossing from, to;
        bool used = false;
    };

    bool inside(double value) const { return value >= function_.surface; }

    bool crossed(int l, Index cell) const
    {
        const OctreeLevel& level = tree_.level(l);
        const std::vector<double>& values = function_.values[static_cast<std::size_t>(l)];
        unsigned in = 0;
        for (Index k = 0; k < 8; ++k)
            in += inside(values[level.corners[8 * cell + k]]);
        return in > 0 && in < 8;
    }

    FaceCorner corner(int l, Index cell, int k) const
    {
        const OctreeLevel& level = tree_.level(l);
        const Index v = level.corners[8 * cell + static_cast<Index>(k)];
        return {morton::decode(level.vertices[v]),
                function_.values[static_cast<std::size_t>(l)][v]};
    }

    //! Segments on one side of a leaf: on its own face, or on the four faces of smaller cells
    //! beyond.
    void cut_side(int l, Index cell, const Lattice& place, int side)
    {
        const std::size_t axis = static_cast<std::size_t>(side / 2);
        const bool high = side % 2 != 0;
        Lattice beyond = place;
        beyond[axis] += high ? 1u : ~0u; // the cube's border wraps to no cell
        const Index neighbor = beyond[axis] < (std::uint32_t{1} << l)
                                   ? tree_.level(l).find_cell(beyond)
                                   : invalid_index;
        std::array<FaceCorner, 4> face;
        if (neighbor == invalid_index || tree_.level(l).is_leaf(neighbor)) {
            for (std::size_t i = 0; i < 4; ++i)
                face[i] = corner(l, cell, side_corners[side][i]);
            cut_face(l, face, side);
            return;
        }
        const Index first = tree_.level(l).children[neighbor];
        const int across = 1 << axis;
        for (int k = 0; k < 8; ++k) {
            // The children of the neighbour on this side.
            if (((k & across) != 0) == high)
                continue;
            // The corners of their faces towards us: ours, on the neighbour's other side.
            for (std::size_t i = 0; i < 4; ++i)
                face[i] =
                    corner(l + 1, first + static_cast<Index>(k), side_corners[side][i] ^ across);
            cut_face(l + 1, face, side);
        }
    }

    //! Segments run with the inside on their right, seen from outside the cell: then polygons turn
    //! outward.
    void cut_face(int l, const std::array<FaceCorner, 4>& face, int side)
    {
        unsigned mask = 0;
        for (std::size_t i = 0; i < 4; ++i)
            mask |= static_cast<unsigned>(inside(face[i].value)) << i;
        if (mask == 0 || mask == 15)
            return;
        const auto add = [&](std::size_t from, std::size_t to) {
            segments_.push_back({crossing(l, face[from], face[(from + 1) % 4], side),
                                 crossing(l, face[to], face[(to + 1) % 4], side)});
        };
        // Edge i joins corners i and i + 1. A segment starts on an edge that enters the inside and
        // ends on one that leaves it.
        std::array<std::size_t, 2> leaves{}, enters{};
        std::size_t count = 0, entering = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            const bool here = (mask >> i & 1) != 0, there = (mask >> (i + 1) % 4 & 1) != 0;
            if (here && !there)
                leaves[count++] = i;
            else if (!here && there)
                enters[entering++] = i;
        }
        if (count == 1) {
            add(enters[0], leaves[0]);
            return;
        }
        // Opposite corners inside: joined where the saddle is. Either way each segment joins two
        // neighbouring edges.
        double a = face[0].value - function_.surface, b = face[1].value - function_.surface,
               c = face[2].value - function_.surface, d = face[3].value - function_.surface;
        if ((mask & 1) == 0) {
            std::swap(a, b);
            std::swap(c, d);
        }
        const bool joined = a * c > b * d; // a, c inside: the saddle value has the sign of ac - bd
        for (std::size_t i = 0; i < 2; ++i) {
            const std::size_t before = (leaves[i] + 3) % 4, behind = (leaves[i] + 1) % 4;
            // Around the inside corner where this edge starts, or the outside one where it ends.
            add(joined ? behind : before, leaves[i]);
        }
    }

    //! The vertex on an edge that changes sign: on the half that does where smaller cells halve it.
    Crossing crossing(int l, FaceCorner a, FaceCorner b, int side) const
    {
        if (l < tree_.depth()) {
            FaceCorner middle;
            for (std::size_t k = 0; k < 3; ++k)
                middle.place[k] = a.place[k] + b.place[k];
            const Index v = tree_.level(l + 1).find_vertex(middle.place);
            if (v != invalid_index) {
                middle.value = function_.values[static_cast<std::size_t>(l) + 1][v];
                for (FaceCorner* end : {&a, &b})
                    for (std::uint32_t& x : end->place)
                        x *= 2;
                (inside(middle.value) == inside(a.value) ? a : b) = middle;
                ++l;
            }
        }
        // The key is the middle of the edge on the grid two levels below the finest; the vertex is
        // computed from the same end whichever face asks.
        if (b.place < a.place)
            std::swap(a, b);
        Crossing found;
        Lattice key;
        const double da = a.value - function_.surface, db = b.value - function_.surface;
        const double t = std::clamp(da / (da - db), least_share, 1.0 - least_share);
        const double h = Octree::cell_size(l);
        for (int k = 0; k < 3; ++k) {
            const std::size_t i = static_cast<std::size_t>(k);
            key[i] = (a.place[i] + b.place[i]) << (tree_.depth() - l);
            found.position[k] = h * ((1.0 - t) * a.place[i] + t * b.place[i]);
        }
        found.key = morton::encode(key);
        found.sides = 1u << side;
        return found;
    }

    //! Joins segments end to start.
    void join(std::vector<Polygon>& polygons)
    {
        for (Segment& start : segments_) {
            if (start.used)
                continue;
            polygons.emplace_back();
            std::vector<Crossing>& corners = polygons.back().corners;
            Segment* s = &start;
            while (s != nullptr && !s->used) {
                s->used = true;
                Segment* next = nullptr;
                for (Segment& other : segments_)
                    if (!other.used && other.from.key == s->to.key)
                        next = &other;
                corners.push_back(s->from);
                // A vertex lies on the sides of both its segments.
                Segment* behind = next != nullptr ? next : &start;
                behind->from.sides |= s->to.sides;
                if (next == nullptr)
                    corners.front().sides |= s->to.sides;
                s = next;
            }
        }
    }

    const Octree& tree_;
    const OctreeFunction& function_;
    std::vector<Segment> segments_;
};

//! The polygons of some cells as triangles, vertices by their keys.
struct SurfacePart {
    std::vector<std::uint64_t> keys;
    std::vector<Vec3> positions;
    std::vector<std::array<Index, 3>> triangles; //!< Of this part's vertices.
};

void add_polygon(const std::vector<Crossing>& corners, std::uint64_t own_key, LoopTriangles& loops,
                 SurfacePart& part)
{
    const Index first = static_cast<Index>(part.keys.size());
    std::vector<Vec3> positions;
    for (const Crossing& c : corners) {
        part.keys.push_back(c.key);
        part.positions.push_back(c.position);
        positions.push_back(c.position);
    }
    const int n = static_cast<int>(corners.size());
    // A diagonal within a face of the cell could be an edge of the cell beyond, too.
    const auto& triangles = loops.find(positions, [&](int i, int j) {
        return (corners[static_cast<std::size_t>(i)].sides &
                corners[static_cast<std::size_t>(j)].sides) != 0;
    });
    if (!triangles.empty()) {
        for (const auto& t : triangles)
            part.triangles.push_back({first + static_cast<Index>(t[0]),
                                      first + static_cast<Index>(t[1]),
                                      first + static_cast<Index>(t[2])});
        return;
    }
    // A vertex in the middle joins with all.
    Vec3 middle;
    for (const Vec3& p : positions)
        middle += p / n;
    const Index centre = first + static_cast<Index>(n);
    part.keys.push_back(own_key);
    part.positions.push_back(middle);
    for (int i = 0; i < n; ++i)
        part.triangles.push_back(
            {first + static_cast<Index>(i), first + static_cast<Index>((i + 1) % n), centre});
}

} // namespace

Result<TriangleSoup> octree_surface(const Octree& tree, const OctreeFunction& function,
                                    const Context& context)
{
    // Keys of vertices in the middle of polygons: above all keys of edges, by cell and polygon.
    const int edge_bits = 3 * (tree.depth() + 2);
    std::vector<SurfacePart> parts;
    std::uint64_t cells_before = 0;
    for (int l = 0; l <= tree.depth(); ++l) {
        const OctreeLevel& level = tree.level(l);
        const std::size_t first_part = parts.size();
        parts.resize(first_part + (level.cells.size() + cells_per_chunk - 1) / cells_per_chunk);
        for_each_chunk(context, level.cells.size(), cells_per_chunk,
                       [&](std::size_t begin, std::size_t end) {
                           CellSurface surface(tree, function);
                           LoopTriangles loops;
                           std::vector<CellSurface::Polygon> polygons;
                           SurfacePart& part = parts[first_part + begin / cells_per_chunk];
                           for (std::size_t c = begin; c < end; ++c) {
                               if (!level.is_leaf(static_cast<Index>(c)))
                                   continue;
                               surface.find(l, static_cast<Index>(c), polygons);
                               // At most four polygons a cell on its own grid, more beside smaller
                               // cells.
                               for (std::size_t p = 0; p < polygons.size(); ++p)
                                   add_polygon(polygons[p].corners,
                                               (std::uint64_t{1} << edge_bits) +
                                                   (((cells_before + c) << 4) | p),
                                               loops, part);
                           }
                       });
        cells_before += level.cells.size();
    }
    std::vector<KeyedSlot> items;
    for (const SurfacePart& part : parts)
        for (const std::uint64_t key : part.keys)
            items.push_back({key, static_cast<Index>(items.size())});
    if (context.cancelled() || !sort_keys(items, edge_bits + 1, context))
        return Context::cancelled_error("reconstruction");

    TriangleSoup soup;
    std::vector<Index> vertex(items.size());
    std::vector<Vec3> positions;
    positions.reserve(items.size());
    for (const SurfacePart& part : parts)
        positions.insert(positions.end(), part.positions.begin(), part.positions.end());
    for (std::size_t i = 0; i < items.size(); ++i) {
        if (i == 0 || items[i].key != items[i - 1].key)
            soup.positions.push_back(positions[items[i].slot]);
        vertex[items[i].slot] = static_cast<Index>(soup.positions.size() - 1);
    }
    Index first = 0;
    for (const SurfacePart& part : parts) {
        for (const auto& t : part.triangles) {
            soup.source_face.push_back(static_cast<Index>(soup.triangles.size()));
            soup.triangles.push_back(
                {vertex[first + t[0]], vertex[first + t[1]], vertex[first + t[2]]});
        }
        first += static_cast<Index>(part.keys.size());
    }
    return soup;
}

} // namespace bot2nurbs
