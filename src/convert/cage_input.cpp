// SPDX-License-Identifier: MIT
#include "convert/cage_input.h"

#include "bot2nurbs/cage_surface.h"
#include "bot2nurbs/read_mesh.h"
#include "mesh/boundary_loops.h"

#include <utility>

namespace bot2nurbs {

namespace {

MeshComponent component_of(const QuadMesh& cage, CageSurface& surface)
{
    MeshComponent component;
    component.source_vertex = cage.source_vertex;
    component.source_vertex.resize(surface.mesh.vertex_count(), invalid_index);
    for (const Index quad : surface.quad_of_face)
        component.source_face.push_back(cage.source_face[quad]);
    component.boundary_loops = static_cast<Index>(boundary_loops(surface.mesh).size());
    component.genus = (2 - surface.domain.complex.euler_characteristic() -
                       static_cast<int>(component.boundary_loops)) /
                      2;
    if (component.boundary_loops == 0)
        component.volume = surface.mesh.volume();
    component.mesh = std::move(surface.mesh);
    return component;
}

} // namespace

Result<PreparedCage> prepare_cage(const ConvertOptions& options, Context& context)
{
    context.begin_stage("read");
    const Result<PolygonMesh> polygons = read_polygons(options.input, context);
    if (!polygons)
        return polygons.error();
    context.begin_stage("subdivide");
    const Result<std::vector<QuadMesh>> pieces = split_quads(*polygons);
    if (!pieces)
        return pieces.error();
    PreparedCage prepared;
    prepared.input.vertices = static_cast<Index>(polygons->positions.size());
    prepared.input.faces = static_cast<Index>(polygons->polygons.size());
    for (const QuadMesh& piece : *pieces) {
        Result<CageSurface> surface = cage_surface(piece, context);
        if (!surface)
            return surface.error();
        for (const Vec3& p : surface->mesh.positions())
            prepared.input.mesh.box.add(p);
        prepared.input.mesh.components.push_back(component_of(piece, *surface));
        prepared.domains.push_back(std::move(surface->domain));
    }
    if (options.closure == Closure::solid)
        if (std::optional<Error> refused = refuse_open(prepared.input.mesh))
            return *refused;
    return prepared;
}

} // namespace bot2nurbs
