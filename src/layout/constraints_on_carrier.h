// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/domain_constraints.h"
#include "bot2nurbs/quad_domain.h"

#include <vector>

namespace bot2nurbs {

//! What DomainConstraints say in terms of the carrier that a layout is drawn on. A constraint keeps
//! its number, so that a conflict can name it.
struct CarrierConstraints {
    //! Two sites, as carrier vertices, and the number of the constraint that is about them.
    struct Pair {
        Index a = invalid_index, b = invalid_index;
        Index number = invalid_index;
    };
    std::vector<Index> sites;                      //!< Per site: its carrier vertex.
    std::vector<std::pair<Index, Index>> valences; //!< Carrier vertex, wanted number of quads.
    std::vector<Pair> joined, apart;               //!< Adjacencies required, forbidden.
    std::vector<Pair> paired, unpaired;            //!< Pairings required, forbidden.

    bool binds() const { return !sites.empty(); }
};

//! The paths of the constraints as features, those of kind corner included.
std::vector<FeaturePath> constrained_paths(const DomainConstraints& constraints);

//! Conflicts that the source alone shows: an edge of two features of different kinds, an inner edge
//! called boundary.
Status check_constrained_paths(const DomainConstraints& constraints, const ManifoldMesh& source);

//! `point_vertices` has the carrier vertex of every site given by a point, in their order. Errors:
//! constraint_conflict when two sites are the same vertex.
Result<CarrierConstraints> place_constraints(const DomainConstraints& constraints,
                                             const std::vector<Index>& point_vertices);

//! Marks for every required adjacency a shortest chain of mesh edges between its sites, which meets
//! no marked edge and no other site on the way. Errors: constraint_conflict naming the adjacency
//! that finds no way.
Status route_joints(const ManifoldMesh& mesh, const CarrierConstraints& constraints,
                    std::vector<char>& marks);

//! Whether a finished domain keeps all constraints. Errors: constraint_conflict naming the first
//! that it does not.
Status check_kept(const QuadDomain& domain, const ManifoldMesh& source,
                  const DomainConstraints& wanted, const CarrierConstraints& constraints);

} // namespace bot2nurbs
