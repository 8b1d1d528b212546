// SPDX-License-Identifier: MIT
#include "convert/component.h"

#include "bot2nurbs/detect_features.h"
#include "bot2nurbs/domain_samples.h"
#include "bot2nurbs/layout.h"
#include "bot2nurbs/point_deviation.h"
#include "convert/component_tolerance.h"
#include "convert/constraints_input.h"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

namespace bot2nurbs {

namespace {

//! Moves and scales between the coordinates of the input and the unit box.
struct Frame {
    Vec3 centre;
    double size = 1.0; //!< Longest side of the component's box.

    explicit Frame(const Box3& box) : centre(box.center())
    {
        const Vec3 side = box.max - box.min;
        size = std::max({side.x, side.y, side.z});
    }
    Vec3 to_unit(const Vec3& p) const { return (p - centre) / size; }
    Vec3 from_unit(const Vec3& p) const { return size * p + centre; }
};

Result<ManifoldMesh> unit_mesh(const ManifoldMesh& mesh, const Frame& frame)
{
    std::vector<Vec3> positions = mesh.positions();
    for (Vec3& p : positions)
        p = frame.to_unit(p);
    return ManifoldMesh::build(std::move(positions), mesh.triangles());
}

//! Puts the vertices of a carrier that was read where its provenance says they are on the unit
//! mesh, which is where a fresh layout has them: the two then agree to the bit.
Status place_carrier(CarrierMesh& carrier, const ManifoldMesh& unit)
{
    if (!carrier.refined) {
        carrier = CarrierMesh::from_source(unit);
        return {};
    }
    std::vector<Vec3> positions(carrier.mesh.vertex_count());
    for (Index v = 0; v < carrier.mesh.vertex_count(); ++v)
        positions[v] =
            v < unit.vertex_count() ? unit.position(v) : unit.at(carrier.vertex_source[v]);
    Result<ManifoldMesh> mesh = ManifoldMesh::build(std::move(positions), carrier.mesh.triangles());
    if (!mesh)
        return mesh.error();
    carrier.mesh = std::move(*mesh);
    return {};
}

DomainReport describe(const QuadDomain& domain)
{
    DomainReport report;
    const QuadComplex& k = domain.complex;
    report.source = domain.origin;
    report.signature = domain.source_signature;
    report.faces = k.quad_count();
    report.edges = k.edge_count();
    report.vertices = k.vertex_count();
    report.extraordinary = k.extraordinary_count();
    report.max_valence = k.max_valence();
    report.valences.assign(report.max_valence + 1, 0);
    for (Index v = 0; v < k.vertex_count(); ++v)
        ++report.valences[k.valence(v)];
    return report;
}

Result<MeshFeatures> find_features(const ManifoldMesh& mesh, const ConvertOptions& options,
                                   Context& context)
{
    FeatureOptions how = options.feature_options;
    if (options.features == FeatureMode::all)
        how.least_clear_share = 0.0;
    Result<MeshFeatures> found = detect_features(mesh, how, context);
    if (found && options.features == FeatureMode::off) {
        found->creases.clear();
        found->kept_edges = 0;
    }
    return found;
}

FeatureReport describe(const MeshFeatures& features, const MeshComponent& component)
{
    FeatureReport report;
    report.detected_edges = features.sharp_edges;
    report.kept_edges = features.kept_edges;
    report.creases = static_cast<Index>(features.creases.size());
    report.corners = static_cast<Index>(features.corners.size());
    report.clear_share = features.clear_share;
    for (const auto& [a, b] : features.smoothed)
        report.smoothed.push_back({component.source_vertex[a], component.source_vertex[b]});
    return report;
}

std::vector<FeaturePath> feature_paths(const MeshFeatures& features)
{
    std::vector<FeaturePath> paths;
    for (const std::vector<Index>& crease : features.creases)
        paths.push_back({FeatureKind::crease, crease});
    if (!features.corners.empty())
        paths.push_back({FeatureKind::corner, features.corners});
    return paths;
}

//! The points in the frame of the unit mesh, with their places on it.
Result<PointData> unit_points(const PointData& points, const ManifoldMesh& unit, const Frame& frame,
                              Context& context)
{
    PointData result = points;
    for (Vec3& p : result.positions)
        p = frame.to_unit(p);
    for (double& w : result.weights)
        w /= frame.size * frame.size;
    result.noise /= frame.size;
    result.least_deviation /= frame.size;
    Result<std::vector<SourcePoint>> places = closest_places(unit, result.positions, context);
    if (!places)
        return places.error();
    result.source = std::move(*places);
    return result;
}

//! Puts the points in the place of the mesh on the way to the surface.
Status measure_points(const PointData& points, const QuadComplex& complex,
                      ConvertedComponent& result, Context& context)
{
    const Result<std::vector<PointFoot>> feet =
        find_point_feet(points.positions, complex, result.surface, context);
    if (!feet)
        return feet.error();
    for (const PointFoot& foot : *feet)
        result.point_distances.push_back(foot.distance);
    const PointDeviation d = summarise_distances(result.point_distances);
    DistanceStatistics& side = result.outcome.deviation.source_to_surface;
    side.max = d.max;
    side.rms = d.rms;
    side.samples = d.points;
    side.worst = d.points > 0 ? points.positions[d.worst] : Vec3{};
    if (result.outcome.tolerance) {
        FarPlace worst;
        if (d.points > 0)
            worst = {points.positions[d.worst], d.max, (*feet)[d.worst].where, {}};
        judge_points(worst, result.outcome);
    }
    return std::nullopt;
}

//! The domain that a quad mesh makes; creases that it does not follow are no features any more.
Result<QuadDomain> import_layout(const ManifoldMesh& unit, QuadMesh quads, const Frame& frame,
                                 MeshFeatures& features, QuadsReport& report, Context& context)
{
    for (Vec3& p : quads.positions)
        p = frame.to_unit(p);
    Result<QuadImport> made = import_quads(unit, quads, features, context);
    if (!made)
        return made.error();
    report.largest_move = frame.size * made->largest_move;
    report.farthest_vertex = quads.source_vertex[made->farthest_vertex];
    report.crease_edges = made->crease_edges;
    features.kept_edges -= static_cast<Index>(made->smoothed.size());
    features.smoothed.insert(features.smoothed.end(), made->smoothed.begin(), made->smoothed.end());
    return std::move(made->domain);
}

void to_input_units(DistanceStatistics& s, const Frame& frame)
{
    s.max *= frame.size;
    s.rms *= frame.size;
    s.worst = frame.from_unit(s.worst);
}

//! The largest distances are those proven to be attained. Distances of samples from the mesh are
//! exact too, and may be larger on the side that is less far, whose bounds are loose; those from
//! the surface are what a local search ended with.
void use_proven(Deviation& sampled, const HausdorffBound& proven)
{
    sampled.source_to_surface.max = proven.source_to_surface.lower;
    sampled.source_to_surface.worst = proven.source_to_surface.worst.point;
    if (proven.surface_to_source.lower > sampled.surface_to_source.max) {
        sampled.surface_to_source.max = proven.surface_to_source.lower;
        sampled.surface_to_source.worst = proven.surface_to_source.worst.point;
        sampled.worst_patch = proven.surface_to_source.worst.surface.quad;
    }
}

void to_input_units(CurveDeviation& c, const Frame& frame)
{
    c.length *= frame.size;
    to_input_units(c.source_to_surface, frame);
    to_input_units(c.surface_to_source, frame);
}

void to_input_units(FitSummary& fit, const Frame& frame)
{
    for (FitRound& round : fit.rounds) {
        round.rms *= frame.size;
        round.max *= frame.size;
    }
}

void log_rounds(const FitSummary& fit, const Context& context)
{
    for (std::size_t i = 0; i < fit.rounds.size(); ++i) {
        const FitRound& r = fit.rounds[i];
        context.log(LogLevel::info,
                    fmt::format("fit round {}: rms {:.4g}, max {:.4g}, fairness {:.2g}, {} samples "
                                "changed patch, {:.2f} s",
                                i + 1, r.rms, r.max, r.fairness, r.crossed, r.seconds));
    }
}

Result<SurfaceSampleSet> sample_domain(const ManifoldMesh& source, const QuadComplex& complex,
                                       const std::vector<QuadChart>& charts, Context& context)
{
    Result<SurfaceSampleSet> samples = make_samples(source, charts, {}, context);
    if (samples)
        add_curve_samples(source, complex, charts, {}, *samples);
    return samples;
}

Result<FitResult> fit_samples(const QuadComplex& complex, const std::vector<QuadChart>& charts,
                              SurfaceSampleSet& samples, const NearestPlace& nearest,
                              const ConvertOptions& options, Context& context)
{
    const Result<SplineNetwork> network =
        build_spline_network(complex, options.spline, corner_angles(charts));
    if (!network)
        return network.error();
    return fit_network(*network, samples, options.fit, context, nearest);
}

//! The edge that is longest over the distance of its ends.
void find_detour(const QuadDomain& domain, const std::vector<Index>& vertex_names,
                 QuadsReport& report)
{
    const ManifoldMesh& mesh = domain.carrier.mesh;
    for (const DomainEdge& edge : domain.edges) {
        const Vec3 start = mesh.position(domain.vertices[edge.a]);
        const Vec3 end = mesh.position(domain.vertices[edge.b]);
        Vec3 last = start;
        double length = 0.0;
        for (const PathPoint& p : edge.path) {
            const Vec3 next = p.is_vertex()
                                  ? mesh.position(p.from)
                                  : (1.0 - p.t) * mesh.position(p.from) + p.t * mesh.position(p.to);
            length += norm(next - last);
            last = next;
        }
        length += norm(end - last);
        const double distance = norm(end - start);
        if (distance > 0.0 && length > report.largest_detour * distance) {
            report.largest_detour = length / distance;
            report.detour_edge = {vertex_names[edge.a], vertex_names[edge.b]};
        }
    }
}

// Chosen for the tolerance, where there is one and the number of patches is free.
Result<TriedLayout> make_layout(const ManifoldMesh& unit, const LayoutOptions& how,
                                const std::optional<ToleranceOptions>& tolerance,
                                const PointData* points, Context& context)
{
    if (tolerance && !how.patches)
        return layout_for_tolerance(unit, how, *tolerance, points, context);
    Result<LayoutResult> made = build_layout(unit, how, context);
    if (!made)
        return made.error();
    return TriedLayout{std::move(*made), nullptr};
}

} // namespace

Result<ConvertedComponent> convert_component(const MeshComponent& component, DomainWishes wishes,
                                             const PointData* points, const ConvertOptions& options,
                                             const std::vector<KnotForm>& forms,
                                             const std::string& stage_suffix, Context& context)
{
    const auto stage = [&](const char* name) { context.begin_stage(name + stage_suffix); };
    const Frame frame(component.mesh.box());
    const Result<ManifoldMesh> unit = unit_mesh(component.mesh, frame);
    if (!unit)
        return unit.error();

    ConvertedComponent result;
    ComponentOutcome& outcome = result.outcome;
    outcome.first_face = component.source_face.empty() ? invalid_index : component.source_face[0];
    outcome.vertices = component.mesh.vertex_count();
    outcome.faces = component.mesh.face_count();
    outcome.genus = component.genus;
    outcome.boundary_loops = component.boundary_loops;
    outcome.source_volume = component.volume;
    outcome.diagonal = component.mesh.box().diagonal();

    stage("features");
    // The surface of a cage is smooth; edges of a mesh through points are the mesh's own, which
    // rounds those of the body.
    const bool seek_features =
        !options.cage && (points == nullptr || options.features == FeatureMode::all);
    Result<MeshFeatures> features =
        seek_features ? find_features(*unit, options, context) : MeshFeatures();
    if (!features)
        return features.error();

    std::optional<ToleranceOptions> tolerance;
    if (wishes.tolerance)
        tolerance = tolerance_options(options, *wishes.tolerance / frame.size);

    std::optional<PointData> data;
    if (points != nullptr) {
        Result<PointData> made = unit_points(*points, *unit, frame, context);
        if (!made)
            return made.error();
        data = std::move(*made);
    }
    const PointData* const fit_to = data ? &*data : nullptr;

    stage("layout");
    TrialPointer tried;
    if (wishes.supplied) {
        result.domain = std::move(*wishes.supplied);
        if (Status failed = place_carrier(result.domain.carrier, *unit))
            return *failed;
    } else if (wishes.quads) {
        Result<QuadDomain> domain =
            import_layout(*unit, *wishes.quads, frame, *features, outcome.quads.emplace(), context);
        if (!domain)
            return domain.error();
        result.domain = std::move(*domain);
        result.domain.source_signature = signature(component.mesh);
    } else {
        LayoutOptions layout_options;
        layout_options.patches = options.patches;
        layout_options.features = feature_paths(*features);
        layout_options.constraints = std::move(wishes.constraints);
        layout_options.seed = options.seed;
        Result<TriedLayout> made = make_layout(*unit, layout_options, tolerance, fit_to, context);
        if (!made)
            return made.error();
        tried = std::move(made->trial);
        result.domain = std::move(made->layout.domain);
        result.domain.source_signature = signature(component.mesh);
        if (options.constraints_out)
            result.constraints = constraints_used(layout_options.constraints,
                                                  layout_options.features, *unit, result.domain);
        outcome.layout = made->layout.summary;
        for (const std::string& note : outcome.layout->notes)
            context.log(LogLevel::info, "layout: " + note);
    }
    outcome.features = describe(*features, component);
    if (outcome.quads)
        find_detour(result.domain, wishes.quads->source_vertex, *outcome.quads);

    std::optional<FitResult> fit;
    if (tolerance) {
        stage("refine");
        Result<ToleranceFit> refined = refine_to_tolerance(
            *unit, std::move(result.domain), *tolerance, fit_to, context, std::move(tried));
        if (!refined)
            return refined.error();
        outcome.tolerance = describe(*refined, frame.size);
        outcome.tolerance->tolerance = *wishes.tolerance;
        log_rounds(*outcome.tolerance, context);
        result.domain = std::move(refined->domain);
        fit = std::move(refined->fit);
        result.anchors = refined->anchors;
    }
    outcome.domain = describe(result.domain);

    stage("charts");
    const Result<std::vector<QuadChart>> charts = compute_charts(*unit, result.domain, context);
    if (!charts)
        return charts.error();
    if (outcome.layout)
        for (const QuadChart& chart : *charts) {
            outcome.layout->uniform_maps += chart.level == MapLevel::uniform;
            outcome.layout->exact_maps += chart.level == MapLevel::exact;
        }
    outcome.quality = measure_layout(result.domain, *charts);
    if (forms.empty())
        return result;

    if (!fit) {
        stage("samples");
        Result<SurfaceSampleSet> samples =
            data ? make_point_samples(*unit, result.domain.complex, *charts, *data, result.anchors,
                                      context)
                 : sample_domain(*unit, result.domain.complex, *charts, context);
        if (!samples)
            return samples.error();
        stage("fit");
        ConvertOptions fit_options = options;
        if (data) {
            fit_options.fit.robust = true;
            fit_options.fit.least_deviation = data->least_deviation;
            fit_options.fit.noise = data->noise;
        }
        Result<FitResult> fitted = fit_samples(
            result.domain.complex, *charts, *samples,
            data ? NearestPlace() : nearest_place(*unit, context), fit_options, context);
        if (!fitted)
            return fitted.error();
        fit = std::move(*fitted);
    }
    outcome.fit = std::move(fit->summary);
    to_input_units(outcome.fit, frame);
    log_rounds(outcome.fit, context);

    stage("measure");
    Result<Deviation> deviation =
        measure_deviation(*unit, result.domain.complex, fit->surface, context);
    if (!deviation)
        return deviation.error();
    outcome.deviation = *deviation;
    to_input_units(outcome.deviation.source_to_surface, frame);
    to_input_units(outcome.deviation.surface_to_source, frame);
    outcome.curves = measure_curves(result.domain, fit->surface);
    for (CurveDeviation& loop : outcome.curves.boundary)
        to_input_units(loop, frame);
    if (outcome.curves.creases)
        to_input_units(*outcome.curves.creases, frame);
    result.surface = std::move(fit->surface);
    result.surface.transform(frame.size, frame.centre);
    // Of the coordinates that are written: rounding far from the origin is part of the result.
    outcome.continuity = measure_continuity(result.domain.complex, result.surface);

    stage("bound");
    if (points != nullptr) {
        if (Status failed = measure_points(*points, result.domain.complex, result, context))
            return *failed;
    } else {
        const Result<HausdorffBound> bound =
            bound_hausdorff(component.mesh, result.domain.complex, result.surface, {}, context);
        if (!bound)
            return bound.error();
        outcome.bound = *bound;
        use_proven(outcome.deviation, *bound);
        if (outcome.tolerance) {
            if (Status failed = judge(component.mesh, result.domain.complex, result.surface, *bound,
                                      *outcome.tolerance, context))
                return *failed;
            outcome.fit.termination = name(outcome.tolerance->termination);
        }
    }

    stage("brep");
    for (const KnotForm form : forms) {
        Result<Brep> brep = assemble_brep(result.domain.complex, result.surface, form);
        if (!brep)
            return brep.error();
        result.breps.push_back(std::move(*brep));
    }
    const Brep& first = result.breps.front();
    outcome.brep = check_brep(first);
    outcome.brep_faces = static_cast<Index>(first.faces.size());
    outcome.brep_edges = static_cast<Index>(first.edges.size());
    outcome.brep_vertices = static_cast<Index>(first.vertices.size());
    if (component.boundary_loops == 0 ? !outcome.brep.solid : !outcome.brep.valid)
        return Error{
            ErrorCode::brep_failed,
            (component.boundary_loops == 0 ? "the B-Rep is no solid" : "the B-Rep is not valid") +
                (outcome.brep.defects.empty() ? std::string()
                                              : ": " + outcome.brep.defects[0].message),
            outcome.brep.defects.empty() ? invalid_index : outcome.brep.defects[0].element};
    return result;
}

} // namespace bot2nurbs
