// SPDX-License-Identifier: MIT
#include "bot2nurbs/repair_mesh.h"

#include "mesh/count_of.h"
#include "mesh/degenerate_faces.h"
#include "mesh/soup_topology.h"
#include "mesh/split_nonmanifold.h"
#include "mesh/turn_outward.h"
#include "mesh/weld.h"

#include <algorithm>

namespace bot2nurbs {

namespace {

// Welding over larger distances would destroy any model.
constexpr double largest_weld = 0.1;

class Repairer {
public:
    Repairer(TriangleSoup soup, const RepairOptions& options, Context& context)
        : soup_(std::move(soup)), options_(options), context_(context)
    {
    }

    Result<RepairedMesh> repair()
    {
        if (Status bad = check_elements())
            return *bad;
        for (Index f = 0; f < soup_.triangles.size(); ++f)
            source_.push_back(f);
        triangles_ = std::move(soup_.triangles);

        remove_repeated_vertices();
        weld();
        remove_repeated_vertices();
        remove_duplicates();
        remove_degenerate();
        note("repeated_vertex", repeated_,
             "removed " + count_of(repeated_, "face that uses", "faces that use") +
                 " a vertex twice");
        note("duplicate_face", duplicates_,
             "removed " + count_of(duplicates_, "face", "faces") +
                 " with the vertices of another face");
        if (triangles_.empty())
            return Error{ErrorCode::bad_geometry, "no face of the mesh has an area", invalid_index};
        if (context_.cancelled())
            return Context::cancelled_error("repair");
        return split_components();
    }

private:
    void note(const char* code, Index count, const std::string& message, bool warning = false)
    {
        if (count > 0)
            out_.notes.push_back({code, message, count, warning});
    }

    Status check_elements()
    {
        if (soup_.triangles.empty())
            return Error{ErrorCode::empty_input, "the mesh has no faces", invalid_index};
        if (soup_.triangles.size() >= invalid_index / 3 || soup_.positions.size() >= invalid_index)
            return Error{ErrorCode::bad_geometry,
                         "the mesh has more elements than 32-bit indices allow", invalid_index};
        std::vector<char> used(soup_.positions.size(), 0);
        for (Index f = 0; f < soup_.triangles.size(); ++f)
            for (const Index v : soup_.triangles[f]) {
                if (v >= soup_.positions.size())
                    return Error{ErrorCode::bad_geometry,
                                 "face " + std::to_string(f) + " names vertex " +
                                     std::to_string(v) + " of " +
                                     std::to_string(soup_.positions.size()),
                                 f};
                if (!is_finite(soup_.positions[v]))
                    return Error{ErrorCode::bad_geometry,
                                 "vertex " + std::to_string(v) + " of face " + std::to_string(f) +
                                     " has a coordinate that is not finite",
                                 v};
                used[v] = 1;
                out_.box.add(soup_.positions[v]);
            }
        const Index unused = static_cast<Index>(std::count(used.begin(), used.end(), char{0}));
        note("unused_vertex", unused,
             "removed " +
                 count_of(unused, "vertex that no face uses", "vertices that no face uses"));
        // A vertex without faces may be anywhere, even not finite; it takes part in nothing.
        for (Index v = 0; v < soup_.positions.size(); ++v)
            if (!used[v])
                soup_.positions[v] = out_.box.min;
        weld_ = options_.weld * out_.box.diagonal();
        thin_ = std::min(options_.weld, tolerance::weld) * out_.box.diagonal();
        if (!(out_.box.diagonal() > 0.0))
            return Error{ErrorCode::bad_geometry, "all vertices of the mesh lie on one point", 0};
        if (!std::isfinite(norm_squared(out_.box.max - out_.box.min)))
            return Error{ErrorCode::bad_geometry,
                         "the mesh is so large that squared lengths overflow", invalid_index};
        return std::nullopt;
    }

    //! Keeps the triangles with a true entry.
    void keep(const std::vector<char>& kept)
    {
        std::size_t n = 0;
        for (std::size_t f = 0; f < triangles_.size(); ++f)
            if (kept[f]) {
                triangles_[n] = triangles_[f];
                source_[n] = source_[f];
                ++n;
            }
        triangles_.resize(n);
        source_.resize(n);
    }

