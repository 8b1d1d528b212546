// SPDX-License-Identifier: MIT
#include "bot2nurbs/check_mesh.h"

#include "bot2nurbs/tolerance.h"
#include "core/parallel.h"
#include "mesh/degenerate_faces.h"
#include "mesh/features.h"
#include "mesh/self_intersection.h"
#include "mesh/soup_topology.h"
#include "mesh/weld.h"

#include <algorithm>

namespace bot2nurbs {

namespace {

//! Counts one kind of defect and remembers its first element.
struct Tally {
    Index count = 0, first = invalid_index;
    void add(Index element)
    {
        ++count;
        first = std::min(first, element);
    }
};

class Checker {
public:
    Checker(const TriangleSoup& soup, const CheckOptions& options, Context& context)
        : soup_(soup), options_(options), context_(context)
    {
    }

    MeshReport check()
    {
        report_.vertices = static_cast<Index>(soup_.positions.size());
        report_.faces = static_cast<Index>(soup_.triangles.size());
        for (const Vec3& p : soup_.positions)
            if (is_finite(p))
                box_.add(p);
        if (soup_.triangles.empty())
            report("empty", "the mesh has no faces", {1, 0});
        check_faces();
        SelfIntersections crossings;
        run_both(
            context_,
            [&] {
                check_vertices();
                if (!triangles_.empty())
                    check_topology();
            },
            [&] {
                // Vertices at equal positions are equal for the test, whatever their numbers.
                if (options_.self_intersections && !triangles_.empty())
                    crossings = find_self_intersections(soup_.positions, triangles_,
                                                        options_.kept_pairs, context_);
            });
        report_crossings(crossings);
        return std::move(report_);
    }

private:
    void report(const std::string& code, const std::string& message, const Tally& tally)
    {
        if (tally.count > 0)
            report_.defects.push_back({code, message, tally.first, tally.count});
    }
    static std::string number(Index n) { return std::to_string(n); }
    //! "3 faces have no area (first: face 17)"
    static std::string several(const Tally& tally, const std::string& one, const std::string& many,
                               const std::string& element)
    {
        return (tally.count == 1 ? "1 " + one : number(tally.count) + " " + many) +
               " (first: " + element + " " + number(tally.first) + ")";
    }

    void check_faces()
    {
        Tally invalid, repeated, not_finite, flat, copies;
        const double distance = tolerance::weld * box_.diagonal();
        for (Index f = 0; f < report_.faces; ++f) {
            const auto& t = soup_.triangles[f];
            if (t[0] >= report_.vertices || t[1] >= report_.vertices || t[2] >= report_.vertices) {
                invalid.add(f);
                continue;
            }
            const Vec3 &a = soup_.positions[t[0]], &b = soup_.positions[t[1]],
                       &c = soup_.positions[t[2]];
            if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) {
                repeated.add(f);
                continue;
            }
            if (!is_finite(a) || !is_finite(b) || !is_finite(c)) {
                not_finite.add(f);
                continue;
            }
            if (has_no_area(a, b, c, distance))
                flat.add(f);
            triangles_.push_back(t);
            face_.push_back(f);
        }
        for (const Index f : duplicate_faces(triangles_))
            copies.add(face_[f]);
        report("invalid_index",
               several(invalid, "face names a vertex that is not there",
                       "faces name vertices that are not there", "face"),
               invalid);
        report("repeated_vertex",
               several(repeated, "face uses a vertex twice", "faces use a vertex twice", "face"),
               repeated);
        report("non_finite",
               several(not_finite, "face has a coordinate that is not finite",
                       "faces have coordinates that are not finite", "face"),
               not_finite);
        report("zero_area", several(flat, "face has no area", "faces have no area", "face"), flat);
        report("duplicate_face",
               several(copies, "face repeats the vertices of another",
                       "faces repeat the vertices of others", "face"),
               copies);
    }

