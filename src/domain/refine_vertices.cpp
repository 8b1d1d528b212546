// SPDX-License-Identifier: MIT
#include "domain/refine_vertices.h"

#include "core/parallel.h"
#include "domain/carrier_editor.h"
#include "domain/domain_paths.h"
#include "domain/quad_marks.h"
#include "maps/retile.h"

#include <oneapi/tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace bot2nurbs {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Carrier edges are at most this part of the width of a new quad, so that it has some forty faces.
// The width is the root of the product of its sides; in a long thin quad edges are shorter, for a
// few across, but not so that it would take more than some hundred and fifty.
constexpr double resolution = 0.3;
constexpr double resolution_across = 0.6;
constexpr double least_resolution = 0.15;
// Halvings that new quads may ask for, each: resolution alone would ask for any number where a
// source has needles.
constexpr std::size_t halvings_per_quad = 150;
// A path is cut within this share of its length of its middle, and a quad within this distance of
// its centre, in the unit square.
constexpr double middle_slack = 0.1;
constexpr double center_slack = 0.15;
// Choosing where to cut a path, a crossing near an end of its carrier edge counts as this much
// farther from the middle: splitting the edge there leaves slivers.
constexpr double sliver_price = 0.3;
constexpr double sliver_end = 0.25;
// Halvings of the carrier around a place until a vertex is near. Each halves a face; this many take
// a face as large as the quad to a billionth of its area.
constexpr int most_halvings = 30;

struct Refiner {
    const ManifoldMesh& source;
    const QuadDomain& domain;
    const std::vector<char>& marks;
    const RefinedComplex& topology;
    Context& context;
    CarrierEditor editor;
    RefinedVertices result;

    const QuadComplex& complex() const { return domain.complex; }

    static Error cannot_cut(Index quad, const char* why)
    {
        return {ErrorCode::layout_failed, "quad " + std::to_string(quad) + " cannot be cut: " + why,
                quad};
    }
    static Error cancelled() { return Context::cancelled_error("refinement"); }

