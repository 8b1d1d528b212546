// SPDX-License-Identifier: MIT
#include "mesh/crease_set.h"

#include "core/disjoint_sets.h"

#include <algorithm>
#include <queue>

namespace bot2nurbs {

namespace {

// A branch that ends inside the surface has at least this many edges.
constexpr std::size_t least_edges = 3;
// A region of so few faces with less than this share of the whole area is a sliver.
constexpr std::size_t sliver_faces = 4;
constexpr double sliver_area = 3e-4;

} // namespace

CreaseSet::CreaseSet(const ManifoldMesh& mesh, const EdgeAngles& angles)
    : mesh_(mesh), angles_(angles), in_(mesh.halfedge_count(), 0), degree_(mesh.vertex_count(), 0)
{
}

void CreaseSet::grow(double strong, double weak, double most_spread)
{
    std::vector<Index> queue;
    for (Index h = 0; h < mesh_.halfedge_count(); ++h)
        if (mesh_.edge(h) == h && std::min(angles_.side[h], angles_.face[h]) >= strong &&
            angles_.spread[h] <= most_spread) {
            add(h);
            queue.push_back(h);
        }
    for (std::size_t i = 0; i < queue.size(); ++i)
        for (const Index v : {mesh_.from(queue[i]), mesh_.to(queue[i])}) {
            if (!is_free_end(v))
                continue;
            const Vec3 ahead = mesh_.position(v) - mesh_.position(other_end(queue[i], v));
            Index best = invalid_index;
            for_each_edge_at(v, [&](Index h) {
                const Vec3 step = mesh_.position(other_end(h, v)) - mesh_.position(v);
                if (!in_[h] && angles_.side[h] >= weak && angles_.spread[h] <= most_spread &&
                    dot(step, ahead) > 0.0 &&
                    (best == invalid_index || angles_.side[h] > angles_.side[best]))
                    best = h;
            });
            if (best != invalid_index) {
                add(best);
                queue.push_back(mesh_.edge(best));
            }
        }
}

void CreaseSet::open_slivers()
{
    DisjointSets region(mesh_.face_count());
    for (Index h = 0; h < mesh_.halfedge_count(); ++h)
        if (mesh_.twin(h) != invalid_index && !in_[h])
            region.join(ManifoldMesh::face(h), ManifoldMesh::face(mesh_.twin(h)));
    std::vector<std::vector<Index>> faces(mesh_.face_count());
    std::vector<double> area(mesh_.face_count(), 0.0);
    double total = 0.0;
    for (Index f = 0; f < mesh_.face_count(); ++f) {
        const double a = norm(mesh_.area_vector(f));
        const Index r = region.find(f);
        area[r] += a;
        total += a;
        if (faces[r].size() <= sliver_faces)
            faces[r].push_back(f);
    }
    std::vector<std::pair<double, Index>> slivers;
    for (Index r = 0; r < mesh_.face_count(); ++r)
        if (!faces[r].empty() && faces[r].size() <= sliver_faces && area[r] < sliver_area * total)
            slivers.emplace_back(area[r], r);
    std::sort(slivers.begin(), slivers.end());
    const auto across = [this](Index h) { return ManifoldMesh::face(mesh_.twin(h)); };
    for (const auto& [small, r] : slivers) {
        std::vector<Index> border;
        for (const Index f : faces[r])
            for (Index h = 3 * f; h < 3 * f + 3; ++h)
                if (in_[h] && mesh_.twin(h) != invalid_index &&
                    region.find(across(h)) != region.find(f))
                    border.push_back(h);
        const auto flattest =
            std::min_element(border.begin(), border.end(), [this](Index g, Index h) {
                return angles_.face[g] < angles_.face[h];
            });
        if (flattest == border.end())
            continue;
        const Index neighbour = region.find(across(*flattest));
        for (const Index h : border)
            if (region.find(across(h)) == neighbour)
                remove(h);
        region.join(r, neighbour);
    }
}

void CreaseSet::prune(double least_length)
{
    using Branch = std::pair<double, Index>; // Length, free end.
    std::priority_queue<Branch, std::vector<Branch>, std::greater<>> too_short;
    const auto look = [&](Index v) {
        if (!is_free_end(v))
            return;
        const std::vector<Index> branch = branch_from(v);
        const double length = length_of(branch);
        if (length < least_length || branch.size() < least_edges)
            too_short.emplace(length, v);
    };
    for (Index v = 0; v < mesh_.vertex_count(); ++v)
        look(v);
    while (!too_short.empty()) {
        const auto [length, v] = too_short.top();
        too_short.pop();
        if (!is_free_end(v))
            continue;
        const std::vector<Index> branch = branch_from(v);
        // What became longer when a side branch went is looked at anew.
        if (length_of(branch) > length) {
            look(v);
            continue;
        }
        Index end = v;
        for (const Index h : branch) {
            end = other_end(h, end);
            remove(h);
        }
        look(end);
        if (degree_[end] == 2)
            for_each_edge_at(end, [&](Index h) {
                if (in_[h])
                    look(far_end(end, h));
            });
    }
}

std::vector<std::vector<Index>> CreaseSet::chains() const
{
    std::vector<std::vector<Index>> chains;
    std::vector<char> used(mesh_.halfedge_count(), 0); // By edge.
    const auto trace = [&](Index v, Index h) {
        std::vector<Index> chain{v};
        const Index start = v;
        for (;;) {
            used[mesh_.edge(h)] = 1;
            v = other_end(h, v);
            chain.push_back(v);
            if (v == start || is_node(v))
                break;
            h = next_edge(v, h);
        }
        chains.push_back(std::move(chain));
    };
    const auto trace_from = [&](Index v) {
        for_each_edge_at(v, [&](Index h) {
            if (in_[h] && !used[mesh_.edge(h)])
                trace(v, h);
        });
    };
    for (Index v = 0; v < mesh_.vertex_count(); ++v)
        if (degree_[v] > 0 && is_node(v))
            trace_from(v);
    for (Index v = 0; v < mesh_.vertex_count(); ++v)
        if (degree_[v] > 0)
            trace_from(v);
    return chains;
}

void CreaseSet::set(Index h, char value, int change)
{
    in_[h] = value;
    if (mesh_.twin(h) != invalid_index)
        in_[mesh_.twin(h)] = value;
    degree_[mesh_.from(h)] += change;
    degree_[mesh_.to(h)] += change;
}

// The other edge of the set at a vertex that has two.
Index CreaseSet::next_edge(Index v, Index from) const
{
    Index next = invalid_index;
    for_each_edge_at(v, [&](Index h) {
        if (in_[h] && mesh_.edge(h) != mesh_.edge(from))
            next = h;
    });
    return next;
}

// The edges from a free end to the next node.
std::vector<Index> CreaseSet::branch_from(Index free_end) const
{
    std::vector<Index> branch;
    Index v = free_end, h = invalid_index;
    for_each_edge_at(v, [&](Index g) {
        if (in_[g])
            h = g;
    });
    for (;;) {
        branch.push_back(h);
        v = other_end(h, v);
        if (is_node(v))
            return branch;
        h = next_edge(v, h);
    }
}

// The node at which the chain that leaves v over h ends; v itself when it comes back.
Index CreaseSet::far_end(Index v, Index h) const
{
    const Index start = v;
    for (;;) {
        v = other_end(h, v);
        if (is_node(v) || v == start)
            return v;
        h = next_edge(v, h);
    }
}

double CreaseSet::length_of(const std::vector<Index>& edges) const
{
    double sum = 0.0;
    for (const Index h : edges)
        sum += norm(mesh_.position(mesh_.to(h)) - mesh_.position(mesh_.from(h)));
    return sum;
}

} // namespace bot2nurbs
