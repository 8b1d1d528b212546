// SPDX-License-Identifier: MIT
#include "bot2nurbs/layout.h"

#include "layout/base_complex.h"
#include "layout/ground.h"
#include "layout/improve.h"
#include "layout/make_domain.h"
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
// Beside curves it leaves less room for good patches: there it must save more.
constexpr double proxy_saving_at_curves = 6.0;
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

// What a level and the constraints say about a complex on it.
void bind(PatchComplex& complex, const LayoutLevel& level, const CarrierConstraints& constraints)
{
    for (const auto& [v, angle] : level.boundary_angles)
        complex.set_boundary_angle(v, angle);
    for (const Index s : constraints.sites)
        level.for_each_copy(s, [&complex](Index v) { complex.pin(v); });
    for (const auto& [s, quads] : constraints.valences)
        if (!level.on_curve(s))
            complex.want(level.any_copy(s), quads);
    for (const auto& [a, b] : level.apart)
        level.for_each_copy(a, [&, b = b](Index va) {
            level.for_each_copy(b, [&](Index vb) { complex.keep_apart(va, vb); });
        });
}

// K_tri on a level.
Result<PatchComplex> make_triangles(const LayoutLevel& level, const Ground& ground, Index target,
                                    LayoutSummary& summary, Context& context)
{
    SitePlan plan;
    plan.width = ground.width / std::sqrt(surplus);
    plan.inner = inner_sites(level, plan.width, surplus * static_cast<double>(target));
    plan.relaxations = relaxation_rounds;
    plan.keep_apart = true;
    plan.even_regions = true;
    Tiles tiles(level.mesh(), level.density());
    summary.sites_added = place_sites(level, plan, tiles, context);
    summary.sites = static_cast<Index>(tiles.sites().size());
    if (context.cancelled())
        return Context::cancelled_error("layout");
    Result<PatchComplex> complex = build_base_complex(tiles, context);
    if (!complex)
        return complex;
    bind(*complex, level, ground.constraints);
    straighten_triangles(*complex, context);
    improve_triangles(*complex, metric_of(level, ground.width), context);
    if (context.cancelled())
        return Context::cancelled_error("layout");
    return complex;
}

// Makes two vertices neighbours by turning the edge between two triangles that have them as
// opposite corners. False when there is no such edge.
bool join_by_flip(PatchComplex& complex, Index a, Index b)
{
    OverlayBuilder builder(complex.mesh());
    for (Index p = 0; p < complex.paths().size(); ++p) {
        const PatchComplex::Path& path = complex.paths()[p];
        if (!path.alive || complex.is_fixed(p))
            continue;
        const std::vector<Index> faces{path.left, path.right};
        const auto border = complex.border(faces);
        if (!border || border->size() != 4)
            continue;
        for (Index i = 0; i < 2; ++i) {
            if (std::minmax(complex.start((*border)[i]), complex.start((*border)[i + 2])) !=
                    std::minmax(a, b) ||
                std::minmax(complex.start((*border)[i + 1]),
                            complex.start((*border)[(i + 3) % 4])) !=
                    std::minmax(path.geometry.a, path.geometry.b))
                continue;
            auto change = complex.plan(faces, *border, {{i, i + 2}}, builder);
            if (change)
                complex.apply(std::move(*change));
            return change.has_value();
        }
    }
    return false;
}

// The pairings asked for, in vertices of the level; edges of those that are to be joined are made
// where they are missing.
Result<PairingWishes> pairing_wishes(PatchComplex& triangles, const LayoutLevel& level,
                                     const CarrierConstraints& constraints)
{
    PairingWishes wishes;
    for (const auto& pair : constraints.paired) {
        bool found = false;
        for (const bool flip : {false, true})
            level.for_each_copy(pair.a, [&](Index a) {
                level.for_each_copy(pair.b, [&](Index b) {
                    if (found ||
                        (!triangles.path_between(a, b) && !(flip && join_by_flip(triangles, a, b))))
                        return;
                    found = !triangles.is_fixed(*triangles.path_between(a, b));
                    if (found)
                        wishes.joined.emplace_back(a, b);
                });
            });
        if (!found)
            return Error{
                ErrorCode::constraint_conflict,
                "pairing " + std::to_string(pair.number) +
                    ": its sites are joined by no edge of the triangles, nor are they opposite "
                    "corners of two of them: they are too far apart, or a path or feature "
                    "lies between",
                pair.number};
    }
    for (const auto& pair : constraints.unpaired)
        level.for_each_copy(pair.a, [&](Index a) {
            level.for_each_copy(pair.b, [&](Index b) { wishes.parted.emplace_back(a, b); });
        });
    triangles.compact();
    return wishes;
}

// The complex of quads on the carrier and what is needed to make a domain of it.
struct Quads {
    std::unique_ptr<CarrierMesh> refined; // Where paths had to be cut in; else the ground's.
    PatchComplex complex;
};

