// SPDX-License-Identifier: MIT
#include "bot2nurbs/layout.h"

#include "domain/domain_paths.h"
#include "layout/base_complex.h"
#include "layout/improve.h"
#include "layout/pair_triangles.h"
#include "layout/refine_carrier.h"
#include "layout/size_field.h"
#include "layout/split_in_quads.h"

#include <algorithm>
#include <cmath>

namespace bot2nurbs {

namespace {

// The default number of patches is the shape's bending, k1^2 + k2^2 integrated, between bounds: 25
// on any sphere, 108 on a torus with radii 1 and 0.4. The upper bound keeps fits fast and B-Reps
// easy to handle; a tolerance or --patches asks for more.
constexpr double min_default_patches = 24.0;
constexpr double max_default_patches = 150.0;
constexpr double max_default_patches_genus_3 = 300.0;
constexpr double patches_per_handle = 16.0;
// Curvature is measured at this fraction of the box diagonal.
constexpr double curvature_scale = 0.015;
// Collapsing quads makes the layout regular; this many more are made than wanted, to collapse.
constexpr double surplus = 1.2;
// Carrier edges are at most this part of the width of a patch, so that a patch has enough faces for
// a smooth map: about forty.
constexpr double carrier_resolution = 0.3;
// Rounds of Lloyd's relaxation; more move sites by less than a mesh edge.
constexpr int relaxation_rounds = 8;
// Refining a carrier adds at most this many vertices per face, plus the constant: a sliver whose
// area is nothing beside its length would ask for any number.
constexpr std::size_t max_refinement_factor = 4;
constexpr std::size_t max_refinement_floor = 20000;

double surface_area(const ManifoldMesh& mesh)
{
    double area = 0.0;
    for (Index f = 0; f < mesh.face_count(); ++f)
        area += 0.5 * norm(mesh.area_vector(f));
    return area;
}

// Area in the metric scaled by a density per vertex.
double scaled_area(const ManifoldMesh& mesh, const std::vector<double>& density)
{
    double area = 0.0;
    for (Index f = 0; f < mesh.face_count(); ++f) {
        const auto& t = mesh.triangle(f);
        const double d = (density[t[0]] + density[t[1]] + density[t[2]]) / 3.0;
        area += 0.5 * norm(mesh.area_vector(f)) * d * d;
    }
    return area;
}

Index default_patches(double bending, int genus)
{
    double limit = genus >= 3 ? max_default_patches_genus_3 : max_default_patches;
    limit = std::max(limit, patches_per_handle * genus);
    const double least = std::max(min_default_patches, 0.5 * patches_per_handle * genus);
    return static_cast<Index>(std::lround(std::clamp(bending, least, limit)));
}

// Voronoi sites: enough for the patches wanted, evenly spread, then whatever the conditions ask.
void place_sites(Tiles& tiles, Index count, LayoutSummary& summary, const Context& context)
{
    // The first site is the vertex farthest from the middle: it does not depend on numbering.
    const ManifoldMesh& mesh = tiles.mesh();
    const Vec3 center = mesh.box().center();
    Index first = 0;
    for (Index v = 1; v < mesh.vertex_count(); ++v)
        if (norm_squared(mesh.position(v) - center) > norm_squared(mesh.position(first) - center))
            first = v;
    tiles.grow({first});
    tiles.add_farthest(std::min(count, mesh.vertex_count()));
    for (int round = 0; round < relaxation_rounds && !context.cancelled(); ++round)
        tiles.relax();
    const std::size_t before = tiles.sites().size();
    while (!context.cancelled()) {
        const std::vector<Index> missing = tiles.violations();
        if (missing.empty())
            break;
        tiles.add(missing);
    }
    summary.sites = static_cast<Index>(tiles.sites().size());
    summary.sites_added = static_cast<Index>(tiles.sites().size() - before);
}

Result<QuadDomain> make_domain(const PatchComplex& complex, CarrierMesh carrier)
{
    QuadDomain domain;
    std::vector<Index> number(carrier.mesh.vertex_count(), invalid_index);
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
    Result<QuadComplex> built =
        QuadComplex::build(static_cast<Index>(domain.vertices.size()), std::move(quads));
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
                path.nodes.push_back(walk.node(carrier.mesh, i));
            domain.edges[e].a = number[path.a];
            domain.edges[e].b = number[path.b];
            domain.edges[e].path = path_points(carrier.mesh, path);
        }
    domain.carrier = std::move(carrier);
    domain.origin = "eck";
    return domain;
}

} // namespace

