// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string_view>

namespace bot2nurbs {

//! Reads one code point of UTF-8 and moves past it. Bytes that are not UTF-8 give U+FFFD, one each.
//! \pre text is not empty
std::uint32_t next_code_point(std::string_view& text);

} // namespace bot2nurbs