    void check_vertices()
    {
        std::vector<char> used(report_.vertices, 0), finite(report_.vertices, 0);
        for (const auto& t : soup_.triangles)
            for (const Index v : t)
                if (v < report_.vertices)
                    used[v] = 1;
        Tally unused, weldable;
        for (Index v = 0; v < report_.vertices; ++v) {
            finite[v] = is_finite(soup_.positions[v]);
            if (!used[v])
                unused.add(v);
        }
        const std::vector<Index> group =
            weld_points(soup_.positions, finite, tolerance::weld * box_.diagonal());
        for (Index v = 0; v < report_.vertices; ++v)
            if (group[v] != v)
                weldable.add(v);
        report("unreferenced_vertex",
               several(unused, "vertex is not used", "vertices are not used", "vertex"), unused);
        report("weldable_vertex",
               several(weldable, "vertex lies on another", "vertices lie on others", "vertex"),
               weldable);
    }

    void check_topology()
    {
        const SoupTopology topology(report_.vertices, triangles_);
        Tally thick_edges, single_edges, pinched, disagree, twisted, inward;
        Index thick_a = 0, thick_b = 0;
        for (Index e = 0; e < topology.edge_count(); ++e) {
            const Index h = *topology.halfedges(e).first;
            if (topology.face_count(e) == 1)
                single_edges.add(face_[h / 3]);
            if (topology.face_count(e) > 2) {
                if (face_[h / 3] < thick_edges.first) {
                    thick_a = topology.from(h);
                    thick_b = topology.from(SoupTopology::next(h));
                }
                thick_edges.add(face_[h / 3]);
            }
            const Index g = topology.mate(h);
            if (g == invalid_index)
                continue;
            const double sign = topology.mates_disagree(h) ? -1.0 : 1.0;
            if (sign < 0.0)
                disagree.add(face_[std::max(h, g) / 3]);
            if (normal_angle_deg(area_vector(h / 3), sign * area_vector(g / 3)) >
                options_.sharp_angle_deg)
                ++report_.sharp_edges;
        }
        const std::vector<Index> fans = topology.fans_per_vertex(report_.vertices);
        for (Index v = 0; v < report_.vertices; ++v)
            if (fans[v] > 1)
                pinched.add(v);
        report_.closed = single_edges.count == 0;
        report_.manifold = thick_edges.count == 0 && pinched.count == 0;

        make_components(topology);
        report_.orientable = report_.oriented = true;
        for (const ComponentReport& c : report_.components) {
            report_.orientable = report_.orientable && c.orientable;
            report_.oriented = report_.oriented && c.oriented;
            if (!c.orientable)
                twisted.add(c.first_face);
            if (c.inward)
                inward.add(c.first_face);
        }
        report("nonmanifold_edge",
               several(thick_edges, "edge has more than two faces",
                       "edges have more than two faces", "at face") +
                   ", from vertex " + number(thick_a) + " to " + number(thick_b),
               thick_edges);
        report("nonmanifold_vertex",
               several(pinched, "vertex joins several fans of faces",
                       "vertices join several fans of faces", "vertex"),
               pinched);
        report("inconsistent_orientation",
               several(disagree, "edge has faces that turn against each other",
                       "edges have faces that turn against each other", "at face"),
               disagree);
        report("non_orientable",
               several(twisted, "component cannot be oriented (as a Moebius band)",
                       "components cannot be oriented (as a Moebius band)", "at face"),
               twisted);
        Tally holes{static_cast<Index>(report_.boundary_loops.size()), single_edges.first};
        report("open_boundary",
               number(single_edges.count) + (single_edges.count == 1 ? " edge" : " edges") +
                   " with a single face in " +
                   several(holes, "boundary loop", "boundary loops", "at face"),
               holes);
        report("inward_component",
               several(inward, "closed component turns inward", "closed components turn inward",
                       "at face"),
               inward);
    }

