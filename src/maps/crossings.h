// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

namespace bot2nurbs {

//! Parameters of crossings of a stretch of a mesh edge from `low` to `high`, in the order in which
//! they must be: moved by as little as it takes to keep a share of the stretch from its ends and
//! from each other, so that pieces of faces do not degenerate. The order of crossings matters,
//! their exact place does not. \return false when the stretch is too short to hold them.
bool keep_apart(std::vector<double>& t, double low, double high);

} // namespace bot2nurbs
