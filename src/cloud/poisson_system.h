// SPDX-License-Identifier: MIT
#pragma once

#include "cloud/octree.h"

#include "bot2nurbs/vec.h"

#include <vector>

namespace bot2nurbs {

//! A point of a surface, in the unit cube.
struct PoissonSample {
    Vec3 position, normal; //!< Unit, outward.
    double area = 0.0;     //!< What it stands for.
    double weight = 0.0;   //!< How strongly the surface is held to it; 0: not at all.
    int level = 0;         //!< Of the octree whose cells are the size of its detail.
};

//! A piecewise trilinear function on the leaves of an octree: its values at the vertices of every
//! level. A vertex of a leaf has the same value on all levels.
struct OctreeFunction {
    std::vector<std::vector<double>> values; //!< Per level, per vertex.
    double surface = 0.5; //!< Value on the surface: larger inside, smaller outside.
};

struct PoissonSolve {
    OctreeFunction function;
    int iterations = 0;
    double residual = 0.0; //!< Relative to the right side.
};

//! Solves the screened Poisson problem \cite kazhdan_2013: the function, near 1 inside and 0
//! outside, whose gradient is closest to the samples' normals (spread over the cells around them),
//! and which is one half at the samples. It vanishes on the border of the cube, so that the surface
//! is closed.
//!
//! Trilinear elements; conjugate gradients on the functions of all levels together, which is the
//! multilevel preconditioner of \cite bramble_1990. The same for any thread count. Errors:
//! cancelled. \pre the octree was built with the samples' cells wanted
Result<PoissonSolve> solve_poisson(const Octree& tree, const std::vector<PoissonSample>& samples,
                                   const Context& context);

} // namespace bot2nurbs
