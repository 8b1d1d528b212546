// SPDX-License-Identifier: MIT
#include "bot2nurbs/convert.h"

#include "bot2nurbs/domain_file.h"
#include "convert/cage_input.h"
#include "convert/check_layout.h"
#include "convert/component.h"
#include "convert/constraints_input.h"
#include "convert/domain_input.h"
#include "convert/input.h"
#include "convert/quads_input.h"
#include "convert/surface_to_points.h"
#include "convert/tessellation.h"
#include "io/atomic_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <utility>

#include <unistd.h>

namespace bot2nurbs {

namespace {

namespace fs = std::filesystem;

// The cube has six faces; a closed domain of inner valences of at least three cannot have fewer
// unless it winds round a handle.
constexpr Index fewest_patches = 6;

enum class Format { archive_3dm, step, occ_brep };

std::optional<Format> format_of(const std::string& path)
{
    std::string extension = fs::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (extension == ".3dm")
        return Format::archive_3dm;
    if (extension == ".step" || extension == ".stp")
        return Format::step;
    if (extension == ".brep")
        return Format::occ_brep;
    return std::nullopt;
}

const char* name_of(Format format)
{
    switch (format) {
    case Format::archive_3dm: return "3dm";
    case Format::step: return "step";
    case Format::occ_brep: return "brep";
    }
    return "";
}

//! The knots a format gets: those asked for, or what its readers take best.
KnotForm form_of(Format format, const ConvertOptions& options)
{
    if (options.knots)
        return *options.knots;
    if (format == Format::archive_3dm || options.spline == SplineScheme::eck_hoppe)
        return KnotForm::paper;
    return KnotForm::c1;
}

//! The path of one component's file.
std::string part_path(const std::string& path, std::size_t number)
{
    fs::path part(path);
    part.replace_filename(part.stem().string() + fmt::format("-{}", number) +
                          part.extension().string());
    return part.string();
}

Status check_folder(const std::string& path)
{
    const fs::path folder =
        fs::path(path).has_parent_path() ? fs::path(path).parent_path() : fs::path(".");
    std::error_code failed;
    if (!fs::is_directory(folder, failed))
        return Error{ErrorCode::cannot_write,
                     fmt::format("cannot write {}: there is no folder {}", path, folder.string()),
                     invalid_index};
    if (fs::is_directory(path, failed))
        return Error{ErrorCode::cannot_write, fmt::format("cannot write {}: it is a folder", path),
                     invalid_index};
    // A device (/dev/stdout) is written in place and needs no folder that can be written.
    const bool device = fs::exists(path, failed) && !fs::is_regular_file(path, failed);
    if (!device && ::access(folder.c_str(), W_OK | X_OK) != 0)
        return Error{
            ErrorCode::cannot_write,
            fmt::format("cannot write {}: no permission to write in {}", path, folder.string()),
            invalid_index};
    return {};
}

Error bad_option(std::string message)
{
    return {ErrorCode::bad_option, std::move(message), invalid_index};
}

void add_input_warnings(const PreparedInput& input, ConvertReport& report)
{
    if (input.cloud) {
        report.cloud = input.cloud->report;
        report.repairs = input.cloud->notes;
        for (Warning& warning : cloud_warnings(input.cloud->report))
            report.warnings.push_back(std::move(warning));
    }
    for (const RepairNote& note : input.mesh.notes) {
        if (note.warning)
            report.warnings.push_back({note.code, note.message, invalid_index});
        else
            report.repairs.push_back(note);
    }
    if (input.found.self_intersecting_pairs > 0) {
        const auto& [f, g] = input.found.self_intersections.front();
        report.warnings.push_back(
            {"self_intersection",
             fmt::format("{} pairs of faces cross each other (first: faces {} and {}): the result "
                         "may cross itself there too. --strict rejects such input",
                         input.found.self_intersecting_pairs, f, g),
             f});
    }
    for (std::size_t c = 0; c < input.mesh.components.size(); ++c)
        if (input.mesh.components[c].cavity)
            report.warnings.push_back(
                {"cavity",
                 fmt::format("component {} is the wall of a hollow in component {}: it is written "
                             "as a solid of its own",
                             c + 1, input.mesh.components[c].surrounded_by + 1),
                 input.mesh.components[c].source_face.front()});
}

//! Why refinement ended, for a sentence.
const char* reason(RefinementEnd end)
{
    switch (end) {
    case RefinementEnd::tolerance_met: return "rounding of the coordinates is more";
    case RefinementEnd::patch_limit: return "it takes more patches than --max-patches allows";
    case RefinementEnd::noise_limit: return "the points are no farther away than their noise";
    case RefinementEnd::stalled: return "more patches did not bring the surface nearer";
    case RefinementEnd::quality_limit: return "a patch could not be cut any further";
    }
    return "";
}

//! Warns of a tolerance that the noise of the points alone exceeds.
void warn_of_noise(const CloudReport& cloud, double tolerance, ConvertReport& report)
{
    const double reach = noise_reach(cloud.noise, cloud.fitted);
    if (tolerance >= reach)
        return;
    report.warnings.push_back(
        {"tolerance_below_noise",
         fmt::format("the tolerance of {:.4g} {} is less than the noise of the points, whose "
                     "deviation of {:.4g} puts some of them up to {:.4g} away from the body: no "
                     "patches are added to follow it",
                     tolerance, report.units, cloud.noise, reach),
         invalid_index});
}

//! A warning for each component that is not within the tolerance.
void add_tolerance_warnings(ConvertReport& report)
{
    for (std::size_t c = 0; c < report.components.size(); ++c) {
        const std::optional<ToleranceReport>& t = report.components[c].tolerance;
        if (!t || t->met)
            continue;
        const Vec3& p = t->worst.point;
        report.warnings.push_back(
            {"tolerance_not_met",
             fmt::format("{}the tolerance of {:.4g} {} is not met: {}. The surface is between "
                         "{:.4g} and {:.4g} {} away, most at patch {} near ({:.6g}, {:.6g}, "
                         "{:.6g})",
                         report.components.size() > 1 ? fmt::format("component {}: ", c + 1) : "",
                         t->tolerance, report.units, reason(t->termination), t->distance.lower,
                         t->distance.upper, report.units, t->worst.surface.quad, p.x, p.y, p.z),
             t->worst.surface.quad});
    }
}

//! Warnings about what became of the shape: open surfaces, creases that were rounded.
void add_outcome_warnings(const ConvertOptions& options, ConvertReport& report)
{
    Index loops = 0, open = 0, smoothed = 0, vertex = invalid_index;
    for (const ComponentOutcome& c : report.components) {
        loops += c.boundary_loops;
        open += c.boundary_loops > 0;
        smoothed += static_cast<Index>(c.features.smoothed.size());
        if (vertex == invalid_index && !c.features.smoothed.empty())
            vertex = c.features.smoothed[0][0];
    }
    if (open > 0 && options.closure == Closure::as_input)
        report.warnings.push_back(
            {"open",
             fmt::format(
                 "{} of {} components are open, with {} boundary loops in all: the result is "
                 "no solid there. --open accepts this, --solid refuses it",
                 open, report.components.size(), loops),
             invalid_index});
    if (smoothed > 0)
        report.warnings.push_back(
            {"sharp_edges",
             fmt::format(
                 "{} edges turn by {:g} degrees or more but are rounded, not kept (first: at "
                 "vertex {}). {}",
                 smoothed, options.feature_options.angle, vertex,
                 options.features == FeatureMode::all
                     ? "They are too short or too rough to be creases"
                     : "--features DEGREES keeps creases of that angle"),
             vertex});
}

//! Of all components together.
void add_point_deviation(const std::vector<ConvertedComponent>& components, double diagonal,
                         std::optional<double> tolerance, CloudReport& cloud)
{
    std::vector<double> distances;
    for (const ConvertedComponent& c : components) {
        distances.insert(distances.end(), c.point_distances.begin(), c.point_distances.end());
        cloud.anchors += c.anchors;
    }
    cloud.deviation = summarise_distances(distances, expected_deviation(cloud));
    std::vector<double> limits{1e-3 * diagonal, 3e-3 * diagonal, 1e-2 * diagonal};
    if (tolerance)
        limits.insert(std::upper_bound(limits.begin(), limits.end(), *tolerance), *tolerance);
    for (const double limit : limits)
        cloud.within.push_back(
            {limit, diagonal > 0.0 ? limit / diagonal : 0.0, share_within(distances, limit)});
}

//! The other way: of the surface from the points.
Status add_surface_deviation(const std::vector<ConvertedComponent>& components,
                             const CloudInput& input, CloudReport& cloud, Context& context)
{
    std::vector<const SplineSurface*> surfaces;
    for (const ConvertedComponent& c : components)
        if (c.surface.patch_count() > 0)
            surfaces.push_back(&c.surface);
    if (surfaces.empty() || input.points.empty())
        return std::nullopt;
    const Result<SurfaceToPoints> measured =
        measure_surface_to_points(surfaces, input.points, coverage_reach(cloud), context);
    if (!measured)
        return measured.error();
    cloud.surface_to_points = *measured;
    return std::nullopt;
}

Result<std::string> to_bytes(Format format, const std::vector<Brep>& breps,
                             const WriteOptions& options)
{
    switch (format) {
    case Format::archive_3dm: return brep_to_3dm(breps, options);
    case Format::step: return brep_to_step(breps, options);
    case Format::occ_brep: break;
    }
    return brep_to_occ_brep(breps, options);
}

struct PendingFile {
    OutputFile file;
    std::string bytes;
};

//! The bytes of every file asked for.
Result<std::vector<PendingFile>> make_files(const ConvertOptions& options, const std::string& units,
                                            const RepairedMesh& mesh,
                                            const std::vector<KnotForm>& forms,
                                            std::vector<ConvertedComponent>& components,
                                            Context& context)
{
    std::vector<PendingFile> files;
    WriteOptions write = options.write;
    write.units = units;
    write.title = fs::path(options.input).stem().string();
    const auto add = [&](const std::string& path, const char* format, std::string bytes) {
        files.push_back({{path, format, bytes.size()}, std::move(bytes)});
    };
    for (const std::string& path : options.outputs) {
        if (context.cancelled())
            return Context::cancelled_error("write");
        const Format format = *format_of(path);
        const std::size_t form = static_cast<std::size_t>(
            std::find(forms.begin(), forms.end(), form_of(format, options)) - forms.begin());
        const bool split = options.components == ComponentMode::split;
        std::vector<Brep> breps;
        for (std::size_t c = 0; c < components.size(); ++c) {
            breps.push_back(components[c].breps[form]);
            breps.back().name =
                write.title + (components.size() > 1 ? "-" + std::to_string(c + 1) : "");
            if (!split && c + 1 < components.size())
                continue;
            Result<std::string> bytes = to_bytes(format, breps, write);
            if (!bytes)
                return bytes.error();
            add(split ? part_path(path, c + 1) : path, name_of(format), std::move(*bytes));
            breps.clear();
        }
    }
    if (options.tessellation) {
        std::vector<TessellationPart> parts;
        for (std::size_t c = 0; c < components.size(); ++c)
            parts.push_back(
                {&mesh.components[c].mesh, &components[c].domain.complex, &components[c].surface});
        Result<std::string> bytes = tessellation_to_ply(parts, context);
        if (!bytes)
            return bytes.error();
        add(*options.tessellation, "ply", std::move(*bytes));
    }
    if (options.constraints_out) {
        std::vector<DomainConstraints> constraints;
        for (ConvertedComponent& c : components)
            constraints.push_back(std::move(c.constraints));
        add(*options.constraints_out, "constraints", constraint_list_to_json(constraints));
    }
    if (options.domain_out) {
        std::vector<QuadDomain> domains;
        for (ConvertedComponent& c : components)
            domains.push_back(std::move(c.domain));
        add(*options.domain_out, "domain", domains_to_json(domains));
    }
    return files;
}

} // namespace

std::optional<Error> ConvertOptions::check() const
{
    if (input.empty())
        return bad_option("no input file is named");
    if (outputs.empty() && !domain_out && !constraints_out && !tessellation)
        return bad_option("no output file is named");
    for (const std::string& path : outputs) {
        const std::optional<Format> format = format_of(path);
        if (!format)
            return bad_option(fmt::format("the output {} has no known extension: use .3dm, .step, "
                                          ".stp or .brep",
                                          path));
        if (form_of(*format, *this) == KnotForm::c1 && spline == SplineScheme::eck_hoppe)
            return bad_option("the eck-hoppe spline has no form with C1 knots: use --knots paper");
    }
    if (patches && *patches < fewest_patches)
        return bad_option(
            fmt::format("--patches {} is too few: at least {}", *patches, fewest_patches));
    if (tolerance && !(tolerance->value > 0.0 && std::isfinite(tolerance->value)))
        return bad_option("--tolerance must be a positive length or percentage");
    if (max_patches && !tolerance)
        return bad_option("--max-patches limits what --tolerance may use: it needs one");
    if (max_patches && *max_patches < patches.value_or(fewest_patches))
        return bad_option(fmt::format("--max-patches {} is too few: at least {}", *max_patches,
                                      patches.value_or(fewest_patches)));
    if (std::optional<Error> failed = check_layout(*this))
        return failed;
    if (fill_holes && !(fill_holes->value >= 0.0 && std::isfinite(fill_holes->value)))
        return bad_option("the size of holes to fill must be a length that is not negative");
    if (weld && !(weld->value >= 0.0 && std::isfinite(weld->value)))
        return bad_option("--weld must be a length or percentage that is not negative");
    if (std::optional<Error> failed = fit.check())
        return failed;
    if (std::optional<Error> failed = feature_options.check())
        return failed;
    if (std::optional<Error> failed = cloud.orient.check())
        return failed;
    if (std::optional<Error> failed = cloud.reconstruct.check())
        return failed;
    if (Status failed = write.check())
        return failed;

    std::vector<std::string> paths = outputs;
    if (domain_out)
        paths.push_back(*domain_out);
    if (constraints_out)
        paths.push_back(*constraints_out);
    if (tessellation)
        paths.push_back(*tessellation);
    for (std::size_t i = 0; i < paths.size(); ++i) {
        if (std::find(paths.begin(), paths.begin() + static_cast<std::ptrdiff_t>(i), paths[i]) !=
            paths.begin() + static_cast<std::ptrdiff_t>(i))
            return bad_option(fmt::format("{} is to be written twice", paths[i]));
        for (const auto& read :
             {std::optional<std::string>(input), domain_in, quads, constraints}) {
            std::error_code unknown;
            if (read && fs::equivalent(paths[i], *read, unknown))
                return bad_option(fmt::format("{} is read: it would be overwritten", paths[i]));
        }
        if (Status failed = check_folder(paths[i]))
            return failed;
    }
    return std::nullopt;
}

Result<ConvertReport> convert(const ConvertOptions& options, Context& context)
{
    if (const std::optional<Error> failed = options.check())
        return *failed;
    std::vector<QuadDomain> supplied;
    const Result<PreparedInput> input = [&]() -> Result<PreparedInput> {
        if (!options.cage)
            return prepare_input(options, context);
        Result<PreparedCage> cage = prepare_cage(options, context);
        if (!cage)
            return cage.error();
        supplied = std::move(cage->domains);
        return std::move(cage->input);
    }();
    if (!input)
        return input.error();
    const RepairedMesh& mesh = input->mesh;

    ConvertReport report;
    report.input_vertices = input->vertices;
    report.input_faces = input->faces;
    report.units = !options.write.units.empty() ? options.write.units
                   : !input->units.empty()      ? input->units
                                                : "mm";
    report.diagonal = mesh.box.diagonal();
    add_input_warnings(*input, report);

    if (options.domain_in) {
        Result<std::vector<QuadDomain>> domains = valid_domains(*options.domain_in, mesh, context);
        if (!domains)
            return domains.error();
        supplied = std::move(*domains);
    }

    std::vector<QuadMesh> quads;
    if (options.quads) {
        context.begin_stage("read quads");
        Result<std::vector<QuadMesh>> read = quads_of_components(*options.quads, mesh, context);
        if (!read)
            return read.error();
        quads = std::move(*read);
    }

    std::vector<DomainConstraints> constraints(mesh.components.size());
    if (options.constraints) {
        Result<std::vector<DomainConstraints>> read = read_constraints(*options.constraints, mesh);
        if (!read)
            return read.error();
        constraints = std::move(*read);
    }

    // The knot forms that the outputs need, each made once.
    std::vector<KnotForm> forms;
    for (const std::string& path : options.outputs) {
        const KnotForm form = form_of(*format_of(path), options);
        if (std::find(forms.begin(), forms.end(), form) == forms.end())
            forms.push_back(form);
    }
    if (forms.empty() && options.tessellation)
        forms.push_back(form_of(Format::archive_3dm, options));

    std::vector<PointData> points;
    if (input->cloud) {
        Result<std::vector<PointData>> shared =
            points_of_components(*input->cloud, mesh, report.cloud->off_mesh, context);
        if (!shared)
            return shared.error();
        report.cloud->fitted -= report.cloud->off_mesh;
        points = std::move(*shared);
        if (options.tolerance)
            warn_of_noise(*report.cloud, options.tolerance->of(report.diagonal), report);
    }

    std::vector<ConvertedComponent> components;
    const std::size_t count = mesh.components.size();
    for (std::size_t c = 0; c < count; ++c) {
        DomainWishes wishes;
        if (!supplied.empty())
            wishes.supplied = std::move(supplied[c]);
        if (options.quads)
            wishes.quads = std::move(quads[c]);
        wishes.constraints = std::move(constraints[c]);
        const std::string suffix = count > 1 ? fmt::format(" {}/{}", c + 1, count) : "";
        if (options.tolerance)
            wishes.tolerance = options.tolerance->of(report.diagonal);
        Result<ConvertedComponent> converted =
            convert_component(mesh.components[c], std::move(wishes),
                              input->cloud ? &points[c] : nullptr, options, forms, suffix, context);
        if (!converted) {
            Error error = converted.error();
            if (count > 1 && error.code != ErrorCode::cancelled)
                error.message = fmt::format("component {} of {}: {}", c + 1, count, error.message);
            return error;
        }
        components.push_back(std::move(*converted));
    }

    if (report.cloud) {
        context.begin_stage("points");
        add_point_deviation(components, report.diagonal,
                            options.tolerance
                                ? std::optional(options.tolerance->of(report.diagonal))
                                : std::nullopt,
                            *report.cloud);
        if (Status failed =
                add_surface_deviation(components, *input->cloud, *report.cloud, context))
            return *failed;
    }

    context.begin_stage("write");
    Result<std::vector<PendingFile>> files =
        make_files(options, report.units, mesh, forms, components, context);
    if (!files)
        return files.error();
    for (const ConvertedComponent& c : components)
        report.components.push_back(c.outcome);
    add_outcome_warnings(options, report);
    add_tolerance_warnings(report);
    add_detour_warnings(report);
    if (context.cancelled())
        return Context::cancelled_error("write");
    for (const PendingFile& pending : *files) {
        if (Status failed = write_whole_file(pending.file.path, pending.bytes))
            return *failed;
        report.outputs.push_back(pending.file);
    }
    context.end_stage();
    report.stages = context.stages();
    return report;
}

} // namespace bot2nurbs
