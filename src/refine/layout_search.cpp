// SPDX-License-Identifier: MIT
#include "refine/layout_search.h"

#include <algorithm>
#include <cmath>

namespace bot2nurbs {

namespace {

// The distance of bicubic patches falls with the power 2 of their number where the source is
// smooth, with less where it is not: the measured 1.5 of real models.
constexpr double patches_power = 1.0 / 1.5;
// Growth from one layout to the next: least, so that few layouts are tried, and most, as the
// prediction is rough.
constexpr double least_growth = 1.4, most_growth = 4.0;
// So many times in a row finer layouts may be no nearer to the source. Then most patches have
// details, or facets, of it to reach, and more of them gain nothing.
constexpr int most_steps_in_vain = 2;
// Patches that one beyond the tolerance adds in the end, about: closing the marks makes 13 to 20
// when it is cut, and its pieces are often cut again. Where several are cut together each adds
// fewer.
constexpr double patches_per_cut = 30.0;
// Where few patches are left to cut, layouts that are this much finer are tried: one may have none
// to cut.
constexpr double small_growth = 1.25;
constexpr int most_small_steps = 4;

} // namespace

bool LayoutSearch::grow(Index count, double growth)
{
    const bool at_limit = patches_ >= most_;
    // Topology and creases may keep layouts far above what is asked for: the next is to be another.
    patches_ = growth * (count > 2.0 * patches_ ? count : patches_);
    return at_limit;
}

LayoutSearch::Verdict LayoutSearch::look_at(Index count, Index beyond, double ratio)
{
    if (ratio > 1.0 && small_steps_ == 0) {
        const bool nearer = ratio < best_ratio_;
        const double wanted = std::pow(ratio, patches_power);
        const bool at_limit =
            grow(count, nearer ? std::clamp(wanted, least_growth, most_growth) : least_growth);
        best_ratio_ = std::min(best_ratio_, ratio);
        steps_in_vain_ = nearer ? 0 : steps_in_vain_ + 1;
        return {nearer, at_limit || steps_in_vain_ == most_steps_in_vain};
    }
    const double expected = count + patches_per_cut * beyond;
    const bool best = ratio <= 1.0 && expected < fewest_;
    if (best)
        fewest_ = expected;
    const bool at_limit = grow(count, small_growth);
    return {best, at_limit || ++small_steps_ > most_small_steps || small_growth * count >= fewest_};
}

} // namespace bot2nurbs
