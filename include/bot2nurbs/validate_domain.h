// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/quad_domain.h"

#include <string>
#include <vector>

namespace bot2nurbs {

//! One violated rule of a domain: which, and which element. docs/algorithms/domain.md lists the
//! rules.
struct DomainDefect {
    std::string rule;    //!< Stable name, such as "path_crossing".
    std::string message; //!< Says what `element` numbers.
    Index element = invalid_index;
};

//! How evenly the charts of a domain map the unit square to the surface.
struct ChartStatistics {
    //! Ratio of the singular values of a chart, averaged over the area of a quad: 1 where shapes
    //! are kept. Mean over all quads, and the largest of a quad.
    double mean_stretch = 0.0, max_stretch = 0.0;
    Index worst_quad = invalid_index; //!< The quad with max_stretch.
    //! Area on the surface over area in parameters, relative to that of the whole quad: smallest
    //! and largest of any triangle. Positive: no foldover.
    double min_jacobian = 0.0, max_jacobian = 0.0;
    double min_area = 0.0, max_area = 0.0; //!< Of a quad's region on the source.
};

//! What validate_domain() found.
struct DomainValidation {
    std::vector<DomainDefect> defects; //!< At most 100 of a rule.
    std::size_t defect_count = 0;      //!< With those beyond.

    Index vertices = 0, edges = 0, quads = 0;
    Index extraordinary = 0, max_valence = 0;
    int euler_characteristic = 0;
    Index boundary_loops = 0;
    ChartStatistics charts; //!< All zero when a defect kept the charts from being made.

    bool valid() const { return defect_count == 0; }
};

struct ValidateOptions {
    //! Largest valence allowed. The masks of the splines exist for every valence but grow with it:
    //! at 16 their weights reach 44, and a digit and a half is lost.
    Index max_valence = 16;
    bool charts = true; //!< Compute the charts and check them: most of the time.
};

//! Checks that a domain is one: a manifold oriented complex of the topology of the source, drawn on
//! it without crossings so that every quad is a disk with its four sides, with charts that do not
//! fold. Nothing of the domain is taken for granted, except that its meshes and complex were made
//! by their build functions.
//!
//! Orders and orientations are decided exactly. Rules that make no sense while others fail are then
//! not looked at. Cost O(n log n) in the carrier and paths, and that of the charts. Errors:
//! cancelled.
Result<DomainValidation> validate_domain(const ManifoldMesh& source, const QuadDomain& domain,
                                         Context& context, const ValidateOptions& options = {});

//! The rules for charts alone: chart_source, chart_fold, chart_side, chart_continuity.
//! \pre one chart a quad; indices in the charts exist.
std::vector<DomainDefect> check_charts(const ManifoldMesh& source, const QuadComplex& complex,
                                       const std::vector<QuadChart>& charts,
                                       ChartStatistics& statistics);

} // namespace bot2nurbs
