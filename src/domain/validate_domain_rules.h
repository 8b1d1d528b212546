// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/validate_domain.h"

#include <map>
#include <string>
#include <vector>

namespace bot2nurbs {

//! Collects defects, at most a fixed number of each rule in full.
class DefectList {
public:
    void add(const char* rule, std::string message, Index element);
    bool empty() const { return count_ == 0; }
    bool has(const char* rule) const { return of_rule_.count(rule) != 0; }
    std::size_t count() const { return count_; }
    const std::vector<DomainDefect>& defects() const { return defects_; }

private:
    std::vector<DomainDefect> defects_;
    std::map<std::string, std::size_t> of_rule_;
    std::size_t count_ = 0;
};

//! Rules carrier_vertex, carrier_face, carrier_tiling. \pre array sizes and indices are right.
void check_carrier(const ManifoldMesh& source, const CarrierMesh& carrier, DefectList& defects);

//! Rules path_point, path_step, path_crossing, vertex_order, boundary, region, in this order; one
//! is looked at when those before hold. \pre indices are right.
void check_paths(const QuadDomain& domain, DefectList& defects);

} // namespace bot2nurbs
