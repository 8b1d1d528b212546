// SPDX-License-Identifier: MIT
#include "command.h"

#include "bot2nurbs/version.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <map>
#include <optional>
#include <vector>

namespace bot2nurbs::cli {

namespace {

// openNURBS writes versions 5 to 8 of its archives as 50 to 80.
const std::map<std::string, int> archive_versions{{"4", 4},   {"5", 50},  {"6", 60},
                                                  {"7", 70},  {"8", 80},  {"50", 50},
                                                  {"60", 60}, {"70", 70}, {"80", 80}};
const std::map<std::string, KnotForm> knot_forms{{"paper", KnotForm::paper}, {"c1", KnotForm::c1}};
const std::map<std::string, SplineScheme> schemes{{"peters", SplineScheme::peters},
                                                  {"full", SplineScheme::full},
                                                  {"eck-hoppe", SplineScheme::eck_hoppe}};
const std::map<std::string, StepSchema> step_schemas{{"AP242", StepSchema::ap242},
                                                     {"AP214", StepSchema::ap214}};

// What CLI11 asks for before it says which value is wrong.
const char* const footer =
    R"(Examples:
  bot2nurbs bunny.off bunny.3dm
  bot2nurbs kitten.obj kitten.step kitten.3dm --patches 200 --json report.json
  bot2nurbs kitten.obj kitten.step --tolerance 0.1%
  bot2nurbs --check scan.stl

Exit codes:
  0 done                    4 cannot write
  1 internal error          5 input rejected
  2 wrong use               6 a stage failed
  3 cannot read             7 written, but the tolerance is not met
                          130 interrupted)";

const std::map<std::string, ReconstructionMethod> reconstruction_methods{
    {"poisson", ReconstructionMethod::poisson},
    {"ball-pivoting", ReconstructionMethod::ball_pivoting}};
const std::map<std::string, NormalMode> normal_modes{{"auto", NormalMode::automatic},
                                                     {"given", NormalMode::given},
                                                     {"estimate", NormalMode::estimate}};

template <class T> CLI::Option* add_choice(CLI::App& app, const std::string& name, T& value,
                                           const std::map<std::string, T>& choices,
                                           const std::string& text)
{
    std::vector<std::string> names;
    for (const auto& choice : choices)
        names.push_back(choice.first);
    return app
        .add_option_function<std::string>(
            name, [&value, &choices](const std::string& chosen) { value = choices.at(chosen); },
            text)
        ->check(CLI::IsMember(names));
}

const std::map<std::string, ComponentMode> component_modes{{"all", ComponentMode::all},
                                                           {"largest", ComponentMode::largest},
                                                           {"split", ComponentMode::split}};

// Nothing for what is neither a length nor a percentage.
std::optional<Length> parse_length(std::string text)
{
    Length length;
    if (!text.empty() && text.back() == '%') {
        length.relative = true;
        text.pop_back();
    }
    if (!CLI::detail::lexical_cast(text, length.value))
        return std::nullopt;
    if (length.relative)
        length.value /= 100.0;
    return length;
}

// Reads an option's length into `length`. False, and says so, for what is none or negative.
bool read_length(const char* option, const std::string& text, std::optional<Length>& length)
{
    length = parse_length(text);
    if (length && length->value >= 0.0)
        return true;
    std::fprintf(stderr, "bot2nurbs: %s %s is neither a length nor a percentage\n", option,
                 text.c_str());
    return false;
}

// False for what is neither a word nor an angle.
bool parse_features(const std::string& text, ConvertOptions& options)
{
    if (text == "auto" || text == "off") {
        options.features = text == "auto" ? FeatureMode::automatic : FeatureMode::off;
        return true;
    }
    double angle = 0.0;
    if (!CLI::detail::lexical_cast(text, angle))
        return false;
    options.features = FeatureMode::all;
    options.feature_options.angle = angle;
    return !options.feature_options.check();
}

// Three finite numbers separated by commas, or nothing.
std::optional<Vec3> parse_point(const std::string& text)
{
    const std::vector<std::string> words = CLI::detail::split(text, ',');
    Vec3 p;
    if (words.size() != 3)
        return std::nullopt;
    for (int k = 0; k < 3; ++k)
        if (!CLI::detail::lexical_cast(words[static_cast<std::size_t>(k)], p[k]))
            return std::nullopt;
    return is_finite(p) ? std::optional(p) : std::nullopt;
}

// False for an unknown kind of layout.
bool parse_layout(const std::string& text, ConvertOptions& options)
{
    const std::string quads = "quads=";
    if (text.compare(0, quads.size(), quads) != 0)
        return text == "eck";
    options.quads = text.substr(quads.size());
    return !options.quads->empty();
}

} // namespace

