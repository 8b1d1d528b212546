// SPDX-License-Identifier: MIT
#include "bot2nurbs/layout.h"

#include "domain/domain_paths.h"
#include "layout/base_complex.h"
#include "layout/ground.h"
#include "layout/improve.h"
#include "layout/pair_triangles.h"
#include "layout/place_sites.h"
#include "layout/proxy.h"
#include "layout/size_field.h"
#include "layout/split_in_quads.h"
#include "layout/uncut.h"

#include <algorithm>
#include <cmath>

namespace bot2nurbs {

namespace {

// Collapsing quads makes the layout regular; this many more are made than wanted, to collapse.
constexpr double surplus = 1.2;
// Edges of a coarse mesh that stands for the carrier are this part of a patch's width; it is made
// where it has so many times fewer faces.
constexpr double proxy_resolution = 0.2;
constexpr double proxy_saving = 2.5;
// Rounds of Lloyd's relaxation; more move sites by less than a mesh edge.
constexpr int relaxation_rounds = 8;
// How many sites to place inside so that about `patches` quads come out.
Index inner_sites(const LayoutLevel& level, double width, double patches)
{
    // On a surface with f quads and b boundary edges, v = f + b / 2 + Euler characteristic; over
    // all regions of the level. Pieces of curves are about as long as patches are wide.
    double border = 0.0;
    for (const Curve& c : level.curves()) {
        const std::vector<Vec3> p = level.points(c);
        double length = 0.0;
        for (std::size_t i = 1; i < p.size(); ++i)
            length += norm(p[i] - p[i - 1]);
        border += std::max(1.0, length / width);
    }
    return static_cast<Index>(std::max(0.0, patches + euler_characteristic(level.mesh()) - border));
}

SizeMetric metric_of(const LayoutLevel& level, double width)
{
    return {level.density(), width * width};
}

// K_tri on a level.
Result<PatchComplex> make_triangles(const LayoutLevel& level, double width, Index target,
                                    LayoutSummary& summary, Context& context)
{
    SitePlan plan;
    plan.width = width / std::sqrt(surplus);
    plan.inner = inner_sites(level, plan.width, surplus * static_cast<double>(target));
    plan.relaxations = relaxation_rounds;
    plan.even_regions = true;
    Tiles tiles(level.mesh(), level.density());
    summary.sites_added = place_sites(level, plan, tiles, context);
    summary.sites = static_cast<Index>(tiles.sites().size());
    if (context.cancelled())
        return Context::cancelled_error("layout");
    Result<PatchComplex> complex = build_base_complex(tiles, context);
    if (!complex)
        return complex;
    straighten_triangles(*complex, context);
    improve_triangles(*complex, metric_of(level, width), context);
    if (context.cancelled())
        return Context::cancelled_error("layout");
    return complex;
}

Result<QuadDomain> make_domain(const PatchComplex& complex, CarrierMesh carrier,
                               const std::vector<char>& is_corner)
{
    QuadDomain domain;
    const ManifoldMesh& mesh = carrier.mesh;
    std::vector<Index> number(mesh.vertex_count(), invalid_index);
    std::vector<std::array<Index, 4>> quads;
    for (Index f = 0; f < complex.faces().size(); ++f) {
        const std::vector<Index> corners = complex.corners(f);
        std::array<Index, 4> quad{};
        for (std::size_t k = 0; k < 4; ++k) {
            if (number[corners[k]] == invalid_index) {
                number[corners[k]] = static_cast<Index>(domain.vertices.size());
                domain.vertices.push_back(corners[k]);
            }
            quad[k] = number[corners[k]];
        }
        quads.push_back(quad);
    }
    std::vector<std::pair<Index, Index>> creases;
    for (Index p = 0; p < complex.paths().size(); ++p)
        if (complex.paths()[p].mark == mark_of(FeatureKind::crease) && !complex.is_boundary(p))
            creases.emplace_back(number[complex.paths()[p].geometry.a],
                                 number[complex.paths()[p].geometry.b]);
    std::vector<Index> corners;
    for (Index v = 0; v < domain.vertices.size(); ++v)
        if (domain.vertices[v] < is_corner.size() && is_corner[domain.vertices[v]])
            corners.push_back(v);
    Result<QuadComplex> built = QuadComplex::build(static_cast<Index>(domain.vertices.size()),
                                                   std::move(quads), creases, std::move(corners));
    if (!built)
        return built.error();
    domain.complex = std::move(*built);
    domain.edges.resize(domain.complex.edge_count());
    for (Index f = 0; f < complex.faces().size(); ++f)
        for (Index s = 0; s < 4; ++s) {
            const Index h = 4 * f + s, e = domain.complex.edge(h);
            if (domain.complex.halfedge_of_edge(e) != h)
                continue;
            const PatchComplex::Side& side = complex.faces()[f].sides[s];
            const PathSide walk{&complex.paths()[side.path].geometry, side.reversed};
            SurfacePath path;
            path.a = walk.start();
            path.b = walk.end();
            for (std::size_t i = 0; i < walk.node_count(); ++i)
                path.nodes.push_back(walk.node(mesh, i));
            domain.edges[e].a = number[path.a];
            domain.edges[e].b = number[path.b];
            domain.edges[e].path = path_points(mesh, path);
            domain.edges[e].crease = domain.complex.is_crease(e);
        }
    domain.carrier = std::move(carrier);
    domain.origin = "eck";
    return domain;
}

} // namespace

Result<LayoutResult> build_layout(const ManifoldMesh& source, const LayoutOptions& options,
                                  Context& context)
{
    if (options.patches && *options.patches == 0)
        return Error{ErrorCode::bad_option, "the number of patches must be positive",
                     invalid_index};
    LayoutResult result;
    LayoutSummary& summary = result.summary;
    Ground ground = prepare_ground(source, options, summary);
    if (context.cancelled())
        return Context::cancelled_error("layout");

    // A fine mesh is stood for by a coarse one.
    std::optional<Proxy> proxy;
    const double cells = static_cast<double>(summary.target_patches) * 4.0 /
                         (1.732 * proxy_resolution * proxy_resolution);
    if (static_cast<double>(ground.carrier.mesh.face_count()) > proxy_saving * cells) {
        Result<Proxy> built = Proxy::build(*ground.level, proxy_resolution * ground.width, context);
        if (!built && built.error().code == ErrorCode::cancelled)
            return built.error();
        if (built)
            proxy = std::move(*built);
        else
            summary.notes.push_back("laid out on the whole mesh: " + built.error().message);
    }
    const LayoutLevel& level = proxy ? proxy->level() : *ground.level;
    Result<PatchComplex> complex =
        make_triangles(level, ground.width, summary.target_patches, summary, context);
    if (!complex)
        return complex.error();
    const auto on_carrier = [&](const PatchComplex& made) -> Result<PatchComplex> {
        if (!proxy)
            return uncut(made, *ground.cut, ground.carrier.mesh, ground.marks);
        Result<PatchComplex> lifted = proxy->lift(made, context);
        if (!lifted)
            return lifted;
        return uncut(*lifted, *ground.cut, ground.carrier.mesh, ground.marks);
    };
    if (!options.split_triangles) {
        PatchComplex quads = *complex;
        const Result<bool> paired = pair_triangles(quads, context);
        if (!paired)
            return paired.error();
        if (*paired) {
            improve_quads(quads, summary.target_patches, metric_of(level, ground.width), context);
            if (context.cancelled())
                return Context::cancelled_error("layout");
            const Result<PatchComplex> lifted = on_carrier(quads);
            if (!lifted)
                return lifted.error();
            Result<QuadDomain> domain =
                make_domain(*lifted, std::move(ground.carrier), ground.corner);
            if (!domain)
                return domain.error();
            result.domain = std::move(*domain);
            return result;
        }
    }
    summary.subdivided = true;
    summary.notes.push_back("triangles split in three quads each");
    Result<PatchComplex> triangles = on_carrier(*complex);
    if (!triangles)
        return triangles.error();
    Result<SplitComplex> split = split_in_quads(*triangles, source, ground.carrier, context);
    if (!split)
        return split.error();
    const std::vector<double> density(split->carrier->mesh.vertex_count(), 1.0);
    improve_quads(split->complex, summary.target_patches,
                  {density, scaled_area(split->carrier->mesh, density) /
                                static_cast<double>(summary.target_patches)},
                  context);
    if (context.cancelled())
        return Context::cancelled_error("layout");
    Result<QuadDomain> domain =
        make_domain(split->complex, std::move(*split->carrier), ground.corner);
    if (!domain)
        return domain.error();
    result.domain = std::move(*domain);
    return result;
}

} // namespace bot2nurbs
