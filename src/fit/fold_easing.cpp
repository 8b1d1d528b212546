// SPDX-License-Identifier: MIT
#include "fit/fold_easing.h"

#include <algorithm>
#include <cmath>

namespace bot2nurbs {

namespace {

constexpr int most_exponent = 5;
//! Quads that touch are solved for together, up to so many, as the cost is that of a dense system.
constexpr std::size_t most_together = 8;

} // namespace

FoldEasing::Region FoldEasing::grow(Index quad, const std::vector<Index>& folds,
                                    std::vector<char>& left) const
{
    Region region;
    region.core = {quad};
    region.back = folds[quad] == 0;
    left[quad] = 0;
    for (std::size_t i = 0; i < region.core.size(); ++i)
        for (const Index r : response_.with_neighbours({region.core[i]}))
            if (left[r] && (folds[r] == 0) == region.back && region.core.size() < most_together) {
                left[r] = 0;
                region.core.push_back(r);
            }
    const bool wide = std::any_of(region.core.begin(), region.core.end(),
                                  [&](Index q) { return tried_[q].wide; });
    region.quads = wide ? response_.with_neighbours(region.core) : region.core;
    region.near = response_.with_neighbours(region.quads);
    return region;
}

std::vector<FoldEasing::Region> FoldEasing::next(const std::vector<Index>& folds)
{
    tried_ = now_;
    std::vector<char> left(now_.size(), 0);
    for (std::size_t q = 0; q < now_.size(); ++q) {
        Raise& raise = tried_[q];
        if (raise.done || (folds[q] == 0 && raise.exponent == 0))
            continue;
        left[q] = 1;
        if (folds[q] == 0) {
            --raise.exponent;
        } else if (raise.exponent < most_exponent) {
            ++raise.exponent;
        } else if (!raise.wide) {
            raise = {1, true, false};
        } else {
            raise = now_[q] = {0, true, true};
            left[q] = 0;
        }
    }
    std::vector<Region> regions;
    for (Index q = 0; q < left.size(); ++q)
        if (left[q])
            regions.push_back(grow(q, folds, left));
    return regions;
}

std::vector<double> FoldEasing::raised() const
{
    std::vector<double> factor(tried_.size(), 1.0);
    for (Index q = 0; q < factor.size(); ++q) {
        if (tried_[q].exponent == 0)
            continue;
        const double own = std::pow(10.0, tried_[q].exponent);
        const std::vector<Index> alone = {q};
        for (const Index r : tried_[q].wide ? response_.with_neighbours(alone) : alone)
            factor[r] = std::max(factor[r], own);
    }
    return factor;
}

void FoldEasing::learn(const std::vector<Region>& regions, const std::vector<Index>& folds)
{
    for (const Region& region : regions)
        for (const Index q : region.core) {
            if (region.back && region.out) {
                now_[q].done = true;
                continue;
            }
            now_[q] = tried_[q];
            // What has fewer folds is tried with the same once more.
            if (!region.back && !region.out && folds[q] > 0)
                --now_[q].exponent;
        }
}

} // namespace bot2nurbs
