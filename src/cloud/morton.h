// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

namespace bot2nurbs {

//! Coordinates on a grid.
using Lattice = std::array<std::uint32_t, 3>;

namespace morton {

//! Coordinates below 2^21 fit a key.
inline constexpr int most_bits = 21;

//! The bits of x with two zeros in front of each.
inline std::uint64_t spread(std::uint64_t x)
{
    x = (x | x << 32) & 0x001f00000000ffffu;
    x = (x | x << 16) & 0x001f0000ff0000ffu;
    x = (x | x << 8) & 0x100f00f00f00f00fu;
    x = (x | x << 4) & 0x10c30c30c30c30c3u;
    x = (x | x << 2) & 0x1249249249249249u;
    return x;
}

inline std::uint32_t gather(std::uint64_t x)
{
    x &= 0x1249249249249249u;
    x = (x | x >> 2) & 0x10c30c30c30c30c3u;
    x = (x | x >> 4) & 0x100f00f00f00f00fu;
    x = (x | x >> 8) & 0x001f0000ff0000ffu;
    x = (x | x >> 16) & 0x001f00000000ffffu;
    x = (x | x >> 32) & 0x00000000001fffffu;
    return static_cast<std::uint32_t>(x);
}

//! The key of a place on the grid: its bits interleaved, x lowest. Keys ascend along a Z-shaped
//! curve, on which the eight children of a cell follow each other.
inline std::uint64_t encode(const Lattice& p)
{
    return spread(p[0]) | spread(p[1]) << 1 | spread(p[2]) << 2;
}

inline Lattice decode(std::uint64_t key)
{
    return {gather(key), gather(key >> 1), gather(key >> 2)};
}

} // namespace morton

} // namespace bot2nurbs