    void remove_repeated_vertices()
    {
        std::vector<char> kept(triangles_.size(), 1);
        Index removed = 0;
        for (std::size_t f = 0; f < triangles_.size(); ++f) {
            const auto& t = triangles_[f];
            if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) {
                kept[f] = 0;
                ++removed;
            }
        }
        repeated_ += removed;
        if (removed > 0)
            keep(kept);
    }

    void weld()
    {
        const SoupTopology topology(static_cast<Index>(soup_.positions.size()), triangles_);
        std::vector<char> open(soup_.positions.size(), 0);
        for (Index h = 0; h < 3 * triangles_.size(); ++h)
            if (topology.face_count(topology.edge_of(h)) == 1)
                open[topology.from(h)] = open[topology.from(SoupTopology::next(h))] = 1;
        const std::vector<Index> group = weld_points(soup_.positions, open, weld_);
        bool any = false;
        for (Index v = 0; v < group.size(); ++v)
            any = any || group[v] != v;
        if (!any)
            return;
        const std::vector<std::array<Index, 3>> before = triangles_;
        for (auto& t : triangles_)
            for (Index& v : t)
                v = group[v];
        keep_fans_apart(before);
        std::vector<char> used_before(group.size(), 0), used_after(group.size(), 0);
        for (std::size_t f = 0; f < triangles_.size(); ++f)
            for (int k = 0; k < 3; ++k) {
                used_before[before[f][k]] = 1;
                used_after[triangles_[f][k]] = 1;
            }
        Index welded = 0;
        for (Index v = 0; v < group.size(); ++v)
            welded += used_before[v] && !used_after[v];
        note("weld", welded,
             "welded " + count_of(welded, "vertex to another", "vertices to others") +
                 (options_.weld > tolerance::weld ? " within the weld distance"
                                                  : " at the same place"));
    }

    //! Where welding only made separate fans meet in a point, each gets a vertex of its own back:
    //! the smallest of those that it was welded from. Vertices of edges with more than two faces
    //! stay as they are, so that the error can name these.
    void keep_fans_apart(const std::vector<std::array<Index, 3>>& before)
    {
        const Index vertices = static_cast<Index>(soup_.positions.size());
        // Faces that the weld made repeat a vertex hang on nothing.
        std::vector<std::array<Index, 3>> sound;
        std::vector<std::size_t> face;
        for (std::size_t f = 0; f < triangles_.size(); ++f) {
            const auto& t = triangles_[f];
            if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) {
                sound.push_back(t);
                face.push_back(f);
            }
        }
        const SoupTopology topology(vertices, sound);
        std::vector<char> fixed(vertices, 0);
        for (Index h = 0; h < 3 * sound.size(); ++h)
            if (topology.face_count(topology.edge_of(h)) > 2)
                fixed[topology.from(h)] = fixed[topology.from(SoupTopology::next(h))] = 1;
        const std::vector<Index> fans = topology.fans_per_vertex(vertices);
        std::vector<Index> own(topology.fan_count(), invalid_index);
        for (Index h = 0; h < 3 * sound.size(); ++h)
            own[topology.fan(h)] = std::min(own[topology.fan(h)], before[face[h / 3]][h % 3]);
        for (Index h = 0; h < 3 * sound.size(); ++h)
            if (fans[topology.from(h)] > 1 && !fixed[topology.from(h)])
                triangles_[face[h / 3]][h % 3] = own[topology.fan(h)];
    }

    void remove_duplicates()
    {
        const std::vector<Index> copies = duplicate_faces(triangles_);
        if (copies.empty())
            return;
        std::vector<char> kept(triangles_.size(), 1);
        for (const Index f : copies)
            kept[f] = 0;
        keep(kept);
        duplicates_ += static_cast<Index>(copies.size());
    }

