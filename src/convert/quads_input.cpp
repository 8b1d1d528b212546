// SPDX-License-Identifier: MIT
#include "convert/quads_input.h"

#include "bot2nurbs/closest_point.h"
#include "bot2nurbs/read_mesh.h"

#include <algorithm>
#include <fmt/format.h>
#include <tuple>
#include <utility>

namespace bot2nurbs {

namespace {

// Vertices of a piece whose distances say which component it belongs to.
constexpr std::size_t most_probes = 500;

// An edge of a mesh of quads is suspect when it is so many times as long on the mesh as straight.
// Half a turn is 1.6, and the edges of quads that folds of the mesh push aside are up to 2.4.
constexpr double most_detour = 4.0;

double mean_distance(const QuadMesh& piece, const ClosestPoint& closest)
{
    const std::size_t step = 1 + piece.positions.size() / most_probes;
    double sum = 0.0, count = 0.0;
    for (std::size_t v = 0; v < piece.positions.size(); v += step) {
        sum += closest.query(piece.positions[v]).distance;
        count += 1.0;
    }
    return sum / count;
}

} // namespace

Result<std::vector<QuadMesh>> quads_of_components(const std::string& path, const RepairedMesh& mesh,
                                                  Context& context)
{
    const auto in_file = [&path](Error error) {
        if (error.code == ErrorCode::invalid_domain)
            error.message = path + ": " + error.message;
        return error;
    };
    const Result<PolygonMesh> polygons = read_polygons(path, context);
    if (!polygons)
        return polygons.error();
    Result<std::vector<QuadMesh>> pieces = split_quads(*polygons);
    if (!pieces)
        return in_file(pieces.error());
    if (pieces->size() != mesh.components.size())
        return in_file({ErrorCode::invalid_domain,
                        fmt::format("the quads have {} connected pieces, the mesh {}: each "
                                    "component needs quads of its own",
                                    pieces->size(), mesh.components.size()),
                        invalid_index});
    if (pieces->size() == 1)
        return pieces;
    // The nearest pair first, then the nearest of those left.
    std::vector<std::tuple<double, Index, Index>> pairs;
    for (Index c = 0; c < mesh.components.size(); ++c) {
        const ClosestPoint closest(mesh.components[c].mesh);
        for (Index p = 0; p < pieces->size(); ++p) {
            if (context.cancelled())
                return Context::cancelled_error("layout");
            pairs.emplace_back(mean_distance((*pieces)[p], closest), c, p);
        }
    }
    std::sort(pairs.begin(), pairs.end());
    std::vector<QuadMesh> result(mesh.components.size());
    std::vector<char> used(pieces->size(), 0);
    for (const auto& [distance, c, p] : pairs)
        if (result[c].quads.empty() && !used[p]) {
            result[c] = std::move((*pieces)[p]);
            used[p] = 1;
        }
    return result;
}

void add_detour_warnings(ConvertReport& report)
{
    for (const ComponentOutcome& c : report.components)
        if (c.quads && c.quads->largest_detour > most_detour)
            report.warnings.push_back(
                {"layout_detour",
                 fmt::format("edge {}-{} of the quad mesh (vertices counted from 0) is {:.1f} "
                             "times as long on the mesh as its ends are apart: the quads do not "
                             "follow the mesh there",
                             c.quads->detour_edge[0], c.quads->detour_edge[1],
                             c.quads->largest_detour),
                 c.quads->detour_edge[0]});
}

} // namespace bot2nurbs
