// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "bot2nurbs/manifold_mesh.h"
#include "bot2nurbs/spline_network.h"

namespace bot2nurbs {

struct DistanceStatistics {
    double max = 0.0, rms = 0.0;
    Index samples = 0;
    Vec3 worst; //!< Where the largest distance was found, on the side it was measured from.
};

//! Two-sided distance between a mesh and a spline surface from samples spread evenly over both.
//! Made for the root mean squares: the largest distance between samples can be missed, and the
//! search for the nearest place of the surface is local. bound_hausdorff() finds and proves the
//! largest.
struct Deviation {
    DistanceStatistics source_to_surface, surface_to_source;
    Index worst_patch = invalid_index; //!< Patch with the largest surface-to-source distance.

    double max() const
    {
        return source_to_surface.max > surface_to_source.max ? source_to_surface.max
                                                             : surface_to_source.max;
    }
    double rms() const
    {
        return source_to_surface.rms > surface_to_source.rms ? source_to_surface.rms
                                                             : surface_to_source.rms;
    }
};

//! Cost O((F + samples) log F). Errors: cancelled.
Result<Deviation> measure_deviation(const ManifoldMesh& source, const QuadComplex& complex,
                                    const SplineSurface& surface, Context& context);

} // namespace bot2nurbs
