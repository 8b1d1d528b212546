// SPDX-License-Identifier: MIT
#include "layout/pairing.h"

#include "core/disjoint_sets.h"

#include <lemon/matching.h>
#include <lemon/smart_graph.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace bot2nurbs {

namespace {

// Costs are matched as integers: exact arithmetic inside the blossom algorithm, the same result on
// every machine. One unit is this fraction of the largest cost.
constexpr double cost_units = 1e9;

using Graph = lemon::SmartGraph;

// The graph of the candidates up to a distortion; edge i of the graph is candidate chosen[i].
struct Candidates {
    Graph graph;
    std::vector<Index> chosen;

    Candidates(Index face_count, const std::vector<PairCandidate>& all, double limit)
    {
        for (Index f = 0; f < face_count; ++f)
            graph.addNode();
        for (Index i = 0; i < all.size(); ++i)
            if (all[i].distortion <= limit) {
                graph.addEdge(graph.nodeFromId(static_cast<int>(all[i].face_a)),
                              graph.nodeFromId(static_cast<int>(all[i].face_b)));
                chosen.push_back(i);
            }
    }
};

bool has_perfect_matching(Index face_count, const std::vector<PairCandidate>& all, double limit)
{
    const Candidates c(face_count, all, limit);
    lemon::MaxMatching<Graph> matching(c.graph);
    matching.run();
    return static_cast<Index>(2 * matching.matchingSize()) == face_count;
}

// As match_faces, for faces that candidates connect.
std::optional<std::vector<Index>>
match_connected(Index face_count, const std::vector<PairCandidate>& candidates, double slack)
{
    std::vector<double> limits;
    for (const PairCandidate& c : candidates)
        limits.push_back(c.distortion);
    std::sort(limits.begin(), limits.end());
    limits.erase(std::unique(limits.begin(), limits.end()), limits.end());
    if (limits.empty() || !has_perfect_matching(face_count, candidates, limits.back()))
        return std::nullopt;
    std::size_t low = 0, high = limits.size() - 1; // limits[high] suffices.
    while (low < high) {
        const std::size_t middle = (low + high) / 2;
        if (has_perfect_matching(face_count, candidates, limits[middle]))
            high = middle;
        else
            low = middle + 1;
    }

    const Candidates c(face_count, candidates, limits[high] * slack);
    double largest = 0.0;
    for (const Index i : c.chosen)
        largest = std::max(largest, std::fabs(candidates[i].cost));
    const double unit = largest > 0.0 ? cost_units / largest : 1.0;
    Graph::EdgeMap<std::int64_t> weight(c.graph);
    for (std::size_t i = 0; i < c.chosen.size(); ++i)
        weight[c.graph.edgeFromId(static_cast<int>(i))] =
            -std::llround(candidates[c.chosen[i]].cost * unit);
    lemon::MaxWeightedPerfectMatching<Graph, Graph::EdgeMap<std::int64_t>> matching(c.graph,
                                                                                    weight);
    if (!matching.run())
        return std::nullopt;
    std::vector<Index> result;
    for (std::size_t i = 0; i < c.chosen.size(); ++i)
        if (matching.matching(c.graph.edgeFromId(static_cast<int>(i))))
            result.push_back(c.chosen[i]);
    return result;
}

} // namespace

std::optional<std::vector<Index>>
match_faces(Index face_count, const std::vector<PairCandidate>& candidates, double slack)
{
    DisjointSets sets(face_count);
    for (const PairCandidate& c : candidates)
        sets.join(c.face_a, c.face_b);
    // Faces and candidates of each connected set, in its own numbers.
    std::vector<Index> number(face_count), size(face_count, 0);
    for (Index f = 0; f < face_count; ++f)
        number[f] = size[sets.find(f)]++;
    std::vector<std::vector<Index>> members(face_count); // Per set: its candidates.
    for (Index i = 0; i < candidates.size(); ++i)
        members[sets.find(candidates[i].face_a)].push_back(i);
    std::vector<Index> result;
    for (Index root = 0; root < face_count; ++root) {
        if (size[root] == 0)
            continue;
        std::vector<PairCandidate> own;
        for (const Index i : members[root]) {
            own.push_back(candidates[i]);
            own.back().face_a = number[candidates[i].face_a];
            own.back().face_b = number[candidates[i].face_b];
        }
        const auto chosen = match_connected(size[root], own, slack);
        if (!chosen)
            return std::nullopt;
        for (const Index i : *chosen)
            result.push_back(members[root][i]);
    }
    std::sort(result.begin(), result.end());
    return result;
}

std::vector<Index> blocking_faces(Index face_count, const std::vector<PairCandidate>& candidates)
{
    const Candidates c(face_count, candidates, std::numeric_limits<double>::infinity());
    lemon::MaxMatching<Graph> matching(c.graph);
    matching.run();
    std::vector<Index> result;
    for (Index f = 0; f < face_count; ++f)
        if (matching.status(c.graph.nodeFromId(static_cast<int>(f))) ==
            lemon::MaxMatching<Graph>::ODD)
            result.push_back(f);
    return result;
}

} // namespace bot2nurbs
