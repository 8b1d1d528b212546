// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/quad_domain.h"

#include <optional>

namespace bot2nurbs {

struct LayoutOptions {
    std::optional<Index> patches; //!< Wanted number of quads; by default chosen from the shape.
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

//! The automatic layout of one closed connected mesh (Eck et al. 1995, Eck and Hoppe 1996).
//! Errors: open_mesh, layout_failed, cancelled.
Result<LayoutResult> build_layout(const ManifoldMesh& source, const LayoutOptions& options,
                                  Context& context);

} // namespace bot2nurbs