Result<LayoutResult> build_layout(const ManifoldMesh& source, const LayoutOptions& options,
                                  Context& context)
{
    if (!source.closed())
        return Error{ErrorCode::open_mesh, "the automatic layout needs a closed mesh",
                     invalid_index};
    if (options.patches && *options.patches == 0)
        return Error{ErrorCode::bad_option, "the number of patches must be positive",
                     invalid_index};
    LayoutResult result;
    LayoutSummary& summary = result.summary;
    const int genus = source.genus();
    SizeField field = measure_size_field(source, curvature_scale * source.box().diagonal());
    summary.target_patches =
        options.patches ? *options.patches : default_patches(field.bending, genus);

    const double width =
        std::sqrt(surface_area(source) / static_cast<double>(summary.target_patches));
    std::vector<double> limit(source.vertex_count());
    for (Index v = 0; v < source.vertex_count(); ++v)
        limit[v] = carrier_resolution * width / field.density[v];
    CarrierMesh carrier = refine_carrier(
        source, limit, max_refinement_floor + max_refinement_factor * source.face_count());
    if (carrier.refined) {
        summary.notes.push_back("edges split where the mesh is coarse for its patches: " +
                                std::to_string(source.face_count()) + " faces became " +
                                std::to_string(carrier.mesh.face_count()));
        field = measure_size_field(carrier.mesh, curvature_scale * source.box().diagonal());
    }
    if (context.cancelled())
        return Context::cancelled_error("layout");

    // V - E + F of quads on a surface of genus g: patches = vertices - (2 - 2 g).
    const double vertices =
        surplus * static_cast<double>(summary.target_patches) + 2.0 - 2.0 * genus;
    Tiles tiles(carrier.mesh, field.density);
    place_sites(tiles, static_cast<Index>(std::max(vertices, 4.0)), summary, context);
    if (context.cancelled())
        return Context::cancelled_error("layout");

    Result<PatchComplex> complex = build_base_complex(tiles, context);
    if (!complex)
        return complex.error();
    straighten_triangles(*complex, context);
    const auto metric = [&](const CarrierMesh& on) {
        return SizeMetric{field.density, scaled_area(on.mesh, field.density) /
                                             static_cast<double>(summary.target_patches)};
    };
    improve_triangles(*complex, metric(carrier), context);
    const auto finish = [&](PatchComplex& quads, CarrierMesh& on) -> Result<LayoutResult> {
        // Vertices that came with a split have no density of their own yet.
        if (on.mesh.vertex_count() != field.density.size())
            field = measure_size_field(on.mesh, curvature_scale * source.box().diagonal());
        improve_quads(quads, summary.target_patches, metric(on), context);
        if (context.cancelled())
            return Context::cancelled_error("layout");
        Result<QuadDomain> domain = make_domain(quads, std::move(on));
        if (!domain)
            return domain.error();
        result.domain = std::move(*domain);
        return std::move(result);
    };
    if (!options.split_triangles) {
        const Result<bool> paired = pair_triangles(*complex, context);
        if (!paired)
            return paired.error();
        if (*paired)
            return finish(*complex, carrier);
    }
    summary.subdivided = true;
    summary.notes.push_back("triangles split in three quads each");
    Result<SplitComplex> split = split_in_quads(*complex, source, carrier, context);
    if (!split)
        return split.error();
    return finish(split->complex, *split->carrier);
}

} // namespace bot2nurbs
