// SPDX-License-Identifier: MIT
#include "refine/progress.h"

#include <algorithm>

namespace bot2nurbs {

namespace {

constexpr double least_progress = 0.1;
constexpr double growth_in_vain = 1.2;
constexpr std::size_t most_waits = 8;

bool falls(double value, double before)
{
    return before > 0.0 && value <= (1.0 - least_progress) * before;
}

} // namespace

bool stalled(const std::vector<RefinementRound>& rounds, std::size_t first, std::size_t waits)
{
    std::size_t progress = first;
    double distance = rounds[first].distance.lower, exceeding = rounds[first].exceeding;
    for (std::size_t i = first + 1; i < rounds.size(); ++i) {
        const RefinementRound& r = rounds[i];
        if (!falls(r.distance.lower, distance) && !falls(r.exceeding, exceeding))
            continue;
        progress = i;
        distance = std::min(distance, r.distance.lower);
        exceeding = std::min(exceeding, double(r.exceeding));
    }
    const std::size_t waited = rounds.size() - 1 - progress;
    const bool grown = rounds.back().patches >= growth_in_vain * rounds[progress].patches;
    return waited >= most_waits || (waited >= waits && grown);
}

} // namespace bot2nurbs
