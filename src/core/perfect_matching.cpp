// SPDX-License-Identifier: MIT
#include "core/perfect_matching.h"

#include <lemon/matching.h>
#include <lemon/smart_graph.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace bot2nurbs {

namespace {

// Costs are matched as integers. The algorithm adds up as many as there are nodes and multiplies by
// four, which for a million nodes stays below 2^63.
constexpr double cost_units = 1e12;

} // namespace

std::optional<std::vector<Index>> cheapest_perfect_matching(Index nodes,
                                                            const std::vector<MatchingEdge>& edges)
{
    using Graph = lemon::SmartGraph;
    Graph graph;
    graph.reserveNode(static_cast<int>(nodes));
    graph.reserveEdge(static_cast<int>(edges.size()));
    for (Index i = 0; i < nodes; ++i)
        graph.addNode();
    double largest = 0.0;
    for (const MatchingEdge& e : edges) {
        graph.addEdge(graph.nodeFromId(static_cast<int>(e.a)),
                      graph.nodeFromId(static_cast<int>(e.b)));
        largest = std::max(largest, std::fabs(e.cost));
    }
    const double unit = largest > 0.0 ? cost_units / largest : 1.0;
    Graph::EdgeMap<std::int64_t> weight(graph);
    for (std::size_t i = 0; i < edges.size(); ++i)
        weight[graph.edgeFromId(static_cast<int>(i))] = -std::llround(edges[i].cost * unit);
    lemon::MaxWeightedPerfectMatching<Graph, Graph::EdgeMap<std::int64_t>> matching(graph, weight);
    if (!matching.run())
        return std::nullopt;
    std::vector<Index> chosen;
    for (std::size_t i = 0; i < edges.size(); ++i)
        if (matching.matching(graph.edgeFromId(static_cast<int>(i))))
            chosen.push_back(static_cast<Index>(i));
    return chosen;
}

} // namespace bot2nurbs