    //! Runs use(i, overlay builder) for the positions in `quads`. \return false when cancelled.
    template <class Use> bool for_quads(const std::vector<Index>& quads, const Use& use) const
    {
        oneapi::tbb::enumerable_thread_specific<OverlayBuilder> builders(
            [this] { return OverlayBuilder(result.carrier.mesh); });
        return for_each_chunk(context, quads.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                use(i, builders.local());
        });
    }

    void take_carrier()
    {
        result.carrier = editor.carrier();
        result.paths = editor.paths(result.carrier.mesh);
    }

    //! The longest carrier edge that the new quads of a quad should have.
    double edge_limit(Index q) const
    {
        std::array<double, 4> side{};
        for (Index s = 0; s < 4; ++s) {
            const Index e = complex().edge(4 * q + s);
            side[s] = length(result.carrier.mesh, result.paths[e]) * (marks[e] ? 0.5 : 1.0);
        }
        const double u = 0.5 * (side[0] + side[2]), v = 0.5 * (side[1] + side[3]);
        const double width = std::sqrt(u * v);
        return width > 0.0 ? std::clamp(resolution_across * std::min(u, v),
                                        least_resolution * width, resolution * width)
                           : infinity;
    }

    //! Halves the carrier's edges where they are long beside the new quads: in each round the
    //! longest side of every face that is on a quad with a shorter limit.
    Status refine_carrier()
    {
        std::vector<Index> open;
        std::vector<double> limit(complex().quad_count());
        for (Index q = 0; q < complex().quad_count(); ++q)
            if (marked_sides(complex(), marks, q) > 0) {
                open.push_back(q);
                limit[q] = edge_limit(q);
            }
        std::size_t left = halvings_per_quad * topology.complex.quad_count();
        while (!open.empty() && left > 0) {
            struct Long {
                double ratio;
                Index halfedge, from, to;
            };
            std::vector<std::vector<Long>> found(open.size());
            std::vector<char> is_disk(open.size(), 0);
            if (!for_quads(open, [&](std::size_t i, OverlayBuilder& builder) {
                    const auto overlay = builder.disk(quad_border(domain, result.paths, open[i]));
                    is_disk[i] = overlay.has_value();
                    if (!overlay)
                        return;
                    for (const Index f : overlay->face) {
                        const Index h = editor.longest_side(f);
                        const double ratio = editor.length(h) / limit[open[i]];
                        if (ratio > 1.0)
                            found[i].push_back({ratio, h, editor.from(h), editor.to(h)});
                    }
                }))
                return cancelled();
            std::vector<Index> still;
            std::vector<Long> all;
            for (std::size_t i = 0; i < open.size(); ++i) {
                if (!is_disk[i])
                    return cannot_cut(open[i], "its region is no disk");
                if (!found[i].empty())
                    still.push_back(open[i]);
                all.insert(all.end(), found[i].begin(), found[i].end());
            }
            open = std::move(still);
            std::sort(all.begin(), all.end(), [](const Long& a, const Long& b) {
                return a.ratio != b.ratio ? a.ratio > b.ratio : a.halfedge < b.halfedge;
            });
            for (const Long& edge : all) {
                if (left == 0)
                    break;
                // Another face may have asked for it already.
                const Index h = edge.halfedge;
                if (editor.from(h) != edge.from || editor.to(h) != edge.to)
                    continue;
                editor.halve(h);
                --left;
            }
            if (!all.empty())
                take_carrier();
        }
        return {};
    }

    //! The node at which to cut a path, if one is near its middle; else the step to refine around.
    struct Cut {
        Index node = invalid_index, step = invalid_index;
    };
    Cut choose_cut(Index path) const
    {
        std::vector<Index> nodes;
        std::vector<double> arc;
        for (Index n = editor.first_node(path); n != invalid_index; n = editor.node(n).next) {
            const Vec3 p = editor.position(n);
            arc.push_back(nodes.empty() ? 0.0
                                        : arc.back() + norm(p - editor.position(nodes.back())));
            nodes.push_back(n);
        }
        Cut cut;
        double best = infinity;
        for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
            const double even = static_cast<double>(i) / static_cast<double>(nodes.size() - 1);
            const double share = arc.back() > 0.0 ? arc[i] / arc.back() : even;
            if (share <= 0.5)
                cut.step = nodes[i];
            const double off = std::fabs(share - 0.5);
            if (i == 0 || off > middle_slack)
                continue;
            const CarrierEditor::Node& node = editor.node(nodes[i]);
            const double end = node.is_vertex() ? sliver_end : std::min(node.t, 1.0 - node.t);
            const double price = off + sliver_price * std::max(0.0, sliver_end - end);
            if (price < best) {
                best = price;
                cut.node = nodes[i];
            }
        }
        return cut;
    }

    Status cut_paths()
    {
        for (Index e = 0; e < complex().edge_count(); ++e) {
            if (!marks[e])
                continue;
            if (context.cancelled())
                return cancelled();
            Cut cut = choose_cut(e);
            for (int i = 0; i < most_halvings && cut.node == invalid_index; ++i) {
                editor.halve(editor.halfedge_to_halve(cut.step));
                cut = choose_cut(e);
            }
            if (cut.node == invalid_index)
                return cannot_cut(QuadComplex::quad_of(complex().halfedge_of_edge(e)),
                                  "a side has no carrier vertex near its middle");
            result.vertex[topology.middle[e]] = editor.make_vertex(cut.node);
        }
        take_carrier();
        return {};
    }

    Status place_centers()
    {
        std::vector<Index> open;
        for (Index q = 0; q < complex().quad_count(); ++q)
            if (topology.center[q] != invalid_index)
                open.push_back(q);
        for (int round = 0; round < most_halvings && !open.empty(); ++round) {
            std::vector<Index> vertex(open.size(), invalid_index), face = vertex;
            std::vector<char> mapped(open.size(), 0);
            if (!for_quads(open, [&](std::size_t i, OverlayBuilder& builder) {
                    const auto disk = map_disk(builder, quad_border(domain, result.paths, open[i]));
                    mapped[i] = disk.has_value();
                    if (disk) {
                        vertex[i] = central_vertex(*disk);
                        face[i] = central_face(*disk);
                    }
                }))
                return cancelled();
            std::vector<Index> still, halved;
            for (std::size_t i = 0; i < open.size(); ++i) {
                if (!mapped[i])
                    return cannot_cut(open[i], "its region cannot be mapped");
                result.vertex[topology.center[open[i]]] = vertex[i];
                if (vertex[i] == invalid_index) {
                    still.push_back(open[i]);
                    halved.push_back(face[i]);
                }
            }
            open = std::move(still);
            // Quads that are small beside the carrier share a face: it is halved once a round.
            std::sort(halved.begin(), halved.end());
            halved.erase(std::unique(halved.begin(), halved.end()), halved.end());
            for (const Index f : halved)
                editor.halve(editor.longest_side(f));
            if (!halved.empty())
                take_carrier();
        }
        return open.empty() ? Status{}
                            : cannot_cut(open[0], "it has no carrier vertex near its centre");
    }

    static Index central_vertex(const MappedDisk& disk)
    {
        Index best = invalid_index;
        double nearest = center_slack;
        for (Index v = disk.overlay.boundary_count; v < disk.overlay.vertices.size(); ++v) {
            const Vec2 off = disk.uv[v] - Vec2{0.5, 0.5};
            const double distance = std::max(std::fabs(off.x), std::fabs(off.y));
            if (disk.overlay.vertices[v].mesh_vertex != invalid_index && distance < nearest) {
                nearest = distance;
                best = disk.overlay.vertices[v].mesh_vertex;
            }
        }
        return best;
    }

    //! The carrier face that the centre lies deepest in.
    static Index central_face(const MappedDisk& disk)
    {
        const Vec2 center{0.5, 0.5};
        Index best = 0;
        double deepest = -infinity;
        for (Index t = 0; t < disk.overlay.triangles.size(); ++t) {
            const auto& corner = disk.overlay.triangles[t];
            double depth = infinity;
            for (int k = 0; k < 3; ++k) {
                const Vec2 &a = disk.uv[corner[k]], &b = disk.uv[corner[(k + 1) % 3]];
                depth = std::min(depth, cross(b - a, center - a) / norm(b - a));
            }
            if (depth > deepest) {
                deepest = depth;
                best = disk.overlay.face[t];
            }
        }
        return best;
    }
};

} // namespace

