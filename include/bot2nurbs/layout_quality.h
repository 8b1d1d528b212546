// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/quad_domain.h"

#include <vector>

namespace bot2nurbs {

//! A number per patch or edge, summed up.
struct Spread {
    double least = 0.0, median = 0.0, most = 0.0;
    Index least_at = invalid_index, most_at = invalid_index; //!< Patches or edges.
};

//! How good a domain is to fit a spline on: shapes and sizes of its patches on the source, and how
//! evenly their charts cover them.
struct LayoutQuality {
    //! L2 stretch of each chart, normalised: 1 for a similarity, large where much surface is
    //! squeezed into few parameters. \cite sander_2001
    Spread stretch;
    //! Angle in degrees, 0 to 90, at which lines of constant u and v cross: mean over the area of
    //! each chart.
    Spread angle;
    //! Largest over smallest area of surface per parameter within each chart, each over a hundredth
    //! of the area: slivers do not count.
    Spread area_ratio;
    //! The longer over the shorter pair of opposite sides of each patch.
    Spread aspect;
    //! Area of each patch over the mean.
    Spread size;
    //! Length of each edge over the distance of its ends: 1 for a straight one.
    Spread straightness;
};

//! Cost linear in charts and paths. \pre charts are those of compute_charts for the domain.
LayoutQuality measure_layout(const QuadDomain& domain, const std::vector<QuadChart>& charts);

} // namespace bot2nurbs
