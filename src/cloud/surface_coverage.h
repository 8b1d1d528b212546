// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/estimate_normals.h"
#include "bot2nurbs/manifold_mesh.h"
#include "bot2nurbs/reconstruct_surface.h"

#include <vector>

namespace bot2nurbs {

//! How near the points are to a reconstructed surface.
struct SurfaceCoverage {
    //! Per vertex: distance to the nearest point that is no outlier, less what the noise explains,
    //! in spacings of the points there.
    std::vector<double> spacings;
    std::vector<double> distance;    //!< Per vertex: that distance as it is.
    std::vector<Index> component;    //!< Per vertex: of the mesh.
    std::vector<Index> points;       //!< Per component: points nearest to it.
    std::vector<double> area;        //!< Per component.
    std::vector<double> uncovered;   //!< Per component: area without points near it.
    std::vector<double> vertex_area; //!< Per vertex: a third of the triangles around it.
};

//! Cost O((V + n) log). Errors: cancelled. \pre the mesh has vertices, and not all points are
//! outliers
Result<SurfaceCoverage> measure_coverage(const TriangleSoup& mesh, const std::vector<Vec3>& points,
                                         const SurfaceEstimate& estimate, Context& context);

//! The mesh without the components marked in `drop`; vertices keep their order.
TriangleSoup without_components(const TriangleSoup& mesh, const std::vector<Index>& component,
                                const std::vector<char>& drop);

//! Connected places without points near them, each with the rim up to where the points begin: per
//! vertex its hole, or invalid_index.
struct SurfaceHoles {
    std::vector<CloudHole> holes;
    std::vector<Index> of_vertex;
};
SurfaceHoles find_holes(const TriangleSoup& mesh, const SurfaceCoverage& coverage);

//! Width in spacings of the widest gap that chance leaves in one of a hundred clouds of so many
//! evenly scattered points. The circles around the 2 n Delaunay triangles of n points of a Poisson
//! process, of which the widest gaps are, have radii beyond r spacings with probability (1 + x)
//! exp(-x), x = pi r^2 \cite miles_1970. \pre points > 0
double chance_gap(std::size_t points);

//! The mesh without the marked holes, cut along the line where the points end. Triangles across the
//! line are split; what remains is manifold where the mesh was.
TriangleSoup cut_out(const TriangleSoup& mesh, const SurfaceCoverage& coverage,
                     const SurfaceHoles& holes, const std::vector<char>& cut);

Index count_components(const TriangleSoup& mesh);
//! Sum of the genera of the components of a manifold mesh, as if every boundary loop were closed by
//! a disk.
int genus_of(const TriangleSoup& mesh);

} // namespace bot2nurbs