std::vector<PathSide> quad_border(const QuadDomain& domain, const std::vector<SurfacePath>& paths,
                                  Index quad)
{
    std::vector<PathSide> sides;
    for (Index h = 4 * quad; h < 4 * quad + 4; ++h) {
        const Index e = domain.complex.edge(h);
        sides.push_back({&paths[e], domain.complex.from(h) != domain.edges[e].a});
    }
    return sides;
}

Result<RefinedVertices> place_vertices(const ManifoldMesh& source, const QuadDomain& domain,
                                       const std::vector<char>& marks,
                                       const RefinedComplex& topology, Context& context)
{
    RefinedVertices start;
    start.carrier = domain.carrier;
    for (Index e = 0; e < domain.edges.size(); ++e) {
        Result<SurfacePath> path = domain_path(domain, e);
        if (!path)
            return path.error();
        start.paths.push_back(std::move(*path));
    }
    start.vertex = domain.vertices;
    start.vertex.resize(topology.complex.vertex_count(), invalid_index);
    CarrierEditor editor(source, domain.carrier, start.paths);
    Refiner refiner{source, domain, marks, topology, context, std::move(editor), std::move(start)};
    if (Status failed = refiner.refine_carrier())
        return *failed;
    if (Status failed = refiner.cut_paths())
        return *failed;
    if (Status failed = refiner.place_centers())
        return *failed;
    return std::move(refiner.result);
}

} // namespace bot2nurbs
