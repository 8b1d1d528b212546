// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/clean_points.h"
#include "bot2nurbs/estimate_normals.h"
#include "bot2nurbs/orient_normals.h"

namespace bot2nurbs {

//! Whose normals are used.
enum class NormalMode {
    automatic, //!< Those of the file if there are some and they agree with each other.
    given,     //!< Those of the file.
    estimate,  //!< None of the file.
};

//! Where the normals of a cloud came from, and what is known of them.
struct NormalReport {
    bool given = false;        //!< Those of the file are used; else estimated ones.
    Index filled_in = 0;       //!< Of the given ones: missing, and taken from estimates.
    Index solved_points = 0;   //!< See OrientationSummary.
    double disagreement = 0.0; //!< Share of points whose normal contradicts those beside it.

    bool file_has_normals = false;
    double given_contradicted = 0.0; //!< The same for the file's normals, if there are some.
    //! Share of the file's normals that point to the other side of the estimated ones; only when
    //! those are used.
    double given_flipped = 0.0;
};

struct CloudNormals {
    SurfaceEstimate estimate; //!< With the normals that were chosen, and the file's confidence in.
    NormalReport report;
};

//! Finds oriented normals of points. Those of the file count as agreeing if at most 2 % of them
//! contradict the ones beside them (contradicted_normals()) and at most half are missing. Else, and
//! without any, normals are estimated and oriented: estimate_normals(), orient_normals().
//!
//! Cost O(n log n). The same for any thread count. Errors: bad_option, bad_geometry (mode given,
//! but more than half of the points have no normal), cancelled.
Result<CloudNormals> find_normals(const CleanPoints& points, NormalMode mode,
                                  const OrientOptions& options, Context& context);

} // namespace bot2nurbs
