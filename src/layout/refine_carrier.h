// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/quad_domain.h"

namespace bot2nurbs {

//! The source mesh with every edge longer than `limit` split in the middle, longest first, until
//! none is. Faces keep their source face and vertices their exact weights in it; the surface is the
//! same. `limit` is given per source vertex; along an edge the smaller of its ends' values holds (a
//! new vertex takes the mean). At most `max_splits` splits are made. `marks`, one per halfedge of
//! the source, become those of the carrier: both halves of a split edge have its mark.
CarrierMesh refine_carrier(const ManifoldMesh& source, const std::vector<double>& limit,
                           std::size_t max_splits, std::vector<char>& marks);

} // namespace bot2nurbs
