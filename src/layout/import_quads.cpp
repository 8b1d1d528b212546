// SPDX-License-Identifier: MIT
#include "bot2nurbs/import_quads.h"

#include "bot2nurbs/closest_point.h"
#include "domain/domain_paths.h"
#include "layout/curves.h"
#include "layout/draw_quads.h"
#include "layout/ground.h"
#include "layout/matched_edges.h"
#include "layout/quad_boundary.h"
#include "layout/quad_names.h"
#include "layout/quad_places.h"
#include "layout/straighten_domain.h"
#include "mesh/boundary_loops.h"

#include <algorithm>
#include <string>

namespace bot2nurbs {

namespace {

// A vertex of the quads may be this far from the source, over the mean length of its edges as they
// run on the source: the corners of a cube around a ball are 0.63 away.
constexpr double farthest = 1.0;
// The first pass straightens between paths that are not straight yet.
constexpr int straightening_passes = 2;

std::string text(Index i)
{
    return std::to_string(i);
}

// The topology of one surface, in words.
std::string topology_text(int euler, Index loops)
{
    const int genus = (2 - euler - static_cast<int>(loops)) / 2;
    return "genus " + std::to_string(genus) + " and " + text(loops) +
           (loops == 1 ? " boundary loop" : " boundary loops");
}

class Importer {
public:
    Importer(const ManifoldMesh& source, const QuadMesh& quads, const MeshFeatures& features,
             Context& context)
        : source_(source), quads_(quads), features_(features), context_(context), closest_(source),
          is_corner_(source.vertex_count(), 0)
    {
        for (const Index v : features.corners)
            is_corner_[v] = 1;
    }

    Result<QuadImport> run()
    {
        if (Status failed = build(quads_.quads))
            return *failed;
        if (Status failed = check_topology())
            return *failed;
        if (Status failed = place())
            return *failed;
        if (context_.cancelled())
            return Context::cancelled_error("layout");
        const CurveMatch match =
            match_curves(source_, followable_lines(source_, features_.creases, is_corner_),
                         is_corner_, placed());
        if (Status failed = build(quads_turned_, &match))
            return *failed;
        const Result<std::vector<SourcePoint>> places =
            quad_places(source_, closest_, placed(), normal_, match);
        if (!places)
            return named_vertex(places.error());
        if (context_.cancelled())
            return Context::cancelled_error("layout");
        QuadCarrier board = make_quad_carrier(source_, *places, size_);
        const Result<std::vector<DrawnCurve>> curves = drawn_along_lines(match, source_, board);
        if (!curves)
            return named_edge(curves.error());
        if (context_.cancelled())
            return Context::cancelled_error("layout");
        Result<std::vector<SurfacePath>> paths =
            draw_quads(board.carrier.mesh, complex_, board.vertices, *curves,
                       ways_along_source(complex_, source_, board), context_);
        if (!paths)
            return paths.error().code == ErrorCode::cancelled ? paths.error()
                                                              : named_edge(paths.error());
        return finish(std::move(board), std::move(*paths), match);
    }

private:
    PlacedQuads placed() const { return {complex_, quads_.positions, size_}; }
    Error named_vertex(Error error) const
    {
        error.message = vertex_name(quads_, error.element) + ' ' + error.message;
        error.element = quads_.source_vertex[error.element];
        return error;
    }
    Error named_edge(Error error) const
    {
        const Index h = complex_.halfedge_of_edge(error.element);
        error.message = edge_name(quads_, complex_, error.element) + ' ' + error.message;
        error.element = quads_.source_vertex[complex_.from(h)];
        return error;
    }
    static Error invalid(std::string message, Index element)
    {
        return {ErrorCode::invalid_domain, std::move(message), element};
    }

    Status build(const std::vector<std::array<Index, 4>>& quads, const CurveMatch* match = nullptr)
    {
        std::vector<std::pair<Index, Index>> creases;
        std::vector<Index> corners;
        if (match) {
            for (const CurveEdge& e : match->edges)
                if (!match->lines[e.line].boundary) {
                    const Index h = complex_.halfedge_of_edge(e.edge);
                    creases.emplace_back(complex_.from(h), complex_.to(h));
                }
            corners = vertices_on_corners(*match, is_corner_);
        }
        Result<QuadComplex> built =
            QuadComplex::build(static_cast<Index>(quads_.positions.size()), quads,
                               std::move(creases), std::move(corners));
        if (!built)
            return built.error();
        complex_ = std::move(*built);
        return {};
    }

    Status check_topology() const
    {
        const int euler = euler_characteristic(source_);
        const auto loops = static_cast<Index>(boundary_loops(source_).size());
        const Index own_loops = static_cast<Index>(boundary_loops(complex_).size());
        if (complex_.euler_characteristic() != euler || own_loops != loops)
            return invalid("the quad mesh has " +
                               topology_text(complex_.euler_characteristic(), own_loops) +
                               ", the mesh " + topology_text(euler, loops) +
                               ": a layout must have the topology of its mesh",
                           invalid_index);
        return check_valences(complex_, quads_);
    }

