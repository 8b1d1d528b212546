// SPDX-License-Identifier: MIT
#pragma once

//! The pieces that reports are made of. Layouts are those of docs/schema.

#include "bot2nurbs/convert.h"
#include "bot2nurbs/report.h"

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace bot2nurbs {

//! Keys in the order of writing: reports are read by people too.
using Json = nlohmann::ordered_json;

Json index_or_null(Index i);
Json error_json(const Error& error);
Json options_json(const ConvertOptions& options);
Json repair_json(const RepairNote& note);
//! `bounds`: proven, of the whole. `unit`: of the lengths.
Json deviation_json(const Deviation& deviation, const std::optional<DistanceBounds>& bounds,
                    double diagonal, const std::string& unit);
Json continuity_json(const Continuity& joins);
Json domain_json(const DomainReport& domain);
Json fit_json(const FitSummary& fit);
Json brep_json(Index faces, Index edges, Index vertices, const BrepReport& brep);
Json component_json(const ComponentOutcome& component, const std::string& unit);
Json stages_json(const std::vector<StageRecord>& stages);

//! Paths may hold bytes that are no UTF-8: they are replaced, so that writing never fails.
std::string text_of(const Json& report);

} // namespace bot2nurbs
