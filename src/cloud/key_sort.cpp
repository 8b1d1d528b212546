// SPDX-License-Identifier: MIT
#include "cloud/key_sort.h"

#include "core/parallel.h"

#include <algorithm>

namespace bot2nurbs {

namespace {

//! Items are first put in buckets by their highest bits, so that sorting goes on in parallel and
//! looks at the context between buckets.
constexpr int bucket_bits = 12;
constexpr std::size_t items_per_poll = std::size_t{1} << 18;

std::uint64_t key_of(const KeyedSlot& item)
{
    return item.key;
}

std::uint64_t key_of(std::uint64_t key)
{
    return key;
}

template <class T> bool sort_in_buckets(std::vector<T>& items, int bits, const Context& context)
{
    const int shift = std::max(bits - bucket_bits, 0);
    std::vector<std::size_t> first((std::size_t{1} << bucket_bits) + 1, 0);
    const auto each = [&](const auto& use) {
        for (std::size_t i = 0; i < items.size(); ++i) {
            if (i % items_per_poll == 0 && context.cancelled())
                return false;
            use(items[i], static_cast<std::size_t>(key_of(items[i]) >> shift));
        }
        return true;
    };
    if (!each([&](const T&, std::size_t bucket) { ++first[bucket + 1]; }))
        return false;
    for (std::size_t b = 1; b < first.size(); ++b)
        first[b] += first[b - 1];
    std::vector<T> sorted(items.size());
    std::vector<std::size_t> next(first.begin(), first.end() - 1);
    if (!each([&](const T& item, std::size_t bucket) { sorted[next[bucket]++] = item; }))
        return false;
    items.swap(sorted);
    return for_each_chunk(context, first.size() - 1, 1, [&](std::size_t b, std::size_t) {
        std::sort(items.begin() + static_cast<std::ptrdiff_t>(first[b]),
                  items.begin() + static_cast<std::ptrdiff_t>(first[b + 1]));
    });
}

} // namespace

bool sort_keys(std::vector<KeyedSlot>& items, int bits, const Context& context)
{
    return sort_in_buckets(items, bits, context);
}

bool sort_unique(std::vector<std::uint64_t>& keys, int bits, const Context& context)
{
    if (!sort_in_buckets(keys, bits, context))
        return false;
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    return true;
}

} // namespace bot2nurbs
