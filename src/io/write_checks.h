// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/write_brep.h"

namespace bot2nurbs {

//! What every B-Rep writer asks first: options in range, something to write, and arrays that can be
//! walked.
Status check_writable(const std::vector<Brep>& breps, const WriteOptions& options);

} // namespace bot2nurbs
