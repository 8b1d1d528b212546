// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/convert.h"

namespace bot2nurbs {

//! bad_option for the first option that contradicts the one that says where the layout comes from.
std::optional<Error> check_layout(const ConvertOptions& options);

} // namespace bot2nurbs
