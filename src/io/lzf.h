// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace bot2nurbs {

//! Unpacks a block of LZF, the compression of binary_compressed PCD files, into `unpacked`, whose
//! size says how many bytes there are. \return false when the block is broken or gives another
//! number of bytes.
//!
//! A block is a row of runs. A first byte c below 32 is followed by c + 1 bytes to copy. Above, the
//! three high bits of c and, where they are all set, one more byte give a length L (the run has
//! L + 2 bytes), the five low bits of c and the next byte a distance (back by distance + 1).
bool unpack_lzf(std::string_view packed, std::string& unpacked);

} // namespace bot2nurbs
