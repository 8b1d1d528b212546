// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"

#include <string>

namespace bot2nurbs {

//! The bytes of a file. Errors: cannot_read, also when it is empty; cancelled.
Result<std::string> read_bytes(const std::string& path, Context& context);

//! The extension of a path in lower case, without the dot; empty when there is none.
std::string extension(const std::string& path);

} // namespace bot2nurbs
