// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/estimate_normals.h"
#include "bot2nurbs/manifold_mesh.h"

#include <optional>
#include <string>
#include <vector>

namespace bot2nurbs {

//! How a mesh is made through points.
enum class ReconstructionMethod {
    poisson,       //!< Screened Poisson \cite kazhdan_2013: closes what it can, smooths noise.
    ball_pivoting, //!< Ball pivoting \cite bernardini_1999: triangles between the points
                   //!< themselves.
};
//! "poisson" or "ball_pivoting".
const char* name(ReconstructionMethod method);

struct ReconstructOptions {
    ReconstructionMethod method = ReconstructionMethod::poisson;
    //! Of Poisson: finest level of the octree, 2^depth cells an axis; by default as fine as density
    //! and noise allow, within `most_vertices`. In 3 .. 12.
    std::optional<int> depth;
    //! Wanted size of the mesh where there are more points than that: it gives topology and a
    //! start, not the shape.
    Index most_vertices = 100000;
    //! Holes up to this size across, as a fraction of the diagonal of the points, are filled;
    //! larger ones stay open. By default only gaps such as points scattered evenly leave by chance
    //! in one of a hundred clouds of so many: of about five spacings.
    std::optional<double> fill_holes;

    std::optional<Error> check() const;
};

//! What the points say of the topology of their surface.
enum class CloudTopology {
    closed,       //!< Points everywhere on a closed surface.
    holes_filled, //!< Closed by filling holes, none larger than the options allow.
    open,         //!< With boundary: beyond it there are no points.
    uncertain,    //!< The points do not decide it: see SurfaceEvidence::doubts.
};
//! "closed", "holes_filled", "open" or "uncertain".
const char* name(CloudTopology topology);

//! A part of the reconstructed surface without points near it; of ball pivoting, a boundary loop:
//! its centre, the diagonal of its box, that over the mean length of its edges, and the area of the
//! triangles that fill it.
struct CloudHole {
    Vec3 place;            //!< The place farthest from the points.
    double size = 0.0;     //!< Twice its distance to them: about the width of the hole.
    double spacings = 0.0; //!< The same over the spacing of the points there, less their noise.
    double area = 0.0;
    bool filled = false;
};

//! What speaks for and against the topology.
struct SurfaceEvidence {
    int depth = 0;                //!< Of the octree.
    double uncovered_area = 0.0;  //!< Share of the closed surface without points near it.
    std::vector<CloudHole> holes; //!< Largest first.
    int genus = 0;                //!< Sum over the components, boundary loops counted as closed.
    int finer_genus = 0;          //!< The same when reconstructed with cells of half the size.
    Index components = 0;         //!< That were kept.
    Index dropped_components = 0; //!< Small ones that few points support.
    double unused_points = 0.0;   //!< Ball pivoting: share of the points that are in no triangle.
    std::vector<std::string> doubts; //!< Why the topology is uncertain, in words; else empty.
};

//! A first surface through points: topology and a start for fitting, not the shape.
struct Reconstruction {
    TriangleSoup mesh; //!< Oriented, two-manifold.
    CloudTopology topology = CloudTopology::closed;
    SurfaceEvidence evidence;
};

//! Reconstructs a surface from oriented points: that of screened Poisson reconstruction
//! \cite kazhdan_2013, which is closed, opened where there are no points; or that of ball pivoting
//! \cite bernardini_1999, which is where the points are, with its small loops filled.
//!
//! Poisson: a place farther than 2.2 spacings from every point (and three deviations of the noise)
//! lies in a hole, which reaches out to 1.5 spacings from the points. Holes larger than
//! options.fill_holes allows are cut out. Components with fewer than 30 points near them, or more
//! than half without any, are dropped (never the one with most points).
//!
//! The topology is uncertain if the genus changes when the octree's cells are halved, if points
//! contradict each other about inside and outside (`disagreement`, from orient_normals()), if the
//! neighbourhoods fill space rather than show a surface, if more of the closed surface is without
//! points than with, or if balls meet less than nine of ten points.
//!
//! Cost O(n log n). The same for any thread count. Errors: bad_option, bad_geometry (no surface was
//! found), cancelled. \pre estimate.normals point to one side; inward ones give a surface that
//! faces inward
Result<Reconstruction> reconstruct_surface(const std::vector<Vec3>& points,
                                           const SurfaceEstimate& estimate, double disagreement,
                                           const ReconstructOptions& options, Context& context);

} // namespace bot2nurbs
