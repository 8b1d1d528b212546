// SPDX-License-Identifier: MIT
#include "bot2nurbs/version.h"
#include "convert/cloud_json.h"
#include "convert/report_parts.h"

namespace bot2nurbs {

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

} // namespace bot2nurbs
