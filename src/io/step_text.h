// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace bot2nurbs {

//! What stands for name number i in the text given to `finish_step_text`.
std::string step_name_mark(std::size_t i);

//! The text of a STEP file as Open CASCADE prints it, made ready: marks replaced by names (UTF-8;
//! characters outside ASCII become \X2\ and \X4\ directives of ISO 10303-21), strings that were
//! broken over lines joined, and every real number in the shortest form that reads back the same.
std::string finish_step_text(std::string_view text, const std::vector<std::string>& names);

} // namespace bot2nurbs
