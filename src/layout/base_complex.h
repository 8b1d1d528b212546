// SPDX-License-Identifier: MIT
#pragma once

#include "layout/patch_complex.h"
#include "layout/tiles.h"

namespace bot2nurbs {

//! The triangular base complex K_tri dual to tiles: a vertex per site, a path per cut between two
//! tiles, a face per junction. Each tile is mapped to a convex polygon, its corners the junctions;
//! straight spokes run from the site to the middle of each cut. The spokes of the two tiles that
//! share a cut form a path; the sectors around a junction form its face, a disk by construction.
//! Where the mesh has a boundary, the path between two sites that follow each other is the
//! boundary. \cite eck_1995, section 4. \pre tiles.violations() is empty.
Result<PatchComplex> build_base_complex(const Tiles& tiles, Context& context);

//! Replaces every path by the diagonal of the map of its two triangles to the square: paths become
//! straight and smooth across junctions. \cite eck_1995, section 4.2.
void straighten_triangles(PatchComplex& complex, Context& context);

} // namespace bot2nurbs