    void remove_degenerate()
    {
        const DegenerateRemoval removal =
            remove_degenerate_faces(soup_.positions, thin_, triangles_);
        std::vector<char> kept(triangles_.size());
        for (std::size_t f = 0; f < triangles_.size(); ++f)
            kept[f] = triangles_[f][0] != invalid_index;
        if (!removal.kept.empty())
            note("zero_area_kept", static_cast<Index>(removal.kept.size()),
                 "kept " + count_of(static_cast<Index>(removal.kept.size()), "face", "faces") +
                     " without area that cannot go without tearing the surface (first: face " +
                     std::to_string(source_[removal.kept[0]]) + ")",
                 true);
        if (removal.collapsed_edges + removal.flipped_caps > 0)
            keep(kept);
        note("collapsed_edge", removal.collapsed_edges,
             "collapsed " + count_of(removal.collapsed_edges, "edge", "edges") + " of no length");
        note("flipped_cap", removal.flipped_caps,
             "removed " + count_of(removal.flipped_caps, "face", "faces") +
                 " without area whose corner lies on the opposite side");
        remove_duplicates();
    }

    //! The first edge or vertex that is not manifold, named in the numbering of the soup.
    Status check_manifold(const SoupTopology& topology) const
    {
        const char* advice = "; repairing with split_nonmanifold cuts the surface apart there";
        Index thick = 0, worst = invalid_index;
        for (Index e = 0; e < topology.edge_count(); ++e) {
            if (topology.face_count(e) <= 2)
                continue;
            ++thick;
            worst = std::min(worst, *topology.halfedges(e).first);
        }
        if (thick > 0) {
            const Index e = topology.edge_of(worst);
            std::string faces;
            for (const Index* h = topology.halfedges(e).first; h != topology.halfedges(e).second;
                 ++h)
                faces += (faces.empty() ? "" : ", ") + std::to_string(source_[*h / 3]);
            return Error{ErrorCode::not_manifold,
                         count_of(thick, "edge has", "edges have") +
                             " more than two faces (first: from vertex " +
                             std::to_string(topology.from(worst)) + " to vertex " +
                             std::to_string(topology.from(SoupTopology::next(worst))) + ", faces " +
                             faces + ")" + advice,
                         source_[worst / 3]};
        }
        const std::vector<Index> fans =
            topology.fans_per_vertex(static_cast<Index>(soup_.positions.size()));
        Index pinched = 0, first = invalid_index;
        for (Index v = 0; v < fans.size(); ++v)
            if (fans[v] > 1) {
                ++pinched;
                first = std::min(first, v);
            }
        if (pinched > 0)
            return Error{ErrorCode::not_manifold,
                         count_of(pinched, "vertex joins", "vertices join") +
                             " several fans of faces that meet in that point only (first: vertex " +
                             std::to_string(first) + ")" + advice,
                         first};
        return std::nullopt;
    }

    Result<RepairedMesh> split_components()
    {
        SoupTopology topology(static_cast<Index>(soup_.positions.size()), triangles_);
        if (options_.split_nonmanifold) {
            const SplitCount split = split_nonmanifold(soup_.positions, topology);
            note("split_edge", split.edges,
                 "cut the surface apart along " + count_of(split.edges, "edge", "edges") +
                     " with more than two faces");
            note("split_vertex", split.vertices,
                 "gave each fan of faces a vertex of its own at " +
                     count_of(split.vertices, "vertex", "vertices"));
        } else if (Status bad = check_manifold(topology)) {
            return *bad;
        }
        for (Index c = 0; c < topology.component_count(); ++c)
            if (const Index h = topology.twist()[c]; h != invalid_index)
                return Error{ErrorCode::not_orientable,
                             "the faces cannot be turned to agree: the surface is one-sided "
                             "(seen at face " +
                                 std::to_string(source_[h / 3]) + ")",
                             source_[h / 3]};
        orient(topology);
        if (Status bad = build_components(topology))
            return *bad;
        turn_outward(out_, thin_);
        return std::move(out_);
    }

    //! Turns the minority of each component.
    void orient(const SoupTopology& topology)
    {
        std::vector<Index> faces(topology.component_count(), 0), turned(faces);
        for (Index f = 0; f < triangles_.size(); ++f) {
            ++faces[topology.component(f)];
            turned[topology.component(f)] += topology.turn(f);
        }
        Index count = 0;
        turn_.resize(triangles_.size());
        for (Index f = 0; f < triangles_.size(); ++f) {
            const Index c = topology.component(f);
            turn_[f] = topology.turn(f) != (2 * turned[c] > faces[c]);
            count += turn_[f];
        }
        note("oriented", count,
             "turned " + count_of(count, "face", "faces") + " round to agree with the others");
    }

