// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"

#include <cstdint>
#include <vector>

namespace bot2nurbs {

//! A key and where it came from.
struct KeyedSlot {
    std::uint64_t key = 0;
    Index slot = 0;

    friend bool operator<(const KeyedSlot& a, const KeyedSlot& b)
    {
        return a.key != b.key ? a.key < b.key : a.slot < b.slot;
    }
};

//! Sorts by key, then slot. Keys are below 2^bits. Cost O(n log n), on all threads; polls for
//! cancellation. \return false when cancelled: the order is then any.
bool sort_keys(std::vector<KeyedSlot>& items, int bits, const Context& context);

//! Sorts keys and keeps one of each. As sort_keys.
bool sort_unique(std::vector<std::uint64_t>& keys, int bits, const Context& context);

} // namespace bot2nurbs
