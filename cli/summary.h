// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/convert.h"

#include <string>
#include <vector>

namespace bot2nurbs::cli {

//! The end of a conversion in words, a line each.
std::vector<std::string> summarise(const ConvertReport& report);

//! Seconds and memory of each stage, a line each.
std::vector<std::string> stage_lines(const std::vector<StageRecord>& stages);

//! What --check prints, a line each.
std::vector<std::string> describe(const ConvertOptions& options, const InputReport& report);

//! What --validate-domain prints, a line each.
std::vector<std::string> describe(const DomainFileReport& report);

} // namespace bot2nurbs::cli