    Vec3 area_vector(Index f) const
    {
        const auto& t = triangles_[f];
        return cross(soup_.positions[t[1]] - soup_.positions[t[0]],
                     soup_.positions[t[2]] - soup_.positions[t[0]]);
    }

    void make_components(const SoupTopology& topology)
    {
        const Index n = topology.component_count();
        report_.components.resize(n);
        std::vector<Index> single(n, 0), disagree(n, 0), sides(n, 0);
        std::vector<double> volume(n, 0.0);
        const Vec3 origin = box_.center();
        for (Index f = 0; f < triangles_.size(); ++f) {
            ComponentReport& c = report_.components[topology.component(f)];
            c.first_face = std::min(c.first_face, face_[f]);
            ++c.faces;
            const auto& t = triangles_[f];
            volume[topology.component(f)] +=
                dot(soup_.positions[t[0]] - origin,
                    cross(soup_.positions[t[1]] - origin, soup_.positions[t[2]] - origin));
            for (Index h = 3 * f; h < 3 * f + 3; ++h) {
                const Index g = topology.mate(h);
                c.edges += g == invalid_index || h < g;
                sides[topology.component(f)] += g == invalid_index;
                disagree[topology.component(f)] += g != invalid_index && topology.mates_disagree(h);
            }
        }
        Index seen = 0; // fans are numbered in the order of their first corners
        for (Index corner = 0; corner < 3 * triangles_.size(); ++corner)
            if (topology.fan(corner) == seen) {
                ++report_.components[topology.component(corner / 3)].vertices;
                ++seen;
            }
        for (SoupTopology::Loop& loop : topology.loops()) {
            ++report_.components[loop.component].boundary_loops;
            if (loop.has_hole)
                report_.boundary_loops.push_back(std::move(loop.vertices));
        }
        for (Index i = 0; i < n; ++i) {
            ComponentReport& c = report_.components[i];
            c.closed = sides[i] == 0;
            c.orientable = topology.twist()[i] == invalid_index;
            c.oriented = disagree[i] == 0;
            const int missing =
                2 - (static_cast<int>(c.vertices) - static_cast<int>(c.edges) +
                     static_cast<int>(c.faces) + static_cast<int>(c.boundary_loops));
            c.genus = c.orientable ? missing / 2 : missing;
            if (c.closed && c.oriented)
                c.volume = volume[i] / 6.0;
            c.inward = c.volume < 0.0;
        }
    }

    void report_crossings(const SelfIntersections& found)
    {
        report_.self_intersecting_pairs = found.count;
        report_.complete = found.complete;
        for (const auto& pair : found.pairs)
            report_.self_intersections.push_back({face_[pair[0]], face_[pair[1]]});
        if (found.count == 0)
            return;
        const std::string more = found.complete ? "" : " or more";
        std::string first;
        if (!found.pairs.empty())
            first = " (first: faces " + number(report_.self_intersections[0][0]) + " and " +
                    number(report_.self_intersections[0][1]) + ")";
        const Index count = static_cast<Index>(std::min<std::uint64_t>(found.count, invalid_index));
        report("self_intersection",
               std::to_string(found.count) + more + " pairs of faces cross or overlap" + first,
               {count, found.pairs.empty() ? invalid_index : report_.self_intersections[0][0]});
    }

    const TriangleSoup& soup_;
    const CheckOptions& options_;
    Context& context_;
    MeshReport report_;
    Box3 box_;
    std::vector<std::array<Index, 3>> triangles_; //!< Those that take part in the later checks.
    std::vector<Index> face_;                     //!< Their numbers in the soup.
};

} // namespace

MeshReport check_mesh(const TriangleSoup& soup, const CheckOptions& options, Context& context)
{
    return Checker(soup, options, context).check();
}

MeshReport check_mesh(const TriangleSoup& soup, Context& context)
{
    return check_mesh(soup, {}, context);
}

} // namespace bot2nurbs
