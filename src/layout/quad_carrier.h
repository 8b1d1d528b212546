// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/quad_domain.h"

#include <vector>

namespace bot2nurbs {

//! What a quad mesh is drawn on.
struct QuadCarrier {
    CarrierMesh carrier;
    std::vector<Index> vertices; //!< Per vertex of the quads: the carrier vertex at its place.
};

//! The source, with the places of the vertices of a quad mesh as vertices, refined where the quads
//! are small for it: everywhere as at the nearest vertex of the quads. `size` is the mean length of
//! the edges at each vertex.
QuadCarrier make_quad_carrier(const ManifoldMesh& source, const std::vector<SourcePoint>& places,
                              const std::vector<double>& size);

} // namespace bot2nurbs
