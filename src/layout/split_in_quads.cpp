// SPDX-License-Identifier: MIT
#include "layout/split_in_quads.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace bot2nurbs {

namespace {

using Side = PatchComplex::Side;

// The carrier with all paths cut in, while it grows.
class Cutter {
public:
    Cutter(PatchComplex& triangles, const ManifoldMesh& source, const CarrierMesh& carrier)
        : triangles_(triangles), source_(source), carrier_(carrier),
          vertex_source_(carrier.vertex_source), builder_(triangles.mesh())
    {
        // Carrier vertices keep their numbers; crossings follow, path by path.
        chain_.resize(triangles.paths().size());
        for (Index p = 0; p < chain_.size(); ++p) {
            const PatchComplex::Path& path = triangles.paths()[p];
            if (!path.alive)
                continue;
            chain_[p].push_back(path.geometry.a);
            for (const PathNode& n : path.geometry.nodes)
                chain_[p].push_back(n.is_vertex() ? n.vertex : add_vertex({}));
            chain_[p].push_back(path.geometry.b);
        }
    }

    // Adds the pieces of a face; its centre becomes a vertex.
    Status add_face(Index f)
    {
        const std::optional<Overlay> overlay =
            builder_.disk(triangles_.geometry(triangles_.faces()[f].sides));
        const auto map = overlay ? map_to_polygon(*overlay, regular_polygon(3)) : std::nullopt;
        if (!map)
            return Error{ErrorCode::layout_failed,
                         "face " + std::to_string(f) + " of the base complex cannot be mapped", f};
        std::vector<Index> number;
        for (const Side& s : triangles_.faces()[f].sides) {
            const auto& chain = chain_[s.path];
            for (std::size_t i = 0; i + 1 < chain.size(); ++i)
                number.push_back(chain[s.reversed ? chain.size() - 1 - i : i]);
        }
        for (std::size_t v = number.size(); v < overlay->vertices.size(); ++v) {
            const Index own = overlay->vertices[v].mesh_vertex;
            number.push_back(own != invalid_index ? own : add_vertex({}));
        }
        // The inner vertex nearest to the middle, or a new one in the triangle around it.
        Index center = invalid_index, around = 0;
        double nearest = std::numeric_limits<double>::infinity();
        for (Index v = overlay->boundary_count; v < overlay->vertices.size(); ++v)
            if (norm(map->uv[v]) < nearest) {
                nearest = norm(map->uv[v]);
                center = number[v];
            }
        if (center == invalid_index) {
            const Index face = overlay->face[around];
            const auto t = overlay->triangles[around];
            SourcePoint p{carrier_.face_source[face], {}};
            for (const Index v : t) {
                const auto w = source_weights(overlay->bary_in(carrier_.mesh, v, face), face);
                for (int k = 0; k < 3; ++k)
                    p.bary[k] += w[k] / 3.0;
            }
            center = add_vertex(p);
            for (int k = 0; k < 3; ++k)
                add_triangle(number[t[k]], number[t[(k + 1) % 3]], center, p.face);
        } else {
            around = invalid_index;
        }
        center_.push_back(center);
        for (Index t = 0; t < overlay->triangles.size(); ++t) {
            const Index face = overlay->face[t];
            for (const Index v : overlay->triangles[t]) {
                // Every new vertex is placed from whichever face has it first.
                SourcePoint& p = vertex_source_[number[v]];
                if (p.face == invalid_index)
                    p = {carrier_.face_source[face],
                         source_weights(overlay->bary_in(carrier_.mesh, v, face), face)};
            }
            if (t != around)
                add_triangle(number[overlay->triangles[t][0]], number[overlay->triangles[t][1]],
                             number[overlay->triangles[t][2]], carrier_.face_source[face]);
        }
        return {};
    }

    // Splits the single edge of every path that has no inner vertex.
    void split_bare_paths()
    {
        std::map<std::pair<Index, Index>, std::pair<Index, Index>> bare; // Edge to path and vertex.
        for (Index p = 0; p < chain_.size(); ++p)
            if (chain_[p].size() == 2) {
                const Index a = chain_[p][0], b = chain_[p][1];
                bare[{std::min(a, b), std::max(a, b)}] = {p, invalid_index};
            }
        if (bare.empty())
            return;
        // A face may have several such edges: the first piece keeps its place and is looked at
        // again, the second is looked at in its turn.
        for (std::size_t t = 0; t < triangle_.size(); ++t)
            for (int k = 0; k < 3; ++k) {
                const auto corner = triangle_[t];
                const Index a = corner[k], b = corner[(k + 1) % 3], c = corner[(k + 2) % 3];
                const auto found = bare.find({std::min(a, b), std::max(a, b)});
                if (found == bare.end())
                    continue;
                auto& [path, middle] = found->second;
                if (middle == invalid_index) {
                    const Index face = face_source_[t];
                    const auto wa = weights(a, face), wb = weights(b, face);
                    SourcePoint p{face, {}};
                    for (int i = 0; i < 3; ++i)
                        p.bary[i] = 0.5 * (wa[i] + wb[i]);
                    middle = add_vertex(p);
                    chain_[path].insert(chain_[path].begin() + 1, middle);
                }
                triangle_[t] = {a, middle, c};
                add_triangle(middle, b, c, face_source_[t]);
                k = -1;
            }
    }

