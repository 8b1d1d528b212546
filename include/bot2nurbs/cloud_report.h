// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/find_normals.h"
#include "bot2nurbs/point_deviation.h"
#include "bot2nurbs/reconstruct_surface.h"

#include <vector>

namespace bot2nurbs {

//! How a cloud of points is made a mesh.
struct CloudOptions {
    bool points = false; //!< Take the points of a mesh file and pass over its faces.
    NormalMode normals = NormalMode::automatic;
    OrientOptions orient; //!< Its viewpoint goes before that of the file.
    ReconstructOptions reconstruct;
};

//! Share of the points within a distance of the surface.
struct ShareWithin {
    double distance = 0.0; //!< In units of the points.
    double relative = 0.0; //!< Over the diagonal.
    double share = 0.0;
};

//! How far places of the surface are from the nearest point. Where there are points, that is about
//! half of their spacing; no point is expected beyond `reach`, and places that are farther away are
//! not covered: nothing is known of the surface there.
struct SurfaceToPoints {
    Index samples = 0, covered = 0;
    double reach = 0.0;
    double max = 0.0, rms = 0.0; //!< Of the covered ones.
};

//! What was found of a cloud and of the surface through it. Lengths in units of the points.
struct CloudReport {
    Index points = 0;     //!< In the file.
    Index not_finite = 0; //!< Dropped.
    Index duplicates = 0; //!< Merged with others.
    Index outliers = 0;   //!< Left out of mesh, fit and statistics.
    Index off_mesh = 0;   //!< Left out of fit and statistics: no part of the mesh is near them.
    Index fitted = 0;     //!< What the surface was fitted to.
    Index anchors = 0;    //!< Samples of the mesh where patches have no points.

    NormalReport normals;
    double spacing = 0.0; //!< Median.
    double noise = 0.0;   //!< Standard deviation across the surface.
    double noise_ratio = 0.0;

    CloudTopology topology = CloudTopology::closed;
    SurfaceEvidence evidence;

    PointDeviation deviation;        //!< Of the fitted points from the surface.
    std::vector<ShareWithin> within; //!< For some distances, ascending.
    SurfaceToPoints surface_to_points;
};

} // namespace bot2nurbs
