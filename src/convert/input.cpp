// SPDX-License-Identifier: MIT
#include "convert/input.h"

#include "bot2nurbs/read_mesh.h"
#include "mesh/boundary_loops.h"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

namespace bot2nurbs {

namespace {

//! Names the boundary loops of all components by their first vertex in the numbering of the input.
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
                    "leave out --solid for an open surface",
                    where, loops.size(), loops.size() == 1 ? "" : "s",
                    loops.size() == 1 ? "ex" : "ices", named),
        loops.front()};
}

std::optional<Error> refuse_repairs(const RepairedMesh& mesh)
{
    for (const RepairNote& note : mesh.notes)
        if (!note.warning)
            return Error{ErrorCode::bad_geometry,
                         fmt::format("the mesh needs repair: {}. Leave out --no-repair to let this "
                                     "be done",
                                     note.message),
                         invalid_index};
    return std::nullopt;
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

std::optional<Error> refuse(const ConvertOptions& options, const RepairedMesh& mesh,
                            const MeshReport& found)
{
    if (!options.repair)
        if (std::optional<Error> refused = refuse_repairs(mesh))
            return refused;
    if (options.closure == Closure::solid)
        if (std::optional<Error> refused = refuse_open(mesh))
            return refused;
    if (std::optional<Error> refused = refuse_flat(mesh))
        return refused;
    return options.strict ? refuse_self_intersections(found) : std::nullopt;
}

struct LoadedInput {
    TriangleSoup soup;
    MeshReport found;
};

//! Stages "read" and "check"; begins the stage "repair".
Result<LoadedInput> load_input(const ConvertOptions& options, Context& context)
{
    context.begin_stage("read");
    Result<TriangleSoup> soup = read_mesh(options.input, context);
    if (!soup)
        return soup.error();
    context.begin_stage("check");
    MeshReport found = check_mesh(*soup, context);
    if (context.cancelled())
        return Context::cancelled_error("check");
    context.begin_stage("repair");
    return LoadedInput{std::move(*soup), std::move(found)};
}

} // namespace

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
    Result<RepairedMesh> repaired = repair_mesh(std::move(loaded->soup), {}, context);
    if (!repaired)
        return repaired.error();
    input.mesh = std::move(*repaired);
    if (std::optional<Error> refused = refuse(options, input.mesh, input.found))
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
    const Result<RepairedMesh> repaired = repair_mesh(std::move(loaded->soup), {}, context);
    if (repaired) {
        report.repairs = repaired->notes;
        report.rejection = refuse(options, *repaired, report.mesh);
    } else if (repaired.error().code == ErrorCode::cancelled) {
        return repaired.error();
    } else {
        report.rejection = repaired.error();
    }
    context.end_stage();
    return report;
}

} // namespace bot2nurbs
