// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/check_mesh.h"
#include "bot2nurbs/cloud_report.h"
#include "bot2nurbs/context.h"
#include "bot2nurbs/detect_features.h"
#include "bot2nurbs/fit_network.h"
#include "bot2nurbs/report.h"
#include "bot2nurbs/spline_network.h"
#include "bot2nurbs/validate_domain.h"
#include "bot2nurbs/write_brep.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace bot2nurbs {

//! Which sharp edges of the input stay sharp.
enum class FeatureMode {
    automatic, //!< Creases, where they are the edges of a part: see
               //!< FeatureOptions::least_clear_share.
    off,       //!< None: all are rounded.
    all,       //!< All creases of the angle asked for.
};

//! A length as people give it.
struct Length {
    double value = 0.0;    //!< In units of the input, or as a share.
    bool relative = false; //!< A share of the diagonal of the box of the whole input.

    //! In units of an input whose box has this diagonal.
    double of(double diagonal) const { return relative ? value * diagonal : value; }
};

//! What becomes of the connected components of the input.
enum class ComponentMode {
    all,     //!< Each is a B-Rep of its own, all in one file.
    largest, //!< Only the one with the largest area is converted.
    split,   //!< As all, in files of their own: part.3dm becomes part-1.3dm, part-2.3dm, ...
};

//! Whether the result must be closed.
enum class Closure {
    as_input, //!< Solids of closed components, open surfaces of open ones.
    open,     //!< The same, and that some are open needs no warning.
    solid,    //!< Open components are refused.
};

//! A fit that stays fair enough for reflections to run smoothly over the facets of a mesh, for a
//! little more distance.
inline FitOptions smooth_fit()
{
    FitOptions fit;
    fit.fairness_floor = 3e-5;
    return fit;
}

//! What convert() reads, makes and writes. Paths are as the operating system takes them.
struct ConvertOptions {
    //! Mesh: .stl, .obj, .ply or .off. Or points: these without faces, .xyz, .pts, .txt, .csv,
    //! .pwn, .pcd or .las; see read_points().
    std::string input;
    //! B-Rep files: .3dm, .step, .stp or .brep. May be empty when domain_out
    //! or tessellation is given.
    std::vector<std::string> outputs;

    //! Wanted number of patches of each component; by default chosen from the shape. At least 6.
    //! With a tolerance: how many to start from.
    std::optional<Index> patches;
    //! Patches are refined until the distance between input and surface, both ways, is proven to be
    //! within this, or refinement ends for another reason.
    std::optional<Length> tolerance;
    //! With a tolerance: most patches of each component.
    std::optional<Index> max_patches;
    SplineScheme spline = SplineScheme::peters;
    //! Knots to write; by default those of the paper in .3dm, and in .step and .brep the C1 form,
    //! because CAD kernels take a triple knot for a break.
    std::optional<KnotForm> knots;
    //! With a tolerance, fairness goes down to the floor of FitOptions at most.
    FitOptions fit = smooth_fit();

    FeatureMode features = FeatureMode::automatic;
    //! How creases are found. With FeatureMode::all its least_clear_share counts as 0.
    FeatureOptions feature_options;
    Closure closure = Closure::as_input;

    CloudOptions cloud; //!< For an input of points.
    ComponentMode components = ComponentMode::all;
    //! Holes up to this size, the diagonal of their box, are filled before anything else; >= 0. Of
    //! points: places without any, in place of cloud.reconstruct.fill_holes.
    std::optional<Length> fill_holes;
    //! Vertices of open edges up to so far apart become one; by default copies only. At most a
    //! tenth of the diagonal. \see repair_mesh()
    std::optional<Length> weld;

    bool repair = true;  //!< Make harmless repairs; false: reject an input that needs any.
    bool strict = false; //!< Reject self-intersecting input instead of warning.

    //! The input is a subdivision cage, a mesh of quads, and what is converted is the limit surface
    //! of Catmull and Clark's subdivision, a patch for each quad. See cage_surface. Creases are not
    //! looked for, nor whether it crosses itself.
    bool cage = false;
    //! Mesh file of quads near the input that become the patches, instead of the automatic layout:
    //! .obj, .ply or .off; a connected piece for each component. See import_quads.
    std::optional<std::string> quads;
    //! Domain file to use instead of the automatic layout; it must hold a domain for each
    //! component and none for others.
    std::optional<std::string> domain_in;
    //! Where to write the domains of all components.
    std::optional<std::string> domain_out;
    //! Constraint file that the automatic layout keeps to; components that it does not name are
    //! laid out freely.
    std::optional<std::string> constraints;
    //! Where to write the constraints that the layouts kept to and the vertices they chose, as
    //! constraints.
    std::optional<std::string> constraints_out;
    //! Where to write a tessellation (binary PLY) for inspection: per vertex the normal, patch,
    //! parameters, signed distance to the source, and at patch corners the valence.
    std::optional<std::string> tessellation;

    //! Archive version, STEP schema, unit. An empty unit: as the input says, else millimetres.
    WriteOptions write;
    std::uint64_t seed = 0; //!< Reserved for tie-breaking experiments.

    //! The first option that is out of its range, or contradicts another, or names a file that
    //! cannot be written: what can be known before any work is done.
    std::optional<Error> check() const;
};

//! Runs the whole way from a mesh file to B-Rep files: read, check, repair, and for each connected
//! component layout (or a supplied domain), charts, samples, spline network, fit, B-Rep; then
//! writes all components as solids of one file, in each format asked for. A cloud of points first
//! gets normals and a mesh (find_normals(), reconstruct_surface()); the mesh says the topology and
//! where to start, the surface is fitted to the points.
//!
//! Guarantees:
//! 1. every file is written whole or not at all, and none before every component has passed its
//!    checks;
//! 2. the same bytes for any thread count;
//! 3. coordinates come out in the place and units they came in.
//! A tolerance that is not met is no error: the best surface is written, and the report says so.
//! Cancel through the context. Errors: those of the stages; open_mesh, self_intersecting (with
//! strict), stale_domain, constraint_conflict,
//! bad_option, cannot_write.
Result<ConvertReport> convert(const ConvertOptions& options, Context& context);

//! What the first steps of convert() say of an input.
struct InputReport {
    MeshReport mesh; //!< Of the file as it is; of points, of the mesh through them.
    std::optional<CloudReport> cloud; //!< For an input of points.
    std::vector<RepairNote> repairs;  //!< What convert() would change.
    std::optional<Error> rejection;   //!< Why convert() would refuse it; absent when it would not.
};

//! Reads and checks `options.input` without converting it. Errors: those of read_mesh; cancelled.
Result<InputReport> check_input(const ConvertOptions& options, Context& context);

//! The report as JSON, schema "bot2nurbs.check/1".
std::string input_report_to_json(const ConvertOptions& options, const InputReport& report);

//! What validate_domain() says of each component's domain in a file.
struct DomainFileReport {
    std::vector<DomainValidation> components; //!< In the order of the components of the input.
    std::optional<Error> rejection;           //!< Why convert() would refuse the file.
};

//! Checks the domain file `options.domain_in` against `options.input` without converting. Errors:
//! those of the first stages of convert(); cannot_read; cancelled. A file that belongs to another
//! mesh or breaks a rule is no error but a rejection.
Result<DomainFileReport> check_domain(const ConvertOptions& options, Context& context);

//! The report as JSON, schema "bot2nurbs.domain-check/1".
std::string domain_report_to_json(const ConvertOptions& options, const DomainFileReport& report);

} // namespace bot2nurbs