Result<Quads> make_quads(const ManifoldMesh& source, const LayoutOptions& options,
                         const Ground& ground, const Proxy* proxy, LayoutSummary& summary,
                         Context& context)
{
    const ManifoldMesh& carrier = ground.carrier->mesh;
    const LayoutLevel& level = proxy ? proxy->level() : *ground.level;
    Result<PatchComplex> triangles =
        make_triangles(level, ground, summary.target_patches, summary, context);
    if (!triangles)
        return triangles.error();
    const auto on_carrier = [&](const PatchComplex& made) -> Result<PatchComplex> {
        if (!proxy)
            return uncut(made, *ground.cut, carrier, ground.marks);
        Result<PatchComplex> lifted = proxy->lift(made, context);
        if (!lifted)
            return lifted;
        return uncut(*lifted, *ground.cut, carrier, ground.marks);
    };
    const Result<PairingWishes> wishes = pairing_wishes(*triangles, level, ground.constraints);
    if (!wishes)
        return wishes.error();
    if (!options.split_triangles) {
        PatchComplex quads = *triangles;
        const Result<bool> paired = pair_triangles(quads, *wishes, context);
        if (!paired)
            return paired.error();
        if (*paired) {
            improve_quads(quads, summary.target_patches, metric_of(level, ground.width), context);
            if (context.cancelled())
                return Context::cancelled_error("layout");
            Result<PatchComplex> lifted = on_carrier(quads);
            if (!lifted)
                return lifted.error();
            if (is_simple(*lifted) && has_enough_quads(*lifted))
                return Quads{nullptr, std::move(*lifted)};
        }
    }
    if (!ground.constraints.paired.empty() || !ground.constraints.unpaired.empty())
        return Error{ErrorCode::constraint_conflict,
                     "the pairings asked for leave triangles that cannot be paired", invalid_index};
    summary.subdivided = true;
    summary.notes.push_back("triangles split in three quads each");
    Result<PatchComplex> whole = on_carrier(*triangles);
    if (!whole)
        return whole.error();
    Result<SplitComplex> split = split_in_quads(*whole, source, *ground.carrier, context);
    if (!split)
        return split.error();
    if (!ground.constraints.binds()) {
        const std::vector<double> density(split->carrier->mesh.vertex_count(), 1.0);
        improve_quads(split->complex, summary.target_patches,
                      {density, scaled_area(split->carrier->mesh, density) /
                                    static_cast<double>(summary.target_patches)},
                      context);
    }
    if (context.cancelled())
        return Context::cancelled_error("layout");
    if (!is_simple(split->complex))
        return Error{ErrorCode::layout_failed, "two edges of the layout join the same vertices",
                     invalid_index};
    if (!has_enough_quads(split->complex))
        return Error{ErrorCode::layout_failed, "a vertex of the layout has only two quads",
                     invalid_index};
    return Quads{std::move(split->carrier), std::move(split->complex)};
}

// A coarse mesh in place of the ground's, where that is much finer than patches need.
Result<std::optional<Proxy>> make_proxy(const Ground& ground, Index patches, Context& context)
{
    const double cells =
        static_cast<double>(patches) * 4.0 / (1.732 * proxy_resolution * proxy_resolution);
    const double saving = ground.level->curves().empty() ? proxy_saving : proxy_saving_at_curves;
    if (!(static_cast<double>(ground.carrier->mesh.face_count()) > saving * cells))
        return std::optional<Proxy>();
    Result<Proxy> proxy = Proxy::build(*ground.level, proxy_resolution * ground.width, context);
    if (!proxy)
        return proxy.error();
    return std::optional<Proxy>(std::move(*proxy));
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
    Result<Ground> ground = prepare_ground(source, options, summary, context);
    if (!ground)
        return ground.error();
    if (context.cancelled())
        return Context::cancelled_error("layout");

    // The coarse mesh only saves time: what fails on it is done on the whole mesh.
    Result<std::optional<Proxy>> proxy = make_proxy(*ground, summary.target_patches, context);
    Result<Quads> quads = proxy.ok() ? make_quads(source, options, *ground,
                                                  *proxy ? &**proxy : nullptr, summary, context)
                                     : Result<Quads>(proxy.error());
    if (!quads && quads.error().code == ErrorCode::layout_failed && (!proxy || *proxy)) {
        summary.notes.push_back("laid out on the whole mesh: " + quads.error().message);
        quads = make_quads(source, options, *ground, nullptr, summary, context);
    }
    if (!quads)
        return quads.error();
    CarrierMesh& carrier = quads->refined ? *quads->refined : *ground->carrier;
    Result<QuadDomain> domain = make_domain(quads->complex, std::move(carrier), ground->corner);
    if (!domain)
        return domain.error();
    if (Status lost = check_kept(*domain, source, options.constraints, ground->constraints))
        return *lost;
    result.domain = std::move(*domain);
    return result;
}

} // namespace bot2nurbs
