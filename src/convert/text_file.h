// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/result.h"

#include <string>

namespace bot2nurbs {

//! All bytes of a file. Errors: cannot_read.
Result<std::string> read_text(const std::string& path);

//! The error with the file's name in front.
Error in_file(const std::string& path, Error error);

} // namespace bot2nurbs
