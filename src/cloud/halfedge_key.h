// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/vec.h"

#include <cstdint>

namespace bot2nurbs {

//! A directed edge as a number, for hashing.
inline std::uint64_t halfedge_key(Index from, Index to)
{
    return (std::uint64_t{from} << 32U) | to;
}

} // namespace bot2nurbs
