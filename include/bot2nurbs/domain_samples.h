// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/quad_domain.h"

#include <optional>
#include <string>
#include <vector>

namespace bot2nurbs {

//! How densely the source is sampled through its charts.
struct SampleOptions {
    //! Grid samples of a quad per direction, at least 4: 12 puts 3 x 3 into each of its 4 x 4
    //! Bezier pieces, so that no piece is without data whatever the mesh.
    Index per_side = 12;
    //! Source vertices of a quad that become samples too, so that detail finer than the grid is
    //! seen; beyond this number they are thinned evenly. 0: none.
    Index max_vertices = 144;
    //! Dihedral angle in degrees, 0 to 180: across an edge that turns more, normals are not
    //! averaged.
    double smooth_angle = 40.0;

    std::optional<Error> check() const;
};

//! Samples of the source from all over its faces, with their first place in the domain: for each
//! quad a grid over (u, v), at cell midpoints so that quads do not repeat each other's sides, then
//! its source vertices (a vertex on a side counts for the quad of smallest index).
//!
//! 1. positions[i] == source.at(source_point[i]) to the bit; the charts place it at domain[i].
//! 2. Every Bezier piece has at least floor(per_side / 4)^2 samples.
//! 3. Weights are positive; those of a quad sum to its area (up to rounding): a grid sample stands
//!    for the area of its cell, a vertex for a third of the triangles around it, and both kinds
//!    share the area by their numbers.
//! 4. Normals are unit: the average of the corner normals of the face, themselves averages by angle
//!    over the faces around a vertex that are not separated by an edge sharper than smooth_angle;
//!    so they follow a smooth shape, and keep to the flat sides of a sharp one. Where that average
//!    turns away from the face, the face's own normal.
//! 5. The same for any thread count.
//!
//! Cost linear in charts and samples. Errors: bad_option, invalid_domain (naming a quad whose chart
//! is empty), cancelled.
Result<SurfaceSampleSet> make_samples(const ManifoldMesh& source,
                                      const std::vector<QuadChart>& charts,
                                      const SampleOptions& options, Context& context);

//! Samples of the curves of a domain, its creases and boundary: marks those of `samples` that start
//! on one, and adds `per_side` and the two ends along every sharp edge, each with the mean weight
//! of a sample of its quad. Cost linear in charts and samples.
void add_curve_samples(const ManifoldMesh& source, const QuadComplex& complex,
                       const std::vector<QuadChart>& charts, const SampleOptions& options,
                       SurfaceSampleSet& samples);

//! Points that a surface is fitted to in place of the mesh that was made through them, which then
//! says no more than how the surface is connected, and where it is when there are no points.
struct PointData {
    std::vector<Vec3> positions;
    std::vector<double> weights; //!< Per point: the area it stands for times its confidence; > 0.
    std::vector<SourcePoint> source; //!< Per point: its closest place of the mesh.
    double noise = 0.0;              //!< See FitOptions::noise, in units of the points.
    double least_deviation = 0.0;    //!< See FitOptions::least_deviation.
};

//! Closest places of the mesh. Cost O((F + n) log F). Errors: cancelled. The same for any thread
//! count.
Result<std::vector<SourcePoint>> closest_places(const ManifoldMesh& source,
                                                const std::vector<Vec3>& points, Context& context);

//! Looks for places of the source, which must outlive it, for fit_network(). Cost O(F log F), then
//! O(log F) each.
NearestPlace nearest_place(const ManifoldMesh& source, const Context& context);

//! Given points as samples: each where the charts map its place of the source. Normals stay
//! unknown. Cost linear. Errors: invalid_domain (no chart covers a face), cancelled. The same for
//! any thread count. \pre the arrays of `points` are of one length
Result<SurfaceSampleSet> project_samples(const ManifoldMesh& source,
                                         const std::vector<QuadChart>& charts,
                                         const PointData& points, Context& context);

//! The samples of a fit to points: project_samples(), add_anchor_samples() and add_curve_samples()
//! one after the other; the first samples are the points. \param anchors how many samples of the
//! source stand in for points. Errors: those of the three.
Result<SurfaceSampleSet> make_point_samples(const ManifoldMesh& source, const QuadComplex& complex,
                                            const std::vector<QuadChart>& charts,
                                            const PointData& points, Index& anchors,
                                            Context& context);

//! Adds a sample of the source in every Bezier piece (4 x 4 a quad) that has none, with the area of
//! the piece as weight: it holds the surface where there are no data. For samples without normals.
//! \return how many were added. Errors: those of make_samples.
Result<Index> add_anchor_samples(const ManifoldMesh& source, const std::vector<QuadChart>& charts,
                                 SurfaceSampleSet& samples, Context& context);

//! Unit normals of the three corners of every face, at 3 f + k, as make_samples uses them.
std::vector<Vec3> corner_normals(const ManifoldMesh& source, double smooth_angle, Context& context);

//! The set as JSON ("bot2nurbs.samples/1", docs/schema/samples.schema.json). Doubles come back to
//! the bit. `source_signature` is signature() of the source mesh.
std::string samples_to_json(const SurfaceSampleSet& samples, const std::string& source_signature);

//! Reads what samples_to_json wrote. Samples of a known place on the source are checked against its
//! faces. Errors: cannot_read (not JSON), stale_domain (made for another mesh), invalid_domain
//! naming the element by its JSON pointer.
Result<SurfaceSampleSet> samples_from_json(const std::string& text, const ManifoldMesh& source);

} // namespace bot2nurbs
