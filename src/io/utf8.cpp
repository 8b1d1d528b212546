// SPDX-License-Identifier: MIT
#include "io/utf8.h"

#include <array>

namespace bot2nurbs {

std::uint32_t next_code_point(std::string_view& s)
{
    constexpr std::uint32_t bad = 0xFFFD;
    const auto byte_at = [&](std::size_t i) { return static_cast<std::uint8_t>(s[i]); };
    const std::uint8_t lead = byte_at(0);
    const std::size_t length = lead < 0x80             ? 1
                               : (lead & 0xE0) == 0xC0 ? 2
                               : (lead & 0xF0) == 0xE0 ? 3
                               : (lead & 0xF8) == 0xF0 ? 4
                                                       : 0;
    if (length == 0 || length > s.size()) {
        s.remove_prefix(1);
        return bad;
    }
    std::uint32_t c = length == 1 ? lead : lead & (0xFFu >> (length + 1));
    for (std::size_t i = 1; i < length; ++i) {
        if ((byte_at(i) & 0xC0) != 0x80) {
            s.remove_prefix(1);
            return bad;
        }
        c = c << 6 | (byte_at(i) & 0x3Fu);
    }
    s.remove_prefix(length);
    constexpr std::array<std::uint32_t, 5> smallest{0, 0, 0x80, 0x800, 0x10000};
    const bool surrogate = c >= 0xD800 && c <= 0xDFFF;
    return c < smallest[length] || c > 0x10FFFF || surrogate ? bad : c;
}

} // namespace bot2nurbs
