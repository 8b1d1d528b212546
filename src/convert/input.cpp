// SPDX-License-Identifier: MIT
#include "convert/input.h"

#include "bot2nurbs/fill_holes.h"
#include "bot2nurbs/read_mesh.h"
#include "bot2nurbs/read_points.h"
#include "mesh/boundary_loops.h"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

namespace bot2nurbs {

namespace {

std::optional<Error> refuse_repairs(const RepairedMesh& mesh)
{
    for (const RepairNote& note : mesh.notes)
        if (!note.warning && note.code != "hole_filled") // Which is asked for.
            return Error{ErrorCode::bad_geometry,
                         fmt::format("the mesh needs repair: {}. Leave out --no-repair to let this "
                                     "be done",
                                     note.message),
                         invalid_index};
    return std::nullopt;
}

//! A soup of triangles that do not meet makes a patch of each, which nobody wants.
std::optional<Error> refuse_loose(const RepairedMesh& mesh)
{
    constexpr std::size_t some = 20;
    std::size_t single = 0;
    Index first = invalid_index;
    for (const MeshComponent& c : mesh.components)
        if (c.mesh.face_count() == 1) {
            first = std::min(first, c.source_face[0]);
            ++single;
        }
    if (single < some || 2 * single < mesh.components.size())
        return std::nullopt;
    return Error{ErrorCode::bad_geometry,
                 fmt::format("{} of {} components are single triangles (first: face {}): corners "
                             "that should be one do not meet. --weld DISTANCE joins them, or "
                             "--components largest leaves them out",
                             single, mesh.components.size(), first),
                 first};
}

std::optional<Error> refuse_flat(const RepairedMesh& mesh)
{
    for (const RepairNote& note : mesh.notes)
        if (note.code == "no_volume")
            return Error{ErrorCode::bad_geometry,
                         note.message + ". A solid needs volume: remove such components",
                         invalid_index};
    return std::nullopt;
}

std::optional<Error> refuse_self_intersections(const MeshReport& found)
{
    if (found.self_intersecting_pairs == 0)
        return std::nullopt;
    const auto& [f, g] = found.self_intersections.front();
    return Error{ErrorCode::self_intersecting,
                 fmt::format("{} pairs of faces cross each other (first: faces {} and {}). Without "
                             "--strict this is a warning",
                             found.self_intersecting_pairs, f, g),
                 f};
}

//! `cloud` is what the mesh was made of, if it was.
std::optional<Error> refuse(const ConvertOptions& options, const CloudReport* cloud,
                            const RepairedMesh& mesh, const MeshReport& found)
{
    if (cloud != nullptr && options.closure == Closure::solid)
        if (std::optional<Error> refused = refuse_cloud_solid(*cloud))
            return refused;
    if (!options.repair)
        if (std::optional<Error> refused = refuse_repairs(mesh))
            return refused;
    if (options.closure == Closure::solid)
        if (std::optional<Error> refused = refuse_open(mesh))
            return refused;
    if (std::optional<Error> refused = refuse_flat(mesh))
        return refused;
    if (std::optional<Error> refused = refuse_loose(mesh))
        return refused;
    return options.strict ? refuse_self_intersections(found) : std::nullopt;
}

double area(const ManifoldMesh& mesh)
{
    double sum = 0.0;
    for (Index f = 0; f < mesh.face_count(); ++f)
        sum += 0.5 * norm(mesh.area_vector(f));
    return sum;
}

//! Leaves the component with the largest area.
void keep_largest(RepairedMesh& mesh)
{
    if (mesh.components.size() < 2)
        return;
    std::size_t largest = 0;
    double most = -1.0;
    for (std::size_t c = 0; c < mesh.components.size(); ++c) {
        const double a = area(mesh.components[c].mesh);
        if (a > most) {
            most = a;
            largest = c;
        }
    }
    const Index others = static_cast<Index>(mesh.components.size() - 1);
    MeshComponent kept = std::move(mesh.components[largest]);
    kept.surrounded_by = invalid_index;
    if (kept.cavity) {
        kept.cavity = false;
        mesh.notes.push_back({"cavity_alone",
                              "the largest component is the wall of a hollow in another one", 1,
                              true});
    }
    mesh.notes.push_back({"components_left_out",
                          fmt::format("{} of {} components were left out, as --components largest "
                                      "asks",
                                      others, others + 1),
                          others, true});
    mesh.components.clear();
    mesh.components.push_back(std::move(kept));
    mesh.box = mesh.components.front().mesh.box();
}

//! What is asked for beyond repair.
Status apply_options(const ConvertOptions& options, bool cloud, RepairedMesh& mesh,
                     const Context& context)
{
    if (options.fill_holes && !cloud)
        if (Status failed = fill_holes(mesh, options.fill_holes->of(mesh.box.diagonal()), context))
            return failed;
    if (options.components == ComponentMode::largest)
        keep_largest(mesh);
    return {};
}

RepairOptions repair_options(const ConvertOptions& options, const TriangleSoup& soup)
{
    RepairOptions repair;
    if (!options.weld)
        return repair;
    Box3 box;
    for (const Vec3& p : soup.positions)
        box.add(p);
    const double diagonal = box.diagonal();
    repair.weld = diagonal > 0.0 ? options.weld->of(diagonal) / diagonal : 0.0;
    return repair;
}

struct LoadedInput {
    TriangleSoup soup;
    MeshReport found;
    std::optional<CloudInput> cloud;
};

//! Stages "read" and "check", with those of a cloud between; begins the stage "repair".
Result<LoadedInput> load_input(const ConvertOptions& options, Context& context)
{
    context.begin_stage("read");
    LoadedInput loaded;
    const Result<FileContent> content = file_content(options.input, context);
    if (!content)
        return content.error();
    if (options.cloud.points || *content == FileContent::points) {
        Result<CloudInput> cloud = load_cloud(options, context);
        if (!cloud)
            return cloud.error();
        loaded.soup = std::move(cloud->mesh);
        loaded.cloud = std::move(*cloud);
    } else {
        Result<TriangleSoup> soup = read_mesh(options.input, context);
        if (!soup)
            return soup.error();
        loaded.soup = std::move(*soup);
    }
    context.begin_stage("check");
    loaded.found = check_mesh(loaded.soup, context);
    if (context.cancelled())
        return Context::cancelled_error("check");
    context.begin_stage("repair");
    return loaded;
}

} // namespace

std::optional<Error> refuse_open(const RepairedMesh& mesh)
{
    constexpr std::size_t most_named = 8;
    Index open_components = 0;
    std::vector<Index> loops; // First vertex of each.
    for (const MeshComponent& c : mesh.components) {
        if (c.boundary_loops == 0)
            continue;
        ++open_components;
        for (const std::vector<Index>& loop : boundary_loops(c.mesh)) {
            Index first = invalid_index;
            for (const Index v : loop)
                first = std::min(first, c.source_vertex[v]);
            loops.push_back(first);
        }
    }
    if (loops.empty())
        return std::nullopt;
    std::sort(loops.begin(), loops.end());
    std::string named;
    for (std::size_t i = 0; i < std::min(loops.size(), most_named); ++i)
        named += (i > 0 ? ", " : "") + std::to_string(loops[i]);
    if (loops.size() > most_named)
        named += ", ...";
    const std::string where =
        mesh.components.size() == 1
            ? std::string("the mesh is")
            : fmt::format("{} of {} components are", open_components, mesh.components.size());
    return Error{
        ErrorCode::open_mesh,
        fmt::format("{} open: {} boundary loop{}, at vert{} {}. A solid needs a closed mesh: "
                    "leave out --solid for an open surface, or fill holes with --fill-holes SIZE",
                    where, loops.size(), loops.size() == 1 ? "" : "s",
                    loops.size() == 1 ? "ex" : "ices", named),
        loops.front()};
}

Result<PreparedInput> prepare_input(const ConvertOptions& options, Context& context)
{
    Result<LoadedInput> loaded = load_input(options, context);
    if (!loaded)
        return loaded.error();
    PreparedInput input;
    input.vertices = static_cast<Index>(loaded->soup.positions.size());
    input.faces = static_cast<Index>(loaded->soup.triangles.size());
    input.units = loaded->soup.units;
    input.found = std::move(loaded->found);
    input.cloud = std::move(loaded->cloud);
    const RepairOptions how = repair_options(options, loaded->soup);
    Result<RepairedMesh> repaired = repair_mesh(std::move(loaded->soup), how, context);
    if (!repaired)
        return repaired.error();
    input.mesh = std::move(*repaired);
    if (Status failed = apply_options(options, input.cloud.has_value(), input.mesh, context))
        return *failed;
    if (std::optional<Error> refused =
            refuse(options, input.cloud ? &input.cloud->report : nullptr, input.mesh, input.found))
        return *refused;
    return input;
}

Result<InputReport> check_input(const ConvertOptions& options, Context& context)
{
    Result<LoadedInput> loaded = load_input(options, context);
    if (!loaded)
        return loaded.error();
    InputReport report;
    report.mesh = std::move(loaded->found);
    const RepairOptions how = repair_options(options, loaded->soup);
    Result<RepairedMesh> repaired = repair_mesh(std::move(loaded->soup), how, context);
    if (loaded->cloud)
        report.cloud = loaded->cloud->report;
    if (repaired) {
        if (Status failed = apply_options(options, report.cloud.has_value(), *repaired, context))
            return *failed;
        report.repairs = repaired->notes;
        report.rejection =
            refuse(options, report.cloud ? &*report.cloud : nullptr, *repaired, report.mesh);
    } else if (repaired.error().code == ErrorCode::cancelled) {
        return repaired.error();
    } else {
        report.rejection = repaired.error();
    }
    context.end_stage();
    return report;
}

} // namespace bot2nurbs
