// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/brep.h"
#include "bot2nurbs/cloud_report.h"
#include "bot2nurbs/curve_deviation.h"
#include "bot2nurbs/deviation.h"
#include "bot2nurbs/fit_network.h"
#include "bot2nurbs/hausdorff_bound.h"
#include "bot2nurbs/layout.h"
#include "bot2nurbs/layout_quality.h"
#include "bot2nurbs/refine_to_tolerance.h"
#include "bot2nurbs/repair_mesh.h"
#include "bot2nurbs/spline_network.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace bot2nurbs {

struct ConvertOptions;

//! Something the user should know that did not stop the conversion.
struct Warning {
    std::string code; //!< Stable name, such as "self_intersection".
    std::string message;
    Index element = invalid_index; //!< The first element concerned, as the message numbers it.
};

//! The quadrilateral domain of one component, in numbers.
struct DomainReport {
    std::string source;    //!< "eck", "supplied", ...
    std::string signature; //!< Of the repaired component.
    Index faces = 0, edges = 0, vertices = 0;
    Index extraordinary = 0, max_valence = 0;
    std::vector<Index> valences; //!< Number of vertices with valence 0, 1, 2, ...
};

//! Sharp edges of one component: edges of the mesh, not of the domain.
struct FeatureReport {
    Index detected_edges = 0;       //!< Edges that turn by the angle of a feature or more.
    Index kept_edges = 0;           //!< Edges of the creases that stay sharp.
    Index creases = 0, corners = 0; //!< Chains of kept edges, and where they turn.
    double clear_share = 1.0;       //!< MeshFeatures::clear_share.
    //! Detected edges that were smoothed over, as vertices of the input.
    std::vector<std::array<Index, 2>> smoothed;
};

//! What became of the tolerance asked for. Distances in units of the input.
struct ToleranceReport {
    double tolerance = 0.0;
    bool met = false; //!< Proven of the surface as written.
    RefinementEnd termination = RefinementEnd::tolerance_met;
    DistanceBounds distance; //!< Of the surface as written, both ways; of points, theirs from it.
    FarPlace worst;          //!< Where distance.lower is.
    std::vector<RefinementRound> rounds;
    Index best = 0; //!< The round that is written.
};

//! How a mesh of quads became the domain of a component.
struct QuadsReport {
    double largest_move = 0.0;             //!< Of a vertex of the quads, to its place on the mesh.
    Index farthest_vertex = invalid_index; //!< That vertex, as the file of the quads numbers it.
    Index crease_edges = 0;                //!< Edges of the quads that are creases.
    double largest_detour = 1.0; //!< Length of an edge on the mesh over the distance of its ends.
    //! The ends of that edge, as the file of the quads numbers them.
    std::array<Index, 2> detour_edge{invalid_index, invalid_index};
};

//! What became of one connected component of the input.
struct ComponentOutcome {
    Index first_face = invalid_index; //!< Its first triangle, in the numbering of the input.
    Index vertices = 0, faces = 0;    //!< After repair.
    int genus = 0;
    Index boundary_loops = 0;
    double source_volume = 0.0; //!< Of the mesh, after repair; 0 when open.
    double diagonal = 0.0;      //!< Of the component's box, in units of the input.

    FeatureReport features;
    DomainReport domain;
    std::optional<LayoutSummary> layout; //!< Absent when the domain was supplied.
    std::optional<QuadsReport> quads;    //!< Present when the layout was a mesh of quads.
    LayoutQuality quality;               //!< Of the domain.
    FitSummary fit;                      //!< Distances in units of the input.
    //! In units of the input. For an input of points the source is the points on the way to the
    //! surface, and the mesh through them on the way back.
    Deviation deviation;
    std::optional<HausdorffBound> bound;      //!< Of the surface as written against the input.
    CurveDeviations curves;                   //!< In units of the input.
    std::optional<ToleranceReport> tolerance; //!< Where one was asked for.
    Continuity continuity;                    //!< Of the surface as written.
    BrepReport brep;
    Index brep_faces = 0, brep_edges = 0, brep_vertices = 0;
};

struct OutputFile {
    std::string path, format;
    std::uint64_t bytes = 0;
};

//! What a conversion read, did and wrote.
struct ConvertReport {
    Index input_vertices = 0, input_faces = 0; //!< Triangles, before repair; see `cloud`.
    std::optional<CloudReport> cloud;          //!< For an input of points: the mesh is made then.
    std::string units;                         //!< Written into files that carry a unit.
    double diagonal = 0.0;                     //!< Of the box of all components.
    std::vector<RepairNote> repairs;
    std::vector<ComponentOutcome> components;
    std::vector<OutputFile> outputs;
    std::vector<Warning> warnings;
    std::vector<StageRecord> stages;

    //! Largest distances over all components, mean squares pooled by their samples.
    Deviation deviation() const;
    //! Proven bounds of the largest distance of any component from its surface; nothing unless
    //! there are bounds for all.
    std::optional<DistanceBounds> distance() const;
    bool valid() const; //!< All B-Reps are; false when none was made.
    bool solid() const; //!< All B-Reps are; false when none was made.
    //! False when a tolerance was asked for and a component is not proven to be within it.
    bool tolerance_met() const;
};

//! The report as JSON: schema "bot2nurbs.report/1", docs/schema/report.schema.json.
std::string report_to_json(const ConvertOptions& options, const ConvertReport& report);

//! The report of a conversion that failed: the options, the error, and the stages that ended.
std::string failure_to_json(const ConvertOptions& options, const Error& error,
                            const std::vector<StageRecord>& stages);

//! Writes a report whole or not at all. Errors: cannot_write.
Status write_report(const std::string& json, const std::string& path);

} // namespace bot2nurbs
