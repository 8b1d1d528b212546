// SPDX-License-Identifier: MIT
#include "summary.h"

#include <fmt/format.h>

namespace bot2nurbs::cli {

namespace {

std::string size_text(std::uint64_t bytes)
{
    if (bytes < 1000)
        return fmt::format("{} bytes", bytes);
    if (bytes < 1000000)
        return fmt::format("{:.0f} kB", static_cast<double>(bytes) / 1e3);
    return fmt::format("{:.1f} MB", static_cast<double>(bytes) / 1e6);
}

const char* yes_no(bool value)
{
    return value ? "yes" : "no";
}

std::string plural(std::size_t count, const char* one, const char* many)
{
    return fmt::format("{} {}", count, count == 1 ? one : many);
}

//! "valence 3: 12, 5: 4": all but the regular four.
std::string valence_text(const DomainReport& domain)
{
    std::string text;
    for (std::size_t v = 0; v < domain.valences.size(); ++v)
        if (v != 4 && domain.valences[v] > 0)
            text += fmt::format("{}{}: {}", text.empty() ? "" : ", ", v, domain.valences[v]);
    return text;
}

std::string verdict(const std::optional<Error>& rejection)
{
    return rejection ? fmt::format("verdict: rejected ({}): {}", name(rejection->code),
                                   rejection->message)
                     : std::string("verdict: accepted");
}

std::string error_text(const Deviation& d, double diagonal, const std::string& unit)
{
    const double percent = diagonal > 0.0 ? 100.0 / diagonal : 0.0;
    return fmt::format("rms {:.3g} %, max {:.3g} % of the diagonal (rms {:.3g} {}, max {:.3g} {})",
                       percent * d.rms(), percent * d.max(), d.rms(), unit, d.max(), unit);
}

std::string bound_text(const HausdorffBound& b, double diagonal, const std::string& unit)
{
    const double percent = diagonal > 0.0 ? 100.0 / diagonal : 0.0;
    return fmt::format("no place of either is farther than {:.3g} % from the other ({:.3g} {}), "
                       "one is farther than {:.3g} %",
                       percent * b.upper(), b.upper(), unit, percent * b.lower());
}

std::vector<std::string> component_lines(const ComponentOutcome& c, const std::string& unit)
{
    std::vector<std::string> lines;
    const std::string valences = valence_text(c.domain);
    lines.push_back(fmt::format(
        "surface   {}, genus {}, {}{}", plural(c.domain.faces, "patch", "patches"), c.genus,
        plural(c.domain.extraordinary, "extraordinary vertex", "extraordinary vertices"),
        valences.empty() ? "" : " (valence " + valences + ")"));
    if (c.brep_faces == 0)
        return lines;
    lines.push_back("error     " + error_text(c.deviation, c.diagonal, unit));
    if (c.bound)
        lines.push_back("bound     " + bound_text(*c.bound, c.diagonal, unit));
    if (c.tolerance)
        lines.push_back(fmt::format("tolerance {:.4g} {} {}: proven to be within {:.4g} {} "
                                    "({} rounds)",
                                    c.tolerance->tolerance, unit,
                                    c.tolerance->met ? "met" : "not met",
                                    c.tolerance->distance.upper, unit, c.tolerance->rounds.size()));
    lines.push_back(fmt::format("joins     largest gap {:.2g} {}, largest angle between normals "
                                "{:.2g} degrees",
                                c.continuity.max_gap, unit, c.continuity.max_g1_angle_deg));
    lines.push_back(
        fmt::format("solid     {} (valid: {})", yes_no(c.brep.solid), yes_no(c.brep.valid)));
    return lines;
}

std::vector<std::string> cloud_lines(const CloudReport& r, double diagonal, const std::string& unit)
{
    const double percent = diagonal > 0.0 ? 100.0 / diagonal : 0.0;
    return {fmt::format("points    {}, spacing {:.3g} %, noise {:.2g} % of the diagonal ({:.2g} "
                        "{}), normals {}",
                        r.points, percent * r.spacing, percent * r.noise, r.noise, unit,
                        r.normals.given ? "of the file" : "estimated"),
            fmt::format("topology  {}, {:.3g} % of the closed surface without points",
                        name(r.topology), 100.0 * r.evidence.uncovered_area)};
}

} // namespace

std::vector<std::string> summarise(const ConvertReport& report)
{
    std::vector<std::string> lines;
    if (report.cloud)
        lines = cloud_lines(*report.cloud, report.diagonal, report.units);
    for (const RepairNote& note : report.repairs)
        lines.push_back("repaired  " + note.message);
    for (std::size_t c = 0; c < report.components.size(); ++c) {
        if (report.components.size() > 1)
            lines.push_back(fmt::format("component {} of {}", c + 1, report.components.size()));
        for (std::string& line : component_lines(report.components[c], report.units))
            lines.push_back(std::move(line));
    }
    if (report.cloud && report.cloud->deviation.points > 0) {
        const PointDeviation& d = report.cloud->deviation;
        const double percent = report.diagonal > 0.0 ? 100.0 / report.diagonal : 0.0;
        lines.push_back(fmt::format("to points rms {:.3g} %, 95 % within {:.3g} %, max {:.3g} %, "
                                    "{} of {} farther than three deviations",
                                    percent * d.rms, percent * d.percentile_95, percent * d.max,
                                    d.far_points, d.points));
    }
    for (const OutputFile& output : report.outputs)
        lines.push_back(fmt::format("written   {} ({})", output.path, size_text(output.bytes)));
    return lines;
}

std::vector<std::string> stage_lines(const std::vector<StageRecord>& stages)
{
    std::vector<std::string> lines;
    for (const StageRecord& s : stages)
        lines.push_back(
            fmt::format("{:<16} {:8.3f} s {:8.0f} MiB", s.name, s.seconds, s.peak_rss_mib));
    return lines;
}

std::vector<std::string> describe(const ConvertOptions& options, const InputReport& report)
{
    const MeshReport& m = report.mesh;
    std::vector<std::string> lines;
    lines.push_back(fmt::format("{}: {}, {}, {}", options.input,
                                plural(m.vertices, "vertex", "vertices"),
                                plural(m.faces, "triangle", "triangles"),
                                plural(m.components.size(), "component", "components")));
    lines.push_back(fmt::format("closed: {}, manifold: {}, orientable: {}, oriented: {}",
                                yes_no(m.closed), yes_no(m.manifold), yes_no(m.orientable),
                                yes_no(m.oriented)));
    for (std::size_t i = 0; i < m.components.size(); ++i) {
        const ComponentReport& c = m.components[i];
        lines.push_back(fmt::format("component {}: {}, genus {}{}, {}", i + 1,
                                    plural(c.faces, "triangle", "triangles"), c.genus,
                                    c.orientable ? "" : " (not orientable)",
                                    plural(c.boundary_loops, "boundary loop", "boundary loops")));
    }
    if (report.cloud) {
        const CloudReport& r = *report.cloud;
        lines.push_back(fmt::format("mesh made of {}: spacing {:.4g}, noise {:.3g}, topology {}",
                                    plural(r.points, "point", "points"), r.spacing, r.noise,
                                    name(r.topology)));
        for (const std::string& doubt : r.evidence.doubts)
            lines.push_back("doubt: " + doubt);
    }
    if (m.sharp_edges > 0)
        lines.push_back(
            fmt::format("{} of more than 40 degrees", plural(m.sharp_edges, "edge", "edges")));
    for (const MeshDefect& d : m.defects)
        lines.push_back(fmt::format("defect {}: {}", d.code, d.message));
    for (const RepairNote& note : report.repairs)
        lines.push_back(
            fmt::format("{} {}: {}", note.warning ? "note" : "repair", note.code, note.message));
    lines.push_back(verdict(report.rejection));
    return lines;
}

std::vector<std::string> describe(const DomainFileReport& report)
{
    std::vector<std::string> lines;
    for (std::size_t i = 0; i < report.components.size(); ++i) {
        const DomainValidation& c = report.components[i];
        lines.push_back(fmt::format(
            "component {}: {}, {}, {}, Euler characteristic {}, {} (largest valence {})", i + 1,
            plural(c.quads, "quad", "quads"), plural(c.edges, "edge", "edges"),
            plural(c.vertices, "vertex", "vertices"), c.euler_characteristic,
            plural(c.extraordinary, "extraordinary vertex", "extraordinary vertices"),
            c.max_valence));
        if (c.charts.max_stretch > 0.0)
            lines.push_back(fmt::format("  charts: stretch {:.3g} on average, {:.3g} at most (quad "
                                        "{}); Jacobian {:.3g} to {:.3g} of the quad's mean",
                                        c.charts.mean_stretch, c.charts.max_stretch,
                                        c.charts.worst_quad, c.charts.min_jacobian,
                                        c.charts.max_jacobian));
        for (const DomainDefect& d : c.defects)
            lines.push_back(fmt::format("  defect {}: {}", d.rule, d.message));
        if (c.defect_count > c.defects.size())
            lines.push_back(
                fmt::format("  and {} more defects", c.defect_count - c.defects.size()));
    }
    lines.push_back(verdict(report.rejection));
    return lines;
}

} // namespace bot2nurbs::cli
