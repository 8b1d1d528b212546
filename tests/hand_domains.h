// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/quad_domain.h"

#include <vector>

namespace bot2nurbs::test {

//! A quadrilateral domain made by hand on an analytic mesh: every domain edge is where mathematics
//! puts it, so that what is built on domains can be tested without any automatic layout.
struct HandDomain {
    ManifoldMesh mesh;
    QuadDomain domain;
    //! Charts known by construction (each quad a regular grid of mesh cells, parameters uniform);
    //! empty where domain edges cross mesh faces.
    std::vector<QuadChart> charts;
};

//! The cube on the unit sphere: 6 * 4^level quads, eight vertices of valence 3, domain edges along
//! mesh edges. Each cube face is a grid of cells * cells mesh squares (equal angles), each two
//! triangles. \pre cells is a multiple of 2^level, at least 2.
HandDomain sphere_cube(int level, int cells = 16);

//! A torus (axis z) of radii 1 and `minor` with a regular grid of around * across quads, all
//! vertices of valence 4. \pre around, across >= 3.
HandDomain torus_grid(int around = 6, int across = 4, int cells = 6, double minor = 0.4);

//! The torus with a grid of quads whose edges run askew to the mesh: they cross mesh edges and pass
//! through mesh vertices. 5 * turns^2 quads, all vertices of valence 4; the mesh is a grid of
//! (5 * step * turns)^2 squares. \pre turns >= 2, step >= 1.
HandDomain torus_askew(int turns = 2, int step = 2, double minor = 0.4);

//! A smooth surface of genus 2: a slab of voxels with two holes, refined and smoothed. 50 * 4^level
//! quads, valences 3, 4 and 5. \pre cells is a multiple of 2^level, at least 2.
HandDomain genus2_voxels(int level = 0, int cells = 4);

//! An open cylinder (axis z, radius 1) of around * along quads: two boundary loops.
HandDomain open_cylinder(int around = 4, int along = 2, int cells = 4);

//! A plane L with one arm of length 4 and one of 1, both of width 1, in two quads that meet in its
//! reflex corner of 270 degrees.
HandDomain plane_l(int cells = 8);

//! The same domain on a carrier that splits every mesh face into three at a point of its inside:
//! paths and topology are unchanged, charts are dropped.
HandDomain with_refined_carrier(const HandDomain& hand);

} // namespace bot2nurbs::test
