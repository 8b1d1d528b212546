// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/cloud_report.h"

#include <nlohmann/json.hpp>

namespace bot2nurbs {

//! The member "cloud" of reports. `fitted`: a surface was fitted, so that there are distances.
nlohmann::ordered_json cloud_json(const CloudReport& report, bool fitted);

//! The options for clouds, as used.
nlohmann::ordered_json cloud_options_json(const CloudOptions& options);

} // namespace bot2nurbs