    // Area vectors around each vertex.
    std::vector<Vec3> normals() const
    {
        std::vector<Vec3> result(quads_.positions.size());
        for (const auto& q : quads_.quads)
            for (int k = 0; k < 4; ++k) {
                const Vec3& p = quads_.positions[q[k]];
                result[q[k]] += cross(quads_.positions[q[(k + 1) % 4]] - p,
                                      quads_.positions[q[(k + 3) % 4]] - p);
            }
        return result;
    }

    // Mean length of the edges at each vertex of the quads, with its vertices at given places.
    std::vector<double> sizes(const std::vector<Vec3>& at) const
    {
        std::vector<double> sum(at.size(), 0.0), count(at.size(), 0.0);
        for (Index e = 0; e < complex_.edge_count(); ++e) {
            const Index h = complex_.halfedge_of_edge(e);
            for (const Index v : {complex_.from(h), complex_.to(h)}) {
                sum[v] += norm(at[complex_.to(h)] - at[complex_.from(h)]);
                count[v] += 1.0;
            }
        }
        for (std::size_t v = 0; v < sum.size(); ++v)
            sum[v] /= count[v];
        return sum;
    }

    // Closest points on the source, on faces that turn the way the quads do.
    Status place()
    {
        normal_ = normals();
        double agree = 0.0;
        for (std::size_t v = 0; v < normal_.size(); ++v) {
            const ClosestPoint::Hit hit = closest_.query(quads_.positions[v]);
            agree += dot(normal_[v], normalized(source_.area_vector(hit.where.face)));
        }
        quads_turned_ = quads_.quads;
        if (agree < 0.0) {
            for (auto& q : quads_turned_)
                std::swap(q[1], q[3]);
            for (Vec3& n : normal_)
                n = -n;
            if (Status failed = build(quads_turned_))
                return failed;
        }
        std::vector<Vec3> at;
        for (std::size_t v = 0; v < normal_.size(); ++v) {
            ClosestPoint::Hit hit = closest_.query_facing(quads_.positions[v], normal_[v]);
            if (hit.where.face == invalid_index)
                hit = closest_.query(quads_.positions[v]);
            at.push_back(hit.position);
        }
        size_ = sizes(at);
        for (Index v = 0; v < at.size(); ++v) {
            const double away = norm(at[v] - quads_.positions[v]);
            if (away > farthest * size_[v])
                return invalid(vertex_name(quads_, v) + " is " + std::to_string(away / size_[v]) +
                                   " times as far from the mesh as its edges are long: a layout "
                                   "must lie near its mesh",
                               quads_.source_vertex[v]);
        }
        return {};
    }

    Result<QuadImport> finish(QuadCarrier board, const std::vector<SurfacePath>& paths,
                              const CurveMatch& match)
    {
        QuadImport result;
        QuadDomain& domain = result.domain;
        domain.edges.resize(complex_.edge_count());
        for (Index e = 0; e < complex_.edge_count(); ++e) {
            const Index h = complex_.halfedge_of_edge(e);
            domain.edges[e] = {complex_.from(h), complex_.to(h),
                               path_points(board.carrier.mesh, paths[e]), complex_.is_crease(e)};
            result.crease_edges += complex_.is_crease(e);
        }
        for (Index v = 0; v < board.vertices.size(); ++v) {
            const double moved =
                norm(board.carrier.mesh.position(board.vertices[v]) - quads_.positions[v]);
            if (result.farthest_vertex == invalid_index || moved > result.largest_move) {
                result.largest_move = moved;
                result.farthest_vertex = v;
            }
        }
        result.smoothed = edges_not_followed(match, source_, features_.creases);
        domain.source_signature = signature(source_);
        domain.vertices = std::move(board.vertices);
        domain.carrier = std::move(board.carrier);
        domain.complex = std::move(complex_);
        domain.origin = "quads";
        if (Status failed = straighten_domain(domain, straightening_passes, context_))
            return *failed;
        return result;
    }

    const ManifoldMesh& source_;
    const QuadMesh& quads_;
    const MeshFeatures& features_;
    Context& context_;
    const ClosestPoint closest_;
    std::vector<char> is_corner_; // Per vertex of the source.
    QuadComplex complex_;
    std::vector<std::array<Index, 4>> quads_turned_; // As the source turns.
    std::vector<Vec3> normal_; // Per vertex of the quads, as the source turns; of any length.
    std::vector<double> size_; // Per vertex of the quads: mean length of its edges on the source.
};

} // namespace

Result<QuadImport> import_quads(const ManifoldMesh& source, const QuadMesh& quads,
                                const MeshFeatures& features, Context& context)
{
    return Importer(source, quads, features, context).run();
}

} // namespace bot2nurbs