    Result<SplitComplex> finish() const
    {
        auto carrier = std::make_unique<CarrierMesh>();
        carrier->refined = true;
        carrier->vertex_source = vertex_source_;
        carrier->face_source = face_source_;
        std::vector<Vec3> positions(vertex_source_.size());
        for (Index v = 0; v < positions.size(); ++v)
            positions[v] =
                v < source_.vertex_count() ? source_.position(v) : source_.at(vertex_source_[v]);
        auto mesh = ManifoldMesh::build(std::move(positions), triangle_);
        if (!mesh)
            return Error{ErrorCode::internal, "paths cut into a mesh: " + mesh.error().message,
                         mesh.error().element};
        carrier->mesh = std::move(*mesh);
        const ManifoldMesh& cut = carrier->mesh;
        SplitComplex result{std::move(carrier), PatchComplex(cut)};

        PatchComplex& quads = result.complex;
        std::vector<std::array<Index, 2>> half(chain_.size());
        for (Index p = 0; p < chain_.size(); ++p) {
            if (chain_[p].empty())
                continue;
            const std::size_t middle = middle_of(cut, chain_[p]);
            half[p] = {quads.add_path(piece(chain_[p], 0, middle)),
                       quads.add_path(piece(chain_[p], middle, chain_[p].size() - 1))};
            for (const Index h : half[p])
                quads.mark(h, triangles_.paths()[p].mark);
        }
        std::vector<Index> six;
        for (Index f = 0; f < triangles_.faces().size(); ++f) {
            if (!triangles_.faces()[f].alive())
                continue;
            std::vector<Side> sides;
            for (const Side& s : triangles_.faces()[f].sides) {
                sides.push_back({half[s.path][s.reversed ? 1 : 0], s.reversed});
                sides.push_back({half[s.path][s.reversed ? 0 : 1], s.reversed});
            }
            six.push_back(quads.add_face(std::move(sides)));
        }
        OverlayBuilder builder(cut);
        const Index none = invalid_index;
        for (std::size_t i = 0; i < six.size(); ++i) {
            const std::vector<Side> border = quads.faces()[six[i]].sides;
            const auto disk = map_disk(builder, quads.geometry(border));
            auto change = disk ? quads.plan({six[i]}, border, {{1, none}, {3, none}, {5, none}},
                                            *disk, center_[i])
                               : std::nullopt;
            if (!change)
                return Error{ErrorCode::layout_failed,
                             "face " + std::to_string(i) +
                                 " of the base complex cannot be split in three quads",
                             static_cast<Index>(i)};
            quads.apply(std::move(*change));
        }
        quads.compact();
        return result;
    }

private:
    Index add_vertex(const SourcePoint& p)
    {
        vertex_source_.push_back(p);
        return static_cast<Index>(vertex_source_.size() - 1);
    }
    void add_triangle(Index a, Index b, Index c, Index source_face)
    {
        triangle_.push_back({a, b, c});
        face_source_.push_back(source_face);
    }
    // Weights in the source face of carrier face f, of a point with the given weights in f.
    std::array<double, 3> source_weights(const std::array<double, 3>& w, Index f) const
    {
        std::array<double, 3> sum{};
        for (int i = 0; i < 3; ++i) {
            const auto c =
                carrier_.weights(source_, carrier_.mesh.triangle(f)[i], carrier_.face_source[f]);
            for (int j = 0; j < 3; ++j)
                sum[j] += w[i] * c[j];
        }
        return sum;
    }
    std::array<double, 3> weights(Index v, Index face) const
    {
        CarrierMesh one;
        one.vertex_source = {vertex_source_[v]};
        return one.weights(source_, 0, face);
    }
    static std::size_t middle_of(const ManifoldMesh& mesh, const std::vector<Index>& chain)
    {
        std::vector<double> arc{0.0};
        for (std::size_t i = 1; i < chain.size(); ++i)
            arc.push_back(arc.back() + norm(mesh.position(chain[i]) - mesh.position(chain[i - 1])));
        std::size_t best = 1;
        for (std::size_t i = 1; i + 1 < chain.size(); ++i)
            if (std::fabs(arc[i] - 0.5 * arc.back()) < std::fabs(arc[best] - 0.5 * arc.back()))
                best = i;
        return best;
    }
    static SurfacePath piece(const std::vector<Index>& chain, std::size_t first, std::size_t last)
    {
        SurfacePath path;
        path.a = chain[first];
        path.b = chain[last];
        for (std::size_t i = first + 1; i < last; ++i) {
            PathNode node;
            node.vertex = chain[i];
            path.nodes.push_back(node);
        }
        return path;
    }

    PatchComplex& triangles_;
    const ManifoldMesh& source_;
    const CarrierMesh& carrier_;
    std::vector<SourcePoint> vertex_source_;
    std::vector<std::array<Index, 3>> triangle_;
    std::vector<Index> face_source_;
    std::vector<std::vector<Index>> chain_; // Per path: its vertices, both ends included.
    std::vector<Index> center_;             // Per alive face.
    OverlayBuilder builder_;
};

} // namespace

Result<SplitComplex> split_in_quads(PatchComplex& triangles, const ManifoldMesh& source,
                                    const CarrierMesh& carrier, Context& context)
{
    Cutter cutter(triangles, source, carrier);
    for (Index f = 0; f < triangles.faces().size(); ++f) {
        if (context.cancelled())
            return Context::cancelled_error("layout");
        if (triangles.faces()[f].alive())
            if (Status failed = cutter.add_face(f))
                return *failed;
    }
    cutter.split_bare_paths();
    return cutter.finish();
}

} // namespace bot2nurbs
