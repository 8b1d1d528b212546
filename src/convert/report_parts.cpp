// SPDX-License-Identifier: MIT
#include "convert/report_parts.h"

#include "convert/cloud_json.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

namespace bot2nurbs {

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

namespace {

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

} // namespace

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

namespace {

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

} // namespace

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

namespace {

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

} // namespace

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

namespace {

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

} // namespace

Json fit_json(const FitSummary& f)
{
    Json j;
    j["rounds"] = f.rounds.size();
    j["unknowns"] = f.unknowns;
    j["samples"] = f.samples;
    j["condition"] = f.condition;
    j["used_fallback"] = f.used_fallback;
    j["termination"] = f.termination;
    j["folded_patches"] = f.folded_patches;
    const auto worst = std::min_element(f.smallest_jacobians.begin(), f.smallest_jacobians.end());
    if (worst != f.smallest_jacobians.end())
        j["smallest_jacobian"] = {{"value", *worst},
                                  {"patch", worst - f.smallest_jacobians.begin()}};
    return j;
}

namespace {

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

} // namespace

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

namespace {

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
                               {"exceeding", r.exceeding},
                               {"beyond", r.beyond},
                               {"folded", r.folded},
                               {"seconds", r.seconds}});
    return j;
}

} // namespace

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

std::string text_of(const Json& j)
{
    return j.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace bot2nurbs
