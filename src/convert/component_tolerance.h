// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/convert.h"

namespace bot2nurbs {

//! Refinement as the options ask for it, to a tolerance in units of the mesh that is refined.
ToleranceOptions tolerance_options(const ConvertOptions& options, double tolerance);

//! What refinement did, for the report; `scale` takes its lengths to units of the input.
ToleranceReport describe(const ToleranceFit& fit, double scale);

//! Writes the rounds to the log.
void log_rounds(const ToleranceReport& report, const Context& context);

//! Decides whether a surface as it is written is within the tolerance of the report. `bound` is of
//! that surface; where it leaves the question open, it is bounded once more. Errors: those of
//! bound_hausdorff().
Status judge(const ManifoldMesh& source, const QuadComplex& complex, const SplineSurface& surface,
             const HausdorffBound& bound, ToleranceReport& report, Context& context);

//! The same for points: `worst` is the one that is farthest from the surface as it is written.
void judge_points(const FarPlace& worst, ComponentOutcome& outcome);

} // namespace bot2nurbs
