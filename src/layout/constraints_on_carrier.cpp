// SPDX-License-Identifier: MIT
#include "layout/constraints_on_carrier.h"

#include "layout/chain_finder.h"
#include "layout/curves.h"

#include <algorithm>
#include <limits>
#include <map>
#include <set>

namespace bot2nurbs {

namespace {

Error conflict(std::string message, Index element)
{
    return {ErrorCode::constraint_conflict, std::move(message), element};
}

std::string sites_of(const CarrierConstraints& placed, const CarrierConstraints::Pair& pair)
{
    const auto number = [&placed](Index vertex) {
        return std::to_string(std::find(placed.sites.begin(), placed.sites.end(), vertex) -
                              placed.sites.begin());
    };
    return "sites " + number(pair.a) + " and " + number(pair.b);
}

// Cosine from which two directions count as one: those of an edge and of its first piece differ by
// rounding alone.
constexpr double same_way = 1.0 - 1e-9;

using Edge = std::pair<Index, Index>;

Edge edge_of(Index a, Index b)
{
    return {std::min(a, b), std::max(a, b)};
}

} // namespace

std::vector<FeaturePath> constrained_paths(const DomainConstraints& constraints)
{
    std::vector<FeaturePath> paths;
    for (const RequiredPath& path : constraints.paths)
        paths.push_back({FeatureKind::smooth_seam, path.vertices});
    // A feature says more of an edge than a path, so it comes later and wins.
    paths.insert(paths.end(), constraints.features.begin(), constraints.features.end());
    return paths;
}

Status check_constrained_paths(const DomainConstraints& constraints, const ManifoldMesh& source)
{
    std::map<Edge, Index> feature_of;
    for (Index i = 0; i < constraints.features.size(); ++i) {
        const FeaturePath& path = constraints.features[i];
        if (path.kind == FeatureKind::corner)
            continue;
        for (std::size_t k = 0; k + 1 < path.vertices.size(); ++k) {
            const Index a = path.vertices[k], b = path.vertices[k + 1];
            Index h = source.find_halfedge(a, b);
            if (h == invalid_index)
                h = source.find_halfedge(b, a);
            const bool rim = source.twin(h) == invalid_index;
            if (path.kind == FeatureKind::boundary && !rim)
                return conflict("feature " + std::to_string(i) + " calls the edge " +
                                    std::to_string(a) + "-" + std::to_string(b) +
                                    " boundary, but the mesh has faces on both its sides",
                                i);
            const auto [at, first] = feature_of.emplace(edge_of(a, b), i);
            if (!first && constraints.features[at->second].kind != path.kind)
                return conflict("features " + std::to_string(at->second) + " and " +
                                    std::to_string(i) + " want the edge " + std::to_string(a) +
                                    "-" + std::to_string(b) + " to be of different kinds",
                                i);
        }
    }
    return {};
}

Result<CarrierConstraints> place_constraints(const DomainConstraints& constraints,
                                             const std::vector<Index>& point_vertices)
{
    CarrierConstraints placed;
    auto point = point_vertices.begin();
    for (Index i = 0; i < constraints.sites.size(); ++i) {
        const ConstraintSite& site = constraints.sites[i];
        const Index vertex = site.vertex ? *site.vertex : *point++;
        if (vertex == invalid_index)
            return conflict("site " + std::to_string(i) + " is on no face of the mesh", i);
        const auto same = std::find(placed.sites.begin(), placed.sites.end(), vertex);
        if (same != placed.sites.end())
            return conflict("sites " + std::to_string(same - placed.sites.begin()) + " and " +
                                std::to_string(i) + " are at the same place",
                            i);
        placed.sites.push_back(vertex);
        if (site.valence)
            placed.valences.emplace_back(vertex, *site.valence);
    }
    const auto sort_out = [&placed](const auto& from, auto& required, auto& forbidden) {
        for (Index i = 0; i < from.size(); ++i)
            (from[i].demand == Demand::required ? required : forbidden)
                .push_back({placed.sites[from[i].sites[0]], placed.sites[from[i].sites[1]], i});
    };
    sort_out(constraints.adjacencies, placed.joined, placed.apart);
    sort_out(constraints.pairings, placed.paired, placed.unpaired);
    for (const auto& pairing : placed.paired)
        for (const auto& adjacency : placed.apart)
            if (edge_of(pairing.a, pairing.b) == edge_of(adjacency.a, adjacency.b))
                return conflict("pairing " + std::to_string(pairing.number) +
                                    " needs the edge that adjacency " +
                                    std::to_string(adjacency.number) + " forbids",
                                pairing.number);
    for (const auto& pairing : placed.paired)
        for (const auto& adjacency : placed.joined)
            if (edge_of(pairing.a, pairing.b) == edge_of(adjacency.a, adjacency.b))
                return conflict("pairing " + std::to_string(pairing.number) +
                                    " would remove the edge that adjacency " +
                                    std::to_string(adjacency.number) + " requires",
                                pairing.number);
    return placed;
}

Status route_joints(const ManifoldMesh& mesh, const CarrierConstraints& constraints,
                    std::vector<char>& marks)
{
    ChainFinder finder(mesh, marks, constraints.sites);
    std::vector<double> length;
    for (const auto& joint : constraints.joined) {
        const auto chain = finder.find(
            joint.a, [&joint](Index v, double) { return v == joint.b; }, joint.b);
        if (!chain)
            return conflict(
                "adjacency " + std::to_string(joint.number) +
                    ": no way from one of its sites to the other meets no path, feature "
                    "or other site",
                joint.number);
        finder.mark(chain->vertices, joint_mark);
        length.push_back(chain->length);
    }
    // Cutting along one edge alone leaves a hole of two sides, which no layout can have: the cut
    // goes on beyond one end.
    for (std::size_t i = 0; i < length.size(); ++i) {
        const auto& joint = constraints.joined[i];
        if (finder.marks_at(joint.a) != 1 || finder.marks_at(joint.b) != 1)
            continue;
        const auto far = [&](Index, double distance) { return distance >= length[i]; };
        auto chain = finder.find(joint.b, far);
        if (!chain)
            chain = finder.find(joint.a, far);
        if (!chain)
            return conflict("adjacency " + std::to_string(joint.number) +
                                ": there is no room for edges beside the one it asks for",
                            joint.number);
        finder.mark(chain->vertices, mark_of(FeatureKind::smooth_seam));
    }
    return {};
}

Status check_kept(const QuadDomain& domain, const ManifoldMesh& source,
                  const DomainConstraints& wanted, const CarrierConstraints& constraints)
{
    if (wanted.empty())
        return {};
    const std::set<Index> vertices(domain.vertices.begin(), domain.vertices.end());
    for (Index i = 0; i < constraints.sites.size(); ++i)
        if (vertices.count(constraints.sites[i]) == 0)
            return conflict("site " + std::to_string(i) + " is no vertex of the domain", i);

    std::set<Edge> edges, diagonals;
    for (const DomainEdge& e : domain.edges)
        edges.insert(edge_of(domain.vertices[e.a], domain.vertices[e.b]));
    for (const auto& q : domain.complex.quads())
        for (int k = 0; k < 2; ++k)
            diagonals.insert(edge_of(domain.vertices[q[k]], domain.vertices[q[k + 2]]));
    const auto holds = [](const std::set<Edge>& set, const CarrierConstraints::Pair& pair) {
        return set.count(edge_of(pair.a, pair.b)) != 0;
    };
    const auto named = [&](const char* kind, const CarrierConstraints::Pair& pair,
                           const char* what) {
        return conflict(std::string(kind) + " " + std::to_string(pair.number) + ": " +
                            sites_of(constraints, pair) + " " + what,
                        pair.number);
    };
    for (const auto& pair : constraints.joined)
        if (!holds(edges, pair))
            return named("adjacency", pair, "could not be joined by an edge");
    for (const auto& pair : constraints.apart)
        if (holds(edges, pair))
            return named("adjacency", pair, "could not be kept apart");
    for (const auto& pair : constraints.paired)
        if (!holds(diagonals, pair))
            return named("pairing", pair, "are not opposite corners of one quad");
    for (const auto& pair : constraints.unpaired)
        if (holds(diagonals, pair))
            return named("pairing", pair, "are opposite corners of one quad");

    // Paths as source edges: the domain's edges that run along them, with their sharpness.
    struct Step {
        Index to;
        bool crease;
    };
    std::map<Index, std::vector<Step>> along; // Per carrier vertex: domain edges along mesh edges.
    for (Index e = 0; e < domain.edges.size(); ++e) {
        const DomainEdge& edge = domain.edges[e];
        Index last = domain.vertices[edge.a];
        const auto step = [&](Index v) {
            along[last].push_back({v, edge.crease});
            along[v].push_back({last, edge.crease});
            last = v;
        };
        bool by_vertices = true;
        for (const PathPoint& p : edge.path)
            by_vertices = by_vertices && p.is_vertex();
        if (!by_vertices)
            continue;
        for (const PathPoint& p : edge.path)
            step(p.from);
        step(domain.vertices[edge.b]);
    }
    // Of a source edge that was split on the way its first piece is enough: marks go to all pieces.
    const auto on_edge = [&](Index a, Index b) -> const bool* {
        const Vec3 d = normalized(source.position(b) - source.position(a));
        const auto found = along.find(a);
        if (found == along.end())
            return nullptr;
        for (const Step& step : found->second) {
            const Vec3 way = normalized(domain.carrier.mesh.position(step.to) - source.position(a));
            if (step.to == b || (step.to >= source.vertex_count() && dot(way, d) > same_way))
                return &step.crease;
        }
        return nullptr;
    };
    const std::vector<FeaturePath> paths = constrained_paths(wanted);
    for (std::size_t i = 0; i < paths.size(); ++i) {
        if (paths[i].kind == FeatureKind::corner || paths[i].kind == FeatureKind::boundary)
            continue;
        const bool feature = i >= wanted.paths.size();
        const std::size_t number = feature ? i - wanted.paths.size() : i;
        for (std::size_t k = 0; k + 1 < paths[i].vertices.size(); ++k) {
            const bool* crease = on_edge(paths[i].vertices[k], paths[i].vertices[k + 1]);
            if (!crease || (feature && *crease != (paths[i].kind == FeatureKind::crease)))
                return conflict((feature ? "feature " : "path ") + std::to_string(number) +
                                    ": its edge " + std::to_string(paths[i].vertices[k]) + "-" +
                                    std::to_string(paths[i].vertices[k + 1]) +
                                    (crease ? " is not of the kind asked for"
                                            : " is part of no edge of the domain"),
                                static_cast<Index>(number));
        }
    }
    return {};
}

} // namespace bot2nurbs
