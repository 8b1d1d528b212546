// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/domain_constraints.h"
#include "bot2nurbs/quad_domain.h"

#include <optional>

namespace bot2nurbs {

struct LayoutOptions {
    std::optional<Index> patches; //!< Wanted number of quads; by default chosen from the shape.
    //! Chains of source edges that become edges of the domain: seams and creases; of kind corner,
    //! vertices where a crease or the boundary turns. The boundary itself need not be named.
    std::vector<FeaturePath> features;
    //! What a person asks for: honoured or refused, never dropped. Where its features meet those
    //! above, they win. Its hint of a number of patches counts where `patches` is absent.
    DomainConstraints constraints;
    bool split_triangles = false; //!< Use the three-quads fallback in place of pairing.
    std::uint64_t seed = 0; //!< Reserved for tie-breaking experiments; results are deterministic.
};

//! What the automatic layout did, for the report.
struct LayoutSummary {
    Index sites = 0;       //!< Voronoi sites after the conditions hold.
    Index sites_added = 0; //!< Of these, added because a condition failed.
    Index target_patches = 0;
    //! Charts that needed uniform weights, and the exact fallback; counted when charts are made.
    Index uniform_maps = 0, exact_maps = 0;
    bool subdivided = false; //!< The triangle-to-three-quads fallback was used.
    std::vector<std::string> notes;
};

struct LayoutResult {
    QuadDomain domain;
    LayoutSummary summary;
};

//! The automatic layout of one connected mesh (Eck et al. 1995, Eck and Hoppe 1996). Its boundary
//! becomes that of the domain. Errors: bad_option; layout_failed; constraint_conflict, naming the
//! constraints that cannot be met together; cancelled.
Result<LayoutResult> build_layout(const ManifoldMesh& source, const LayoutOptions& options,
                                  Context& context);

} // namespace bot2nurbs
