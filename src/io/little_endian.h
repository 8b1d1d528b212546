// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstring>
#include <type_traits>

namespace bot2nurbs {

//! The unsigned integer stored at p, lowest byte first, on any machine.
template <class T> T little_endian(const char* p)
{
    static_assert(std::is_unsigned_v<T>);
    T value = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i)
        value = static_cast<T>(
            value | static_cast<T>(static_cast<T>(static_cast<unsigned char>(p[i])) << (8 * i)));
    return value;
}

//! The value of another type with the same bits.
template <class T, class U> T bit_cast(U from)
{
    static_assert(sizeof(T) == sizeof(U) && std::is_trivially_copyable_v<T>);
    T value;
    std::memcpy(&value, &from, sizeof value);
    return value;
}

} // namespace bot2nurbs
