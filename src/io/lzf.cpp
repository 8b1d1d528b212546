// SPDX-License-Identifier: MIT
#include "io/lzf.h"

namespace bot2nurbs {

bool unpack_lzf(std::string_view packed, std::string& unpacked)
{
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(packed[i]); };
    std::size_t in = 0, out = 0;
    while (in < packed.size()) {
        const unsigned control = byte(in++);
        if (control < 32) {
            const std::size_t count = control + 1;
            if (count > packed.size() - in || count > unpacked.size() - out)
                return false;
            unpacked.replace(out, count, packed.substr(in, count));
            in += count;
            out += count;
            continue;
        }
        std::size_t count = control >> 5;
        if (count == 7) {
            if (in == packed.size())
                return false;
            count += byte(in++);
        }
        count += 2;
        if (in == packed.size())
            return false;
        const std::size_t back = (std::size_t{control & 31} << 8 | byte(in++)) + 1;
        if (back > out || count > unpacked.size() - out)
            return false;
        // The run may overlap what it copies from: byte by byte.
        for (; count > 0; --count, ++out)
            unpacked[out] = unpacked[out - back];
    }
    return out == unpacked.size();
}

} // namespace bot2nurbs
