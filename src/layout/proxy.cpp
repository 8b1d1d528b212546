// SPDX-License-Identifier: MIT
#include "layout/proxy.h"

#include "layout/base_complex.h"
#include "layout/place_sites.h"
#include "layout/size_field.h"

#include <algorithm>
#include <cmath>

namespace bot2nurbs {

Result<Proxy> Proxy::build(const LayoutLevel& fine, double width, Context& context)
{
    // Sites in a triangular grid of this width have each sqrt(3) / 2 of its square.
    SitePlan plan;
    plan.width = width;
    plan.inner =
        static_cast<Index>(scaled_area(fine.mesh(), fine.density()) / (0.866 * width * width));
    plan.spread = true;
    Tiles tiles(fine.mesh(), fine.density());
    place_sites(fine, plan, tiles, context);
    if (context.cancelled())
        return Context::cancelled_error("layout");
    Result<PatchComplex> base = build_base_complex(tiles, context);
    if (!base)
        return base.error();

    Proxy proxy(fine, std::move(*base));
    proxy.fine_vertex_ = tiles.sites();
    std::vector<Index> number(fine.mesh().vertex_count(), invalid_index);
    std::vector<Vec3> positions;
    std::vector<Index> name;
    std::vector<double> density;
    for (const Index v : proxy.fine_vertex_) {
        number[v] = static_cast<Index>(positions.size());
        positions.push_back(fine.mesh().position(v));
        name.push_back(fine.name(v));
        density.push_back(fine.density()[v]);
    }
    std::vector<std::array<Index, 3>> triangles;
    for (const PatchComplex::Face& face : proxy.base_.faces()) {
        std::array<Index, 3> t{};
        for (std::size_t k = 0; k < 3; ++k) {
            t[k] = number[proxy.base_.start(face.sides[k])];
            proxy.side_.push_back(face.sides[k]);
        }
        triangles.push_back(t);
    }
    auto mesh = ManifoldMesh::build(std::move(positions), std::move(triangles));
    if (!mesh)
        return Error{ErrorCode::internal, "the dual of tiles: " + mesh.error().message,
                     mesh.error().element};
    proxy.mesh_ = std::make_unique<ManifoldMesh>(std::move(*mesh));

    std::vector<Curve> curves;
    Index name_count = 0;
    for (Index v = 0; v < fine.mesh().vertex_count(); ++v)
        name_count = std::max(name_count, fine.name(v) + 1);
    for (const Curve& curve : fine.curves()) {
        Curve coarse{curve.kind, curve.whole, {}};
        for (const Index n : curve.vertices)
            if (number[fine.any_copy(n)] != invalid_index)
                coarse.vertices.push_back(n);
        curves.push_back(std::move(coarse));
    }
    proxy.level_ = std::make_unique<LayoutLevel>(*proxy.mesh_, std::move(name), name_count,
                                                 std::move(density), std::move(curves));
    proxy.level_->required = fine.required;
    proxy.level_->apart = fine.apart;
    for (Index v = 0; v < proxy.mesh_->vertex_count(); ++v)
        if (proxy.mesh_->is_boundary_vertex(v))
            proxy.level_->boundary_angles.emplace_back(
                v, boundary_angle(fine.mesh(), proxy.fine_vertex_[v]));
    return proxy;
}

} // namespace bot2nurbs
