// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/refine_domain.h"
#include "maps/surface_path.h"

#include <vector>

namespace bot2nurbs {

//! Where the vertices of a refined domain are.
struct RefinedVertices {
    CarrierMesh carrier;            //!< Refined where new quads need it.
    std::vector<SurfacePath> paths; //!< The old edges on it.
    std::vector<Index> vertex;      //!< Per vertex of the refined complex: its carrier vertex.
};

//! The sides of an old quad as paths.
std::vector<PathSide> quad_border(const QuadDomain& domain, const std::vector<SurfacePath>& paths,
                                  Index quad);

//! Finds or makes a carrier vertex for every new domain vertex: on the path of each marked edge
//! near its middle, and near the centre of the charts of the quads that need one. Halves carrier
//! edges where they are long beside the new quads. Errors: layout_failed naming a quad, cancelled.
Result<RefinedVertices> place_vertices(const ManifoldMesh& source, const QuadDomain& domain,
                                       const std::vector<char>& marks,
                                       const RefinedComplex& topology, Context& context);

} // namespace bot2nurbs
