// SPDX-License-Identifier: MIT
#include "mesh/turn_outward.h"

#include "mesh/count_of.h"
#include "mesh/nesting.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace bot2nurbs {

namespace {

double area_of(const ManifoldMesh& mesh)
{
    double area = 0.0;
    for (Index f = 0; f < mesh.face_count(); ++f)
        area += 0.5 * norm(mesh.area_vector(f));
    return area;
}

// Turning all faces of a manifold mesh keeps it manifold.
ManifoldMesh turned(const ManifoldMesh& mesh)
{
    std::vector<std::array<Index, 3>> triangles = mesh.triangles();
    for (auto& t : triangles)
        std::swap(t[1], t[2]);
    return std::move(ManifoldMesh::build(mesh.positions(), std::move(triangles)).value());
}

void renew(std::vector<RepairNote>& notes, RepairNote note)
{
    notes.erase(std::remove_if(notes.begin(), notes.end(),
                               [&](const RepairNote& n) { return n.code == note.code; }),
                notes.end());
    if (note.count > 0)
        notes.push_back(std::move(note));
}

} // namespace

void turn_outward(RepairedMesh& mesh, double distance)
{
    std::vector<const ManifoldMesh*> meshes;
    for (const MeshComponent& c : mesh.components)
        meshes.push_back(&c.mesh);
    const Nesting nesting = find_nesting(meshes);
    Index turns = 0, nested = 0, empty = 0;
    for (std::size_t i = 0; i < mesh.components.size(); ++i) {
        MeshComponent& c = mesh.components[i];
        c.surrounded_by = nesting.parent[i];
        const bool hollow = nesting.depth[i] % 2 == 1;
        c.cavity = hollow && c.volume < 0.0;
        nested += hollow && c.volume > 0.0;
        empty += c.mesh.closed() && std::abs(c.volume) <= distance * area_of(c.mesh);
        if (c.cavity || !(c.volume < 0.0))
            continue;
        c.mesh = turned(c.mesh);
        c.volume = c.mesh.volume();
        ++turns;
    }
    if (turns > 0)
        mesh.notes.push_back(
            {"turned_outward",
             "turned " + count_of(turns, "closed component", "closed components") + " outward",
             turns, false});
    renew(mesh.notes,
          {"no_volume",
           count_of(empty, "closed component encloses", "closed components enclose") + " no volume",
           empty, true});
    renew(mesh.notes, {"nested_solid",
                       count_of(nested, "component lies", "components lie") +
                           " inside another and turns outward: taken as a solid of its own, not as "
                           "a hollow",
                       nested, true});
}

} // namespace bot2nurbs
