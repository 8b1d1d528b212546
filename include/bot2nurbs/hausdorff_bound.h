// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"
#include "bot2nurbs/manifold_mesh.h"
#include "bot2nurbs/spline_network.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace bot2nurbs {

//! How far bound_hausdorff() goes.
struct HausdorffOptions {
    //! Done when upper - lower is at most this share of upper ...
    double relative_gap = 0.02;
    //! ... or this share of the diagonal of the box of the source.
    double absolute_gap = 1e-6;
    //! A distance to decide about instead, in units of the input: every patch is bounded until it
    //! is known to be within it, or to have a place beyond it. Bounds above it are then as loose as
    //! they happen to be. Much cheaper than a value where most of the surface is well within.
    std::optional<double> decide;
    //! Cells bounded at most; 0: 100 for every triangle and Bezier piece, and a million.
    std::uint64_t max_cells = 0;
};

enum class HausdorffTermination {
    gap_reached, //!< The wanted gap.
    decided,     //!< Every patch is within `decide` or has a place beyond it.
    cell_limit,  //!< Neither, within max_cells. The bounds hold, but are looser than was asked for.
};

//! lower <= largest distance <= upper.
struct DistanceBounds {
    double lower = 0.0, upper = 0.0;
};

//! A place that is far from the other side, and the nearest place there.
struct FarPlace {
    Vec3 point;            //!< The place.
    double distance = 0.0; //!< At most its distance from the other side.
    DomainPoint surface;   //!< The one of the two that is on the surface.
    SourcePoint source;    //!< The one that is on the source.
};

//! The largest distance of one side from the other.
struct OneSidedDistance : DistanceBounds {
    FarPlace worst; //!< On this side: the place whose distance `lower` is.
};

//! What is known of one patch.
struct PatchDistance {
    //! From the patch to the source. `lower` is the largest distance met with.
    DistanceBounds surface_to_source;
    //! From the parts of the source that were compared with this patch. Every point of the source
    //! is in a part of some patch, and the patch is the nearest one except where several are about
    //! equally near. `lower` is of points whose nearest place is in the patch.
    DistanceBounds source_to_surface;
};

//! A proven two-sided bound of the Hausdorff distance.
struct HausdorffBound {
    //! Known as well as the larger of the two asks for: bounds of the smaller one are loose.
    OneSidedDistance surface_to_source, source_to_surface;
    std::vector<PatchDistance> patches;
    HausdorffTermination termination = HausdorffTermination::gap_reached;
    std::uint64_t cells = 0;   //!< Parts of the surface and of the source that were bounded.
    std::uint64_t queries = 0; //!< Closest points that were looked for.

    //! The side that is farther from the other.
    const OneSidedDistance& worse_side() const
    {
        return surface_to_source.lower > source_to_surface.lower ? surface_to_source
                                                                 : source_to_surface;
    }
    //! lower() <= Hausdorff distance <= upper().
    double lower() const { return worse_side().lower; }
    double upper() const
    {
        return surface_to_source.upper > source_to_surface.upper ? surface_to_source.upper
                                                                 : source_to_surface.upper;
    }
};

//! Bounds the two-sided Hausdorff distance between a mesh, open or closed, and a spline surface, by
//! branch and bound over its Bezier pieces and the triangles.
//!
//! Guarantees: 1. lower() <= distance <= upper(), rounding of doubles included; 2. the same result
//! for any number of threads. How: docs/algorithms/deviation.md. \cite sacht_jacobson_2024 Errors:
//! empty_input; bad_option (a gap that is negative, not below 1, or zero both ways; a negative
//! distance to decide about); bad_geometry (a coefficient that is not finite, naming the patch);
//! cancelled. Cost: about linear in triangles and pieces, see there.
Result<HausdorffBound> bound_hausdorff(const ManifoldMesh& source, const QuadComplex& complex,
                                       const SplineSurface& surface,
                                       const HausdorffOptions& options, Context& context);

} // namespace bot2nurbs
