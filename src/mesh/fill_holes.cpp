// SPDX-License-Identifier: MIT
#include "bot2nurbs/fill_holes.h"

#include "mesh/boundary_loops.h"
#include "mesh/turn_outward.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>
#include <utility>

namespace bot2nurbs {

namespace {

// The cost of the best triangulation grows with the cube: this many edges take 20 million steps.
constexpr std::size_t most_edges = 500;

using Triangles = std::vector<std::array<Index, 3>>;

// The triangulation of a polygon with the least area: the best one of the part i .. j, closed by
// the diagonal i j, consists of a triangle i k j and the best ones of i .. k and k .. j.
class LeastArea {
public:
    LeastArea(const ManifoldMesh& mesh, const std::vector<Index>& loop)
        : mesh_(mesh), loop_(loop), cost_(loop.size() * loop.size(), 0.0),
          middle_(loop.size() * loop.size(), 0)
    {
    }

    // Adds the triangles, turned to continue the surface; false when there is none.
    bool solve(Triangles& triangles)
    {
        const std::size_t n = loop_.size();
        for (std::size_t length = 2; length < n; ++length)
            for (std::size_t i = 0; i + length < n; ++i)
                improve(i, i + length);
        if (!std::isfinite(cost_[n - 1]))
            return false;
        collect(0, n - 1, triangles);
        return true;
    }

private:
    std::size_t at(std::size_t i, std::size_t j) const { return i * loop_.size() + j; }

    // The edge that closes the whole polygon is one of the mesh; another that is would get a third
    // face.
    bool allowed(std::size_t i, std::size_t j) const
    {
        return (i == 0 && j + 1 == loop_.size()) ||
               (mesh_.find_halfedge(loop_[i], loop_[j]) == invalid_index &&
                mesh_.find_halfedge(loop_[j], loop_[i]) == invalid_index);
    }

    void improve(std::size_t i, std::size_t j)
    {
        double best = INFINITY;
        if (allowed(i, j))
            for (std::size_t k = i + 1; k < j; ++k) {
                const Vec3 p = mesh_.position(loop_[i]);
                const double area =
                    norm(cross(mesh_.position(loop_[k]) - p, mesh_.position(loop_[j]) - p));
                const double cost = cost_[at(i, k)] + cost_[at(k, j)] + area;
                if (cost < best) {
                    best = cost;
                    middle_[at(i, j)] = k;
                }
            }
        cost_[at(i, j)] = best;
    }

    void collect(std::size_t i, std::size_t j, Triangles& triangles) const
    {
        std::vector<std::array<std::size_t, 2>> parts{{i, j}};
        while (!parts.empty()) {
            const auto [a, b] = parts.back();
            parts.pop_back();
            if (b - a < 2)
                continue;
            const std::size_t k = middle_[at(a, b)];
            triangles.push_back({loop_[b], loop_[k], loop_[a]});
            parts.push_back({a, k});
            parts.push_back({k, b});
        }
    }

    const ManifoldMesh& mesh_;
    const std::vector<Index>& loop_;
    std::vector<double> cost_;
    std::vector<std::size_t> middle_;
};

double extent(const ManifoldMesh& mesh, const std::vector<Index>& loop)
{
    Box3 box;
    for (const Index v : loop)
        box.add(mesh.position(v));
    return box.diagonal();
}

std::string number(double x)
{
    char digits[32];
    const auto end =
        std::to_chars(digits, digits + sizeof digits, x, std::chars_format::general, 6).ptr;
    return {digits, end};
}

// The first vertex of a loop in the numbering of the soup.
Index first_vertex(const MeshComponent& component, const std::vector<Index>& loop)
{
    Index first = invalid_index;
    for (const Index v : loop)
        first = std::min(first, component.source_vertex[v]);
    return first;
}

// Adds the triangles of a fan around a new vertex.
void add_fan(const std::vector<Index>& loop, std::vector<Vec3>& positions, Triangles& triangles)
{
    Vec3 sum;
    for (const Index v : loop)
        sum = sum + positions[v];
    const Index middle = static_cast<Index>(positions.size());
    positions.push_back(sum / static_cast<double>(loop.size()));
    for (std::size_t i = 0; i < loop.size(); ++i)
        triangles.push_back({loop[(i + 1) % loop.size()], loop[i], middle});
}

// Number of loops left open.
Result<Index> fill(MeshComponent& component, double size, std::vector<RepairNote>& notes,
                   const Context& context)
{
    const ManifoldMesh& mesh = component.mesh;
    std::vector<Vec3> positions = mesh.positions();
    Triangles triangles = mesh.triangles();
    Index left = 0;
    for (const std::vector<Index>& loop : boundary_loops(mesh)) {
        if (context.cancelled())
            return Context::cancelled_error("fill holes");
        const double diagonal = extent(mesh, loop);
        if (!(diagonal <= size)) {
            ++left;
            continue;
        }
        const std::size_t before = triangles.size();
        // A triangle that is a component of its own would be filled by itself.
        if (mesh.face_count() == 1 || loop.size() > most_edges ||
            !LeastArea(mesh, loop).solve(triangles))
            add_fan(loop, positions, triangles);
        notes.push_back({"hole_filled",
                         "the hole at vertex " + std::to_string(first_vertex(component, loop)) +
                             " was filled: " + std::to_string(loop.size()) + " edges, " +
                             number(diagonal) + " across, " +
                             std::to_string(triangles.size() - before) + " triangles added",
                         static_cast<Index>(loop.size()), false});
    }
    if (triangles.size() == mesh.face_count())
        return left;
    Result<ManifoldMesh> filled = ManifoldMesh::build(std::move(positions), std::move(triangles));
    if (!filled)
        return filled.error();
    component.mesh = std::move(*filled);
    component.source_vertex.resize(component.mesh.vertex_count(), invalid_index);
    component.source_face.resize(component.mesh.face_count(), invalid_index);
    component.boundary_loops = left;
    component.volume = left == 0 ? component.mesh.volume() : 0.0;
    return left;
}

} // namespace

Status fill_holes(RepairedMesh& mesh, double size, const Context& context)
{
    if (!(size >= 0.0) || !std::isfinite(size))
        return Error{ErrorCode::bad_option,
                     "the size of holes to fill must not be negative: " + number(size),
                     invalid_index};
    Index left = 0;
    bool closed = false;
    for (MeshComponent& component : mesh.components) {
        const bool was_open = component.boundary_loops > 0;
        const Result<Index> open = fill(component, size, mesh.notes, context);
        if (!open)
            return open.error();
        left += *open;
        closed = closed || (was_open && *open == 0);
    }
    if (closed)
        turn_outward(mesh, tolerance::weld * mesh.box.diagonal());
    if (left > 0)
        mesh.notes.push_back({"hole_left",
                              std::to_string(left) + " boundary loops are larger than " +
                                  number(size) + " across and stay open",
                              left, true});
    return {};
}

} // namespace bot2nurbs
