// SPDX-License-Identifier: MIT
#include "bot2nurbs/report.h"

#include "bot2nurbs/convert.h"
#include "bot2nurbs/version.h"
#include "convert/cloud_json.h"
#include "io/atomic_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace bot2nurbs {

namespace {

// Keys in the order of writing: reports are read by people too.
using Json = nlohmann::ordered_json;

constexpr const char* schema_name = "bot2nurbs.report/1";

void pool(DistanceStatistics& total, const DistanceStatistics& part)
{
    if (part.max > total.max || total.samples == 0) {
        total.max = part.max;
        total.worst = part.worst;
    }
    const double n = total.samples, m = part.samples;
    if (n + m > 0.0)
        total.rms = std::sqrt((n * total.rms * total.rms + m * part.rms * part.rms) / (n + m));
    total.samples += part.samples;
}

Json index_or_null(Index i)
{
    return i == invalid_index ? Json(nullptr) : Json(i);
}

Json error_json(const Error& error)
{
    return {{"code", name(error.code)},
            {"message", error.message},
            {"element", index_or_null(error.element)},
            {"exit_code", exit_code(error.code)}};
}

Json point_json(const Vec3& p)
{
    return Json::array({p.x, p.y, p.z});
}

const char* knots_name(const std::optional<KnotForm>& knots)
{
    if (!knots)
        return "auto";
    return *knots == KnotForm::paper ? "paper" : "c1";
}

const char* name_of(SplineScheme scheme)
{
    switch (scheme) {
    case SplineScheme::peters: return "peters";
    case SplineScheme::full: return "full";
    case SplineScheme::eck_hoppe: return "eck-hoppe";
    }
    return "";
}

constexpr std::array<const char*, 3> component_names{"all", "largest", "split"};

std::string length_text(const Length& length)
{
    return length.relative ? fmt::format("{:g}%", 100.0 * length.value)
                           : fmt::format("{:g}", length.value);
}

Json options_json(const ConvertOptions& o)
{
    Json j;
    j["patches"] = o.patches ? Json(*o.patches) : Json(nullptr);
    j["tolerance"] = o.tolerance ? Json(o.tolerance->value) : Json(nullptr);
    j["tolerance_relative"] = o.tolerance && o.tolerance->relative;
    j["max_patches"] = o.max_patches ? Json(*o.max_patches) : Json(nullptr);
    j["spline"] = name_of(o.spline);
    j["knots"] = knots_name(o.knots);
    j["rounds"] = o.fit.max_rounds;
    j["robust"] = o.fit.robust;
    j["components"] = component_names[static_cast<std::size_t>(o.components)];
    j["fill_holes"] = o.fill_holes ? Json(length_text(*o.fill_holes)) : Json(nullptr);
    j["weld"] = o.weld ? Json(length_text(*o.weld)) : Json(nullptr);
    j["features"] = o.features == FeatureMode::off   ? Json("off")
                    : o.features == FeatureMode::all ? Json(o.feature_options.angle)
                                                     : Json("auto");
    j["closure"] = o.closure == Closure::open    ? "open"
                   : o.closure == Closure::solid ? "solid"
                                                 : "as_input";
    j["repair"] = o.repair;
    j["strict"] = o.strict;
    j["layout"] = o.cage ? "cage" : o.quads ? "quads=" + *o.quads : "eck";
    j["domain_in"] = o.domain_in ? Json(*o.domain_in) : Json(nullptr);
    j["domain_out"] = o.domain_out ? Json(*o.domain_out) : Json(nullptr);
    j["constraints"] = o.constraints ? Json(*o.constraints) : Json(nullptr);
    j["constraints_out"] = o.constraints_out ? Json(*o.constraints_out) : Json(nullptr);
    j["cloud"] = cloud_options_json(o.cloud);
    j["units"] = o.write.units;
    j["archive_version"] = o.write.archive_version;
    j["step_schema"] = o.write.step_schema == StepSchema::ap242 ? "AP242" : "AP214";
    j["seed"] = o.seed;
    return j;
}

Json repair_json(const RepairNote& note)
{
    return {{"code", note.code}, {"message", note.message}, {"count", note.count}};
}

Json side_json(const DistanceStatistics& s)
{
    return {{"max", s.max}, {"rms", s.rms}, {"samples", s.samples}, {"worst", point_json(s.worst)}};
}

const char* name_of(HausdorffTermination termination)
{
    switch (termination) {
    case HausdorffTermination::gap_reached: return "gap_reached";
    case HausdorffTermination::decided: return "decided";
    case HausdorffTermination::cell_limit: return "cell_limit";
    }
    return "";
}

//! `diagonal`: what relative distances are relative to. `bounds`: of the largest distance.
Json deviation_json(const Deviation& d, const std::optional<DistanceBounds>& bounds,
                    double diagonal, const std::string& unit)
{
    Json j;
    j["unit"] = unit;
    j["diagonal"] = diagonal;
    j["kind"] = bounds ? "proven" : "sampled";
    j["max"] = d.max();
    j["rms"] = d.rms();
    j["max_relative"] = diagonal > 0.0 ? d.max() / diagonal : 0.0;
    j["rms_relative"] = diagonal > 0.0 ? d.rms() / diagonal : 0.0;
    if (bounds) {
        j["lower_bound"] = bounds->lower;
        j["upper_bound"] = bounds->upper;
        j["upper_bound_relative"] = diagonal > 0.0 ? bounds->upper / diagonal : 0.0;
    }
    j["source_to_surface"] = side_json(d.source_to_surface);
    j["surface_to_source"] = side_json(d.surface_to_source);
    return j;
}

//! What is known of one component only: where it is worst, and what the bound took.
void add_bound(Json& deviation, const HausdorffBound& bound)
{
    const FarPlace& worst = bound.worse_side().worst;
    deviation["worst"] = {
        {"side", &bound.worse_side() == &bound.surface_to_source ? "surface" : "source"},
        {"point", point_json(worst.point)},
        {"distance", worst.distance},
        {"patch", index_or_null(worst.surface.quad)},
        {"u", worst.surface.u},
        {"v", worst.surface.v}};
    deviation["bound"] = {{"termination", name_of(bound.termination)},
                          {"cells", bound.cells},
                          {"queries", bound.queries}};
}

Json continuity_json(const Continuity& c)
{
    return {{"max_gap", c.max_gap},
            {"max_g1_angle_deg", c.max_g1_angle_deg},
            {"crease_edges", c.crease_edges}};
}

Json domain_json(const DomainReport& d)
{
    Json j;
    j["faces"] = d.faces;
    j["edges"] = d.edges;
    j["vertices"] = d.vertices;
    j["extraordinary"] = d.extraordinary;
    j["max_valence"] = d.max_valence;
    Json valences = Json::object();
    for (std::size_t v = 0; v < d.valences.size(); ++v)
        if (d.valences[v] > 0)
            valences[std::to_string(v)] = d.valences[v];
    j["valences"] = valences;
    j["source"] = d.source;
    if (!d.signature.empty())
        j["signature"] = d.signature;
    return j;
}

Json layout_json(const LayoutSummary& l)
{
    return {{"sites", l.sites},
            {"sites_added", l.sites_added},
            {"target_patches", l.target_patches},
            {"uniform_maps", l.uniform_maps},
            {"exact_maps", l.exact_maps},
            {"subdivided", l.subdivided},
            {"notes", l.notes}};
}

Json fit_json(const FitSummary& f)
{
    Json j;
    j["rounds"] = f.rounds.size();
    j["unknowns"] = f.unknowns;
    j["samples"] = f.samples;
    j["condition"] = f.condition;
    j["used_fallback"] = f.used_fallback;
    j["termination"] = f.termination;
    return j;
}

Json rounds_json(const FitSummary& f)
{
    Json j = Json::array();
    for (const FitRound& r : f.rounds)
        j.push_back({{"rms", r.rms},
                     {"max", r.max},
                     {"fairness", r.fairness},
                     {"damping", r.damping},
                     {"crossed", r.crossed},
                     {"seconds", r.seconds}});
    return j;
}

Json brep_json(Index faces, Index edges, Index vertices, const BrepReport& b)
{
    Json j;
    j["faces"] = faces;
    j["edges"] = edges;
    j["vertices"] = vertices;
    j["boundary_edges"] = b.boundary_edges;
    j["nonmanifold_edges"] = b.nonmanifold_edges;
    j["valid"] = b.valid;
    j["solid"] = b.solid;
    j["max_edge_gap"] = b.max_edge_gap;
    j["volume"] = b.volume;
    return j;
}

Json spread_json(const Spread& s)
{
    return {{"least", s.least},
            {"median", s.median},
            {"most", s.most},
            {"least_at", index_or_null(s.least_at)},
            {"most_at", index_or_null(s.most_at)}};
}

Json quality_json(const LayoutQuality& q)
{
    return {{"stretch", spread_json(q.stretch)},
            {"angle", spread_json(q.angle)},
            {"area_ratio", spread_json(q.area_ratio)},
            {"aspect", spread_json(q.aspect)},
            {"size", spread_json(q.size)},
            {"straightness", spread_json(q.straightness)}};
}

Json curve_json(const CurveDeviation& c)
{
    return {{"edges", c.edges},
            {"length", c.length},
            {"source_to_surface", side_json(c.source_to_surface)},
            {"surface_to_source", side_json(c.surface_to_source)}};
}

Json tolerance_json(const ToleranceReport& t)
{
    Json j;
    j["tolerance"] = t.tolerance;
    j["tolerance_met"] = t.met;
    j["termination"] = name(t.termination);
    j["lower_bound"] = t.distance.lower;
    j["upper_bound"] = t.distance.upper;
    j["worst"] = {{"patch", index_or_null(t.worst.surface.quad)},
                  {"u", t.worst.surface.u},
                  {"v", t.worst.surface.v},
                  {"point", point_json(t.worst.point)},
                  {"distance", t.worst.distance}};
    j["best"] = t.best;
    j["rounds"] = Json::array();
    for (const RefinementRound& r : t.rounds)
        j["rounds"].push_back({{"patches", r.patches},
                               {"unknowns", r.unknowns},
                               {"rms", r.rms},
                               {"lower_bound", r.distance.lower},
                               {"upper_bound", r.distance.upper},
                               {"beyond", r.beyond},
                               {"seconds", r.seconds}});
    return j;
}

Json component_json(const ComponentOutcome& c, const std::string& unit)
{
    Json j;
    j["first_face"] = index_or_null(c.first_face);
    j["vertices"] = c.vertices;
    j["faces"] = c.faces;
    j["genus"] = c.genus;
    j["boundary_loops"] = c.boundary_loops;
    j["domain"] = domain_json(c.domain);
    if (c.layout)
        j["layout"] = layout_json(*c.layout);
    if (c.quads)
        j["quads"] = {{"largest_move", c.quads->largest_move},
                      {"farthest_vertex", c.quads->farthest_vertex},
                      {"crease_edges", c.quads->crease_edges},
                      {"largest_detour", c.quads->largest_detour},
                      {"detour_edge", c.quads->detour_edge}};
    j["layout_quality"] = quality_json(c.quality);
    if (c.brep_faces > 0) {
        j["fit"] = fit_json(c.fit);
        j["fit"]["history"] = rounds_json(c.fit);
        std::optional<DistanceBounds> bounds;
        if (c.bound)
            bounds = DistanceBounds{c.bound->lower(), c.bound->upper()};
        j["deviation"] = deviation_json(c.deviation, bounds, c.diagonal, unit);
        if (c.tolerance)
            j["tolerance"] = tolerance_json(*c.tolerance);
        j["deviation"]["worst_patch"] = index_or_null(c.deviation.worst_patch);
        if (c.bound)
            add_bound(j["deviation"], *c.bound);
        j["boundary"] = Json::array();
        for (const CurveDeviation& loop : c.curves.boundary)
            j["boundary"].push_back(curve_json(loop));
        if (c.curves.creases)
            j["creases"] = curve_json(*c.curves.creases);
        j["continuity"] = continuity_json(c.continuity);
        j["brep"] = brep_json(c.brep_faces, c.brep_edges, c.brep_vertices, c.brep);
    }
    return j;
}

Json stages_json(const std::vector<StageRecord>& stages)
{
    Json j = Json::array();
    for (const StageRecord& s : stages)
        j.push_back({{"name", s.name},
                     {"seconds", s.seconds},
                     {"cpu_seconds", s.cpu_seconds},
                     {"peak_rss_mib", s.peak_rss_mib}});
    return j;
}

Json input_json(const ConvertOptions& options, const ConvertReport& report)
{
    Json j;
    j["path"] = options.input;
    j["vertices"] = report.input_vertices;
    j["faces"] = report.input_faces;
    j["points"] = report.cloud ? report.cloud->points : 0;
    j["units"] = report.units;
    j["components"] = Json::array();
    for (const ComponentOutcome& c : report.components)
        j["components"].push_back({{"genus", c.genus},
                                   {"boundary_loops", c.boundary_loops},
                                   {"volume", c.source_volume}});
    j["repairs"] = Json::array();
    for (const RepairNote& note : report.repairs)
        j["repairs"].push_back(repair_json(note));
    return j;
}

DomainReport all_domains(const std::vector<ComponentOutcome>& components)
{
    DomainReport sum;
    for (const ComponentOutcome& c : components) {
        const DomainReport& d = c.domain;
        sum.source = sum.source.empty() || sum.source == d.source ? d.source : "mixed";
        sum.faces += d.faces;
        sum.edges += d.edges;
        sum.vertices += d.vertices;
        sum.extraordinary += d.extraordinary;
        sum.max_valence = std::max(sum.max_valence, d.max_valence);
        sum.valences.resize(std::max(sum.valences.size(), d.valences.size()), 0);
        for (std::size_t v = 0; v < d.valences.size(); ++v)
            sum.valences[v] += d.valences[v];
    }
    if (components.size() == 1)
        sum.signature = components.front().domain.signature;
    return sum;
}

//! Sizes summed; rounds, condition and termination those of the component with most rounds.
FitSummary all_fits(const std::vector<ComponentOutcome>& components)
{
    FitSummary sum;
    for (const ComponentOutcome& c : components) {
        if (c.fit.rounds.size() > sum.rounds.size()) {
            sum.rounds = c.fit.rounds;
            sum.termination = c.fit.termination;
        }
        sum.unknowns += c.fit.unknowns;
        sum.samples += c.fit.samples;
        sum.condition = std::max(sum.condition, c.fit.condition);
        sum.used_fallback = sum.used_fallback || c.fit.used_fallback;
    }
    return sum;
}

//! Of the first component that is not within the tolerance, else that it is met.
RefinementEnd termination(const std::vector<ComponentOutcome>& components)
{
    for (const ComponentOutcome& c : components)
        if (c.tolerance && !c.tolerance->met)
            return c.tolerance->termination;
    return RefinementEnd::tolerance_met;
}

Json all_breps(const ConvertReport& report)
{
    BrepReport sum;
    Index faces = 0, edges = 0, vertices = 0;
    for (const ComponentOutcome& c : report.components) {
        faces += c.brep_faces;
        edges += c.brep_edges;
        vertices += c.brep_vertices;
        sum.boundary_edges += c.brep.boundary_edges;
        sum.nonmanifold_edges += c.brep.nonmanifold_edges;
        sum.max_edge_gap = std::max(sum.max_edge_gap, c.brep.max_edge_gap);
        sum.volume += c.brep.volume;
    }
    sum.valid = report.valid();
    sum.solid = report.solid();
    return brep_json(faces, edges, vertices, sum);
}

// Sharp edges of all components. Of those smoothed over the first ones are listed.
Json features_json(const std::vector<ComponentOutcome>& components)
{
    constexpr std::size_t most_listed = 1000;
    Index detected = 0, kept = 0, creases = 0, corners = 0;
    std::size_t smoothed = 0;
    Json listed = Json::array();
    for (const ComponentOutcome& c : components) {
        detected += c.features.detected_edges;
        kept += c.features.kept_edges;
        creases += c.features.creases;
        corners += c.features.corners;
        smoothed += c.features.smoothed.size();
        for (const auto& edge : c.features.smoothed)
            if (listed.size() < most_listed)
                listed.push_back(edge);
    }
    return {{"detected_edges", detected}, {"kept_edges", kept}, {"smoothed_edges", smoothed},
            {"creases", creases},         {"corners", corners}, {"smoothed", listed}};
}

Continuity all_joins(const std::vector<ComponentOutcome>& components)
{
    Continuity worst;
    for (const ComponentOutcome& c : components) {
        worst.max_gap = std::max(worst.max_gap, c.continuity.max_gap);
        worst.max_g1_angle_deg = std::max(worst.max_g1_angle_deg, c.continuity.max_g1_angle_deg);
        worst.crease_edges += c.continuity.crease_edges;
    }
    return worst;
}

//! Paths may hold bytes that are no UTF-8: they are replaced, so that writing never fails.
std::string text_of(const Json& j)
{
    return j.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace

Deviation ConvertReport::deviation() const
{
    Deviation all;
    for (const ComponentOutcome& c : components) {
        pool(all.source_to_surface, c.deviation.source_to_surface);
        pool(all.surface_to_source, c.deviation.surface_to_source);
    }
    return all;
}

std::optional<DistanceBounds> ConvertReport::distance() const
{
    DistanceBounds all;
    for (const ComponentOutcome& c : components) {
        if (!c.bound)
            return std::nullopt;
        all.lower = std::max(all.lower, c.bound->lower());
        all.upper = std::max(all.upper, c.bound->upper());
    }
    return components.empty() ? std::nullopt : std::optional(all);
}

bool ConvertReport::valid() const
{
    return !components.empty() &&
           std::all_of(components.begin(), components.end(),
                       [](const ComponentOutcome& c) { return c.brep.valid; });
}

bool ConvertReport::solid() const
{
    return !components.empty() &&
           std::all_of(components.begin(), components.end(),
                       [](const ComponentOutcome& c) { return c.brep.solid; });
}

bool ConvertReport::tolerance_met() const
{
    return std::all_of(components.begin(), components.end(),
                       [](const ComponentOutcome& c) { return !c.tolerance || c.tolerance->met; });
}

std::string report_to_json(const ConvertOptions& options, const ConvertReport& report)
{
    Json j;
    j["schema"] = schema_name;
    j["version"] = BOT2NURBS_VERSION;
    j["options"] = options_json(options);
    j["input"] = input_json(options, report);
    j["domain"] = domain_json(all_domains(report.components));
    const bool fitted = !report.components.empty() && report.components.front().brep_faces > 0;
    if (fitted) {
        j["fit"] = fit_json(all_fits(report.components));
        j["deviation"] =
            deviation_json(report.deviation(), report.distance(), report.diagonal, report.units);
        if (options.tolerance) {
            j["fit"]["termination"] = name(termination(report.components));
            j["fit"]["tolerance_met"] = report.tolerance_met();
        }
        j["continuity"] = continuity_json(all_joins(report.components));
        j["brep"] = all_breps(report);
        // No test of our own decides this yet; the report must not claim more.
        j["embedded"] = "undecided";
    }
    if (report.cloud)
        j["cloud"] = cloud_json(*report.cloud, fitted);
    j["features"] = features_json(report.components);
    j["components"] = Json::array();
    for (const ComponentOutcome& c : report.components)
        j["components"].push_back(component_json(c, report.units));
    j["outputs"] = Json::array();
    for (const OutputFile& o : report.outputs)
        j["outputs"].push_back({{"path", o.path}, {"format", o.format}, {"bytes", o.bytes}});
    j["stages"] = stages_json(report.stages);
    j["warnings"] = Json::array();
    for (const Warning& w : report.warnings)
        j["warnings"].push_back(
            {{"code", w.code}, {"message", w.message}, {"element", index_or_null(w.element)}});
    return text_of(j);
}

std::string failure_to_json(const ConvertOptions& options, const Error& error,
                            const std::vector<StageRecord>& stages)
{
    Json j;
    j["schema"] = schema_name;
    j["version"] = BOT2NURBS_VERSION;
    j["options"] = options_json(options);
    j["input"] = {{"path", options.input}};
    j["error"] = error_json(error);
    j["stages"] = stages_json(stages);
    return text_of(j);
}

std::string input_report_to_json(const ConvertOptions& options, const InputReport& report)
{
    const MeshReport& m = report.mesh;
    Json j;
    j["schema"] = "bot2nurbs.check/1";
    j["version"] = BOT2NURBS_VERSION;
    j["input"] = {{"path", options.input},
                  {"vertices", m.vertices},
                  {"faces", m.faces},
                  {"closed", m.closed},
                  {"manifold", m.manifold},
                  {"orientable", m.orientable},
                  {"oriented", m.oriented},
                  {"sharp_edges", m.sharp_edges},
                  {"self_intersecting_pairs", m.self_intersecting_pairs}};
    j["components"] = Json::array();
    for (const ComponentReport& c : m.components)
        j["components"].push_back({{"first_face", index_or_null(c.first_face)},
                                   {"faces", c.faces},
                                   {"vertices", c.vertices},
                                   {"closed", c.closed},
                                   {"orientable", c.orientable},
                                   {"oriented", c.oriented},
                                   {"genus", c.genus},
                                   {"boundary_loops", c.boundary_loops},
                                   {"volume", c.volume}});
    j["boundary_loops"] = m.boundary_loops;
    j["self_intersections"] = m.self_intersections;
    j["defects"] = Json::array();
    for (const MeshDefect& d : m.defects)
        j["defects"].push_back({{"code", d.code},
                                {"message", d.message},
                                {"element", index_or_null(d.element)},
                                {"count", d.count}});
    j["repairs"] = Json::array();
    for (const RepairNote& note : report.repairs)
        j["repairs"].push_back(repair_json(note));
    if (report.cloud)
        j["cloud"] = cloud_json(*report.cloud, false);
    j["accepted"] = !report.rejection;
    if (report.rejection)
        j["rejection"] = error_json(*report.rejection);
    return text_of(j);
}

std::string domain_report_to_json(const ConvertOptions& options, const DomainFileReport& report)
{
    Json j;
    j["schema"] = "bot2nurbs.domain-check/1";
    j["version"] = BOT2NURBS_VERSION;
    j["input"] = {{"path", options.input}};
    j["domain"] = {{"path", options.domain_in.value_or("")}};
    j["components"] = Json::array();
    for (const DomainValidation& c : report.components) {
        Json defects = Json::array();
        for (const DomainDefect& d : c.defects)
            defects.push_back(
                {{"rule", d.rule}, {"message", d.message}, {"element", index_or_null(d.element)}});
        j["components"].push_back({{"valid", c.valid()},
                                   {"quads", c.quads},
                                   {"edges", c.edges},
                                   {"vertices", c.vertices},
                                   {"extraordinary", c.extraordinary},
                                   {"max_valence", c.max_valence},
                                   {"euler_characteristic", c.euler_characteristic},
                                   {"boundary_loops", c.boundary_loops},
                                   {"mean_stretch", c.charts.mean_stretch},
                                   {"max_stretch", c.charts.max_stretch},
                                   {"worst_quad", index_or_null(c.charts.worst_quad)},
                                   {"min_jacobian", c.charts.min_jacobian},
                                   {"max_jacobian", c.charts.max_jacobian},
                                   {"min_area", c.charts.min_area},
                                   {"max_area", c.charts.max_area},
                                   {"defect_count", c.defect_count},
                                   {"defects", defects}});
    }
    j["accepted"] = !report.rejection;
    if (report.rejection)
        j["rejection"] = error_json(*report.rejection);
    return text_of(j);
}

Status write_report(const std::string& json, const std::string& path)
{
    return write_whole_file(path, json);
}

} // namespace bot2nurbs
