// SPDX-License-Identifier: MIT
#pragma once

//! The groups of rules behind check_brep. Each group relies on the groups before it.

#include "bot2nurbs/brep.h"

#include <string>
#include <vector>

namespace bot2nurbs {

//! Collects violations.
class DefectList {
public:
    void add(const char* rule, Index element, std::string message)
    {
        defects_.push_back({rule, std::move(message), element});
    }
    bool empty() const { return defects_.empty(); }
    std::vector<BrepDefect> take() { return std::move(defects_); }

private:
    std::vector<BrepDefect> defects_;
};

//! Every stored index names an element. Cheap: writers ask this before they walk the arrays.
void check_indices(const Brep& brep, DefectList& defects);

//! Curves and surfaces have matching array sizes, valid knots and finite numbers.
void check_splines(const Brep& brep, DefectList& defects);

//! Lists that point at each other agree. \pre check_indices found nothing
void check_lists(const Brep& brep, DefectList& defects);

//! Trim types, loop chains, edge uses, orientation across edges, fans at vertices; fills the counts
//! of the report. \pre check_lists found nothing
void check_topology(const Brep& brep, DefectList& defects, BrepReport& report);

//! Domains, trims against the parameter rectangle, edges against faces and vertices, degenerate
//! elements; fills max_edge_gap. \pre check_lists and check_splines found nothing
void check_geometry(const Brep& brep, DefectList& defects, DefectList& warnings,
                    BrepReport& report);

//! The vertex where a trim starts, by its edge.
Index start_vertex(const Brep& brep, const BrepTrim& trim);

//! Per trim: the trim that follows it in its loop. \pre check_lists found nothing
std::vector<Index> next_trims(const Brep& brep);

//! Component of every face, numbered in order of first face; faces are connected over edges.
struct FaceComponents {
    std::vector<Index> of_face;
    Index count = 0;
};
FaceComponents face_components(const Brep& brep);

//! Distance below which two positions of a model are the same: a share of its diagonal that is
//! well above the rounding of doubles and well below anything a modeller can see.
inline constexpr double coincidence_share = 1e-12;

//! Box around all control points and vertices.
Box3 bounding_box(const Brep& brep);

} // namespace bot2nurbs