    Status build_components(const SoupTopology& topology)
    {
        const Index n = topology.component_count();
        std::vector<std::vector<Index>> faces(n);
        for (Index f = 0; f < triangles_.size(); ++f)
            faces[topology.component(f)].push_back(f);
        std::vector<Index> loops(n, 0);
        for (const SoupTopology::Loop& loop : topology.loops())
            ++loops[loop.component];
        std::vector<Index> local(topology.fan_count(), invalid_index);
        out_.components.resize(n);
        for (Index c = 0; c < n; ++c) {
            if (context_.cancelled())
                return Context::cancelled_error("repair");
            MeshComponent& component = out_.components[c];
            // Vertices in the order of the soup, so that a clean mesh comes out as it went in.
            std::vector<std::pair<Index, Index>> fans; // (vertex, fan)
            for (const Index f : faces[c])
                for (Index h = 3 * f; h < 3 * f + 3; ++h)
                    if (Index& seen = local[topology.fan(h)]; seen == invalid_index) {
                        seen = 0;
                        fans.push_back({topology.from(h), topology.fan(h)});
                    }
            std::sort(fans.begin(), fans.end());
            std::vector<Vec3> positions;
            positions.reserve(fans.size());
            component.source_vertex.reserve(fans.size());
            for (const auto& [vertex, fan] : fans) {
                local[fan] = static_cast<Index>(positions.size());
                positions.push_back(soup_.positions[vertex]);
                component.source_vertex.push_back(vertex);
            }
            std::vector<std::array<Index, 3>> triangles;
            triangles.reserve(faces[c].size());
            component.source_face.reserve(faces[c].size());
            for (const Index f : faces[c]) {
                std::array<Index, 3> t{local[topology.fan(3 * f)], local[topology.fan(3 * f + 1)],
                                       local[topology.fan(3 * f + 2)]};
                if (turn_[f])
                    std::swap(t[1], t[2]);
                triangles.push_back(t);
                component.source_face.push_back(source_[f]);
            }
            Result<ManifoldMesh> mesh =
                ManifoldMesh::build(std::move(positions), std::move(triangles));
            if (!mesh) {
                // Only edges split into copies with the same ends can get here.
                const Index at = mesh.error().element;
                const bool known = at < component.source_face.size();
                return Error{mesh.error().code,
                             "the surface stays non-manifold at face " +
                                 std::to_string(known ? component.source_face[at] : 0) +
                                 " after splitting: " + mesh.error().message,
                             known ? component.source_face[at] : invalid_index};
            }
            component.mesh = std::move(mesh.value());
            component.boundary_loops = loops[c];
            // V - E + F of the surface with its holes filled is 2 - 2 genus.
            component.genus = (2 - static_cast<int>(loops[c]) -
                               (static_cast<int>(component.mesh.vertex_count()) -
                                static_cast<int>(component.mesh.edge_count()) +
                                static_cast<int>(component.mesh.face_count()))) /
                              2;
            if (component.mesh.closed())
                component.volume = component.mesh.volume();
        }
        return std::nullopt;
    }

    TriangleSoup soup_;
    const RepairOptions& options_;
    Context& context_;
    RepairedMesh out_;
    double weld_ = 0.0; //!< Open corners so near each other become one.
    //! What is thinner is flat but for rounding. Not more than that, however far corners are
    //! welded: faces of that size are the shape.
    double thin_ = 0.0;
    std::vector<std::array<Index, 3>> triangles_;
    std::vector<Index> source_; //!< Per triangle: its number in the soup.
    std::vector<char> turn_;
    Index repeated_ = 0, duplicates_ = 0;
};

} // namespace

std::optional<Error> RepairOptions::check() const
{
    if (!(weld >= 0.0 && weld <= largest_weld))
        return Error{ErrorCode::bad_option,
                     "weld must be a fraction of the diagonal between 0 and 0.1", invalid_index};
    return std::nullopt;
}

Result<RepairedMesh> repair_mesh(TriangleSoup soup, const RepairOptions& options, Context& context)
{
    if (const std::optional<Error> bad = options.check())
        return *bad;
    return Repairer(std::move(soup), options, context).repair();
}

} // namespace bot2nurbs
