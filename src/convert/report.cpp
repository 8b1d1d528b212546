// SPDX-License-Identifier: MIT
#include "bot2nurbs/report.h"

#include "bot2nurbs/version.h"
#include "convert/cloud_json.h"
#include "convert/report_parts.h"
#include "io/atomic_file.h"

#include <algorithm>
#include <cmath>

namespace bot2nurbs {

namespace {

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

//! Sizes and folds of all; rounds, condition and termination those of the component with most
//! rounds.
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
        sum.folded_patches += c.fit.folded_patches;
        sum.smallest_jacobians.insert(sum.smallest_jacobians.end(),
                                      c.fit.smallest_jacobians.begin(),
                                      c.fit.smallest_jacobians.end());
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

Status write_report(const std::string& json, const std::string& path)
{
    return write_whole_file(path, json);
}

} // namespace bot2nurbs
