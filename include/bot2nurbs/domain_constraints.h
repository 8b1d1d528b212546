// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/manifold_mesh.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace bot2nurbs {

//! A point that must become a vertex of the domain.
struct ConstraintSite {
    std::optional<Index> vertex;  //!< A source vertex; absent: `point`.
    SourcePoint point;            //!< A place on a source face, where `vertex` is absent.
    std::optional<Index> valence; //!< Wanted number of quads at it: a hint.
};

//! What a feature path is in the surface.
enum class FeatureKind {
    smooth_seam, //!< A domain edge like any other: tangent planes agree across it.
    crease,      //!< Only positions agree across it.
    boundary,    //!< The surface ends here.
    corner,      //!< Its vertices are corners: a crease or boundary turns there.
};

//! A path of source edges that must become domain edges.
struct RequiredPath {
    std::vector<Index> vertices; //!< Source vertices in order; neighbours share a mesh edge.
};

struct FeaturePath {
    FeatureKind kind = FeatureKind::crease;
    std::vector<Index> vertices; //!< As RequiredPath; of kind corner one vertex is enough.
};

//! Whether something must or must not be.
enum class Demand { required, forbidden };

//! Two sites whose Voronoi tiles must, or must not, be neighbours.
struct AdjacencyConstraint {
    Demand demand = Demand::required;
    std::array<Index, 2> sites{}; //!< In DomainConstraints::sites.
};

//! Two triangles of the base complex that must, or must not, be joined into one quad: named by the
//! two sites of the edge they share.
struct PairingConstraint {
    Demand demand = Demand::required;
    std::array<Index, 2> sites{}; //!< In DomainConstraints::sites.
};

//! What a person asks of the automatic layout. Data only: a layout that honours them says so.
struct DomainConstraints {
    std::string source_signature; //!< signature() of the source mesh.
    std::vector<ConstraintSite> sites;
    std::vector<RequiredPath> paths;
    std::vector<FeaturePath> features;
    std::vector<AdjacencyConstraint> adjacencies;
    std::vector<PairingConstraint> pairings;
    std::optional<Index> patches; //!< Wanted number of quads: a hint.

    bool empty() const
    {
        return sites.empty() && paths.empty() && features.empty() && adjacencies.empty() &&
               pairings.empty() && !patches;
    }
};

//! "bot2nurbs.constraints/1" (docs/schema/constraints.schema.json). Reading it back gives the same
//! value and writing that the same bytes.
std::string constraints_to_json(const DomainConstraints& constraints);

//! Reads constraints and checks them against the source: indices exist, paths run along mesh edges
//! without repeating a vertex (their end may be their start), sites differ, nothing is both
//! required and forbidden. Errors: cannot_read, stale_domain, invalid_domain naming the element by
//! its JSON pointer.
Result<DomainConstraints> constraints_from_json(const std::string& text,
                                                const ManifoldMesh& source);

//! Of several components: a list of the same objects; of one component the object alone.
std::string constraint_list_to_json(const std::vector<DomainConstraints>& constraints);

//! Reads an object or a list of them. One result for each source, with nothing asked for where no
//! object has its signature. Errors: as constraints_from_json; stale_domain also for an object
//! that belongs to none of the sources.
Result<std::vector<DomainConstraints>>
constraint_list_from_json(const std::string& text, const std::vector<ManifoldMesh>& sources);

} // namespace bot2nurbs
