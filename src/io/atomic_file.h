// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/result.h"

#include <string>
#include <string_view>

namespace bot2nurbs {

//! Writes a file whole or not at all: to a temporary name in the same folder, synced, renamed over
//! the path. On any error the temporary file is gone and a file at the path is as it was. A path
//! that is a link is followed; a device or pipe is written directly. An existing file keeps its
//! access rights.
//! Errors: cannot_write with the reason.
Status write_whole_file(const std::string& path, std::string_view bytes);

} // namespace bot2nurbs
