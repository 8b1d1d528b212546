// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/cloud_report.h"
#include "bot2nurbs/convert.h"
#include "bot2nurbs/domain_samples.h"
#include "bot2nurbs/repair_mesh.h"

#include <optional>
#include <vector>

namespace bot2nurbs {

//! A cloud that was read: a mesh for topology and first parameters, and the points to fit to.
struct CloudInput {
    TriangleSoup mesh;
    std::vector<Vec3> points;    //!< Without those that are not fitted to.
    std::vector<double> weights; //!< Confidence times the area a point stands for.
    std::vector<double> spacing; //!< Root of that area.
    std::vector<RepairNote> notes;
    CloudReport report;
};

//! Stages "read", "normals" and "reconstruct". Errors: those of read_points, clean_points,
//! find_normals and reconstruct_surface.
Result<CloudInput> load_cloud(const ConvertOptions& options, Context& context);

//! Why the points do not support a solid, with the region and the option that helps.
std::optional<Error> refuse_cloud_solid(const CloudReport& report);

//! What to warn of.
std::vector<Warning> cloud_warnings(const CloudReport& report);

//! Standard deviation of the points from a surface through them that is to be expected at least: of
//! the noise, or where there is little a quarter of the spacing. A surface of few patches does not
//! meet points more closely, and a point that is no nearer is an outlier, not a detail.
double expected_deviation(const CloudReport& report);

//! How far from the nearest point the surface still counts as seen: 2.2 median spacings, which
//! reconstruct_surface() takes for the rim of a hole, and three deviations of the noise.
double coverage_reach(const CloudReport& report);

//! Shares the points out: each goes to the component it lies nearest to. Those that lie off the
//! mesh, beside pieces of it that were left out, go to none: `off_mesh` says how many. Errors:
//! cancelled.
Result<std::vector<PointData>> points_of_components(const CloudInput& cloud,
                                                    const RepairedMesh& mesh, Index& off_mesh,
                                                    Context& context);

} // namespace bot2nurbs