std::variant<Command, int> parse_command(int argc, char** argv)
{
    Command command;
    ConvertOptions& o = command.options;
    CLI::App app("Turns a triangle mesh or a cloud of points into a watertight B-Rep of bicubic "
                 "B-spline patches with exact "
                 "G1 joins.",
                 "bot2nurbs");
    app.footer(footer);
    app.set_version_flag("--version", "bot2nurbs " BOT2NURBS_VERSION);

    app.add_option("INPUT", o.input,
                   "Mesh: .stl .obj .ply .off. Points: .ply .obj .off without faces, .xyz "
                   ".pts .txt .csv .pwn .pcd .las")
        ->required();
    app.add_option("OUTPUT", o.outputs, "One or more of .3dm .step .stp .brep");

    const std::string surface = "Surface";
    unsigned patches = 0;
    CLI::Option* patches_option =
        app.add_option("--patches", patches,
                       "Wanted number of patches per component (default: from the shape)")
            ->type_name("N")
            ->group(surface);
    std::string tolerance;
    CLI::Option* tolerance_option =
        app.add_option("--tolerance", tolerance,
                       "Refine until INPUT and surface are proven to be this near each other, or "
                       "all points this near the surface: a length in units of INPUT, or a "
                       "percentage of its diagonal")
            ->type_name("0.05|0.1%")
            ->group(surface);
    unsigned max_patches = 0;
    CLI::Option* max_patches_option =
        app.add_option("--max-patches", max_patches,
                       "Most patches per component that --tolerance may use (default: 5000)")
            ->type_name("N")
            ->group(surface);
    std::string layout = "eck";
    app.add_option("--layout", layout,
                   "Automatic patches, or the quads of a mesh FILE (.obj .ply .off) near INPUT")
        ->type_name("eck|quads=FILE")
        ->capture_default_str()
        ->group(surface);
    app.add_flag("--cage", o.cage,
                 "INPUT is a mesh of quads: convert its Catmull-Clark surface, a patch a quad")
        ->group(surface);
    KnotForm knots = KnotForm::paper;
    CLI::Option* knots_option =
        add_choice(app, "--knots", knots, knot_forms,
                   "Knots to write (default: paper in .3dm, c1 in the others)")
            ->type_name("paper|c1")
            ->group(surface);
    add_choice(app, "--spline", o.spline, schemes, "Spline scheme (default: peters)")
        ->type_name("peters|full|eck-hoppe")
        ->group(surface);
    app.add_option("--rounds", o.fit.max_rounds, "Most rounds of fitting")
        ->type_name("N")
        ->capture_default_str()
        ->group(surface);
    app.add_flag("--robust", o.fit.robust, "Let outliers count less")->group(surface);

    std::string features = "auto";
    app.add_option("--features", features,
                   "Which sharp edges stay sharp: auto, off, or all creases of at least DEGREES")
        ->type_name("auto|off|DEGREES")
        ->capture_default_str()
        ->group(surface);

    const std::string input = "Input";
    CLI::Option* open =
        app.add_flag("--open", "Open meshes become open surfaces, without a warning")->group(input);
    CLI::Option* solid =
        app.add_flag("--solid", "Reject open meshes")->excludes(open)->group(input);
    std::string weld;
    CLI::Option* weld_option =
        app.add_option("--weld", weld,
                       "Join corners of open edges up to so far apart: a length in units of INPUT, "
                       "or a percentage of its diagonal (default: only copies)")
            ->type_name("0.01|0.001%")
            ->group(input);
    std::string fill_holes;
    CLI::Option* fill_holes_option =
        app.add_option("--fill-holes", fill_holes,
                       "Fill holes up to this size across: a length in units of INPUT, or a "
                       "percentage of its diagonal (default: of a mesh none, among points such "
                       "gaps as chance leaves)")
            ->type_name("0.5|2%")
            ->group(input);
    add_choice(app, "--components", o.components, component_modes,
               "Convert all components, or only the largest, or split them into files of their own "
               "(default: all)")
        ->type_name("all|largest|split")
        ->group(input);
    CLI::Option* check =
        app.add_flag("--check", "Report the defects of INPUT and convert nothing")->group(input);
    app.add_flag("--strict", o.strict, "Reject input that crosses itself")->group(input);
    bool no_repair = false;
    app.add_flag("--no-repair", no_repair, "Reject input that needs a repair")->group(input);

    const std::string cloud = "Input of points";
    app.add_flag("--points", o.cloud.points, "Take the points of a mesh and pass over its faces")
        ->group(cloud);
    add_choice(
        app, "--reconstruction", o.cloud.reconstruct.method, reconstruction_methods,
        "Mesh through the points: poisson closes gaps and smooths noise, ball-pivoting keeps "
        "to where the points are (default: poisson)")
        ->type_name("poisson|ball-pivoting")
        ->group(cloud);
    add_choice(app, "--normals", o.cloud.normals, normal_modes,
               "Whose normals: those of the file if they agree, of the file, or none of the file "
               "(default: auto)")
        ->type_name("auto|given|estimate")
        ->group(cloud);
    std::string viewpoint;
    CLI::Option* viewpoint_option =
        app.add_option("--viewpoint", viewpoint, "Where the scanner stood: normals turn to it")
            ->type_name("X,Y,Z")
            ->group(cloud);
    int depth = 0;
    CLI::Option* depth_option =
        app.add_option("--depth", depth,
                       "Finest level of the octree that the mesh is made on, 3 to 12 (default: "
                       "from density and noise)")
            ->type_name("N")
            ->group(cloud);

    const std::string domain = "Domain";
    std::string domain_in, domain_out, tessellation, validated;
    CLI::Option* domain_in_option =
        app.add_option("--domain-in", domain_in, "Use this domain instead of the automatic layout")
            ->type_name("FILE")
            ->group(domain);
    CLI::Option* domain_out_option =
        app.add_option("--domain-out", domain_out, "Write the domain; OUTPUT may then be left out")
            ->type_name("FILE")
            ->group(domain);
    std::string constraints, constraints_out;
    CLI::Option* constraints_option =
        app.add_option("--constraints", constraints,
                       "What the automatic layout must keep to: sites, paths, features, pairings")
            ->type_name("FILE")
            ->group(domain);
    CLI::Option* constraints_out_option =
        app.add_option("--constraints-out", constraints_out,
                       "Write the layout as constraints, to edit and give back")
            ->type_name("FILE")
            ->group(domain);
    CLI::Option* validate = app.add_option("--validate-domain", validated,
                                           "Check this domain against INPUT and convert nothing")
                                ->type_name("FILE")
                                ->group(domain);
    app.add_option("--seed", o.seed, "Reserved: the layout does not depend on chance")
        ->type_name("N")
        ->group(domain);

    const std::string output = "Output";
    add_choice(app, "--archive-version", o.write.archive_version, archive_versions,
               "Of .3dm: 4 to 8 (default: 5, for Rhino 5 and later)")
        ->type_name("N")
        ->group(output);
    add_choice(app, "--step-schema", o.write.step_schema, step_schemas, "Of STEP (default: AP242)")
        ->type_name("AP242|AP214")
        ->group(output);
    app.add_option("--units", o.write.units,
                   "Unit of the coordinates: um mm cm m km in ft mi (default: mm)")
        ->type_name("UNIT")
        ->group(output);
    CLI::Option* tessellation_option =
        app.add_option("--tessellation", tessellation,
                       "Write a PLY mesh of the result with normals and distances to INPUT")
            ->type_name("FILE")
            ->group(output);
    app.add_option("--json", command.json, "Write a report; - for standard output")
        ->type_name("FILE")
        ->group(output);

    const std::string run = "Run";
    app.add_option("--threads", command.threads, "Threads to use (default: all cores)")
        ->type_name("N")
        ->check(CLI::PositiveNumber)
        ->group(run);
    CLI::Option* quiet =
        app.add_flag("--quiet", command.quiet, "Say nothing but warnings and errors")->group(run);
    app.add_flag("--verbose", command.verbose, "Say more: rounds of the fit, time of each stage")
        ->excludes(quiet)
        ->group(run);

    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& success) {
        return app.exit(success);
    } catch (const CLI::ParseError& error) {
        std::fprintf(stderr, "bot2nurbs: %s\nRun bot2nurbs --help for the options.\n",
                     error.what());
        return exit_code(ErrorCode::bad_option);
    }
    o.repair = !no_repair;
    if (*open)
        o.closure = Closure::open;
    if (*solid)
        o.closure = Closure::solid;
    if (!parse_features(features, o)) {
        std::fprintf(
            stderr,
            "bot2nurbs: --features %s is not auto, off, or an angle above 0 and at most 180 "
            "degrees\n",
            features.c_str());
        return exit_code(ErrorCode::bad_option);
    }
    if (*viewpoint_option) {
        o.cloud.orient.viewpoint = parse_point(viewpoint);
        if (!o.cloud.orient.viewpoint) {
            std::fprintf(stderr, "bot2nurbs: --viewpoint %s is not three numbers X,Y,Z\n",
                         viewpoint.c_str());
            return exit_code(ErrorCode::bad_option);
        }
    }
    if (*depth_option)
        o.cloud.reconstruct.depth = depth;
    if (!parse_layout(layout, o)) {
        std::fprintf(stderr, "bot2nurbs: --layout %s is neither eck nor quads=FILE\n",
                     layout.c_str());
        return exit_code(ErrorCode::bad_option);
    }
    if ((*weld_option && !read_length("--weld", weld, o.weld)) ||
        (*fill_holes_option && !read_length("--fill-holes", fill_holes, o.fill_holes)) ||
        (*tolerance_option && !read_length("--tolerance", tolerance, o.tolerance)))
        return exit_code(ErrorCode::bad_option);
    if (*patches_option)
        o.patches = patches;
    if (*max_patches_option)
        o.max_patches = max_patches;
    if (*knots_option)
        o.knots = knots;
    if (*domain_in_option)
        o.domain_in = domain_in;
    if (*domain_out_option)
        o.domain_out = domain_out;
    if (*constraints_option)
        o.constraints = constraints;
    if (*constraints_out_option)
        o.constraints_out = constraints_out;
    if (*tessellation_option)
        o.tessellation = tessellation;

    if (*check || *validate) {
        command.action = *check ? Action::check : Action::validate_domain;
        const char* name = *check ? "--check" : "--validate-domain";
        if (*check && *validate) {
            std::fprintf(stderr, "bot2nurbs: --check and --validate-domain exclude each other\n");
            return exit_code(ErrorCode::bad_option);
        }
        if (!o.outputs.empty() || o.domain_out || o.constraints_out || o.tessellation) {
            std::fprintf(stderr, "bot2nurbs: %s writes no output file\n", name);
            return exit_code(ErrorCode::bad_option);
        }
        if (o.cage) {
            std::fprintf(stderr, "bot2nurbs: %s does not look at a --cage\n", name);
            return exit_code(ErrorCode::bad_option);
        }
        if (*validate)
            o.domain_in = validated;
    }
    return command;
}

} // namespace bot2nurbs::cli
