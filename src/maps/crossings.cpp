// SPDX-License-Identifier: MIT
#include "maps/crossings.h"

#include <algorithm>

namespace bot2nurbs {

namespace {

// What a crossing keeps of its stretch's length, where there is room for all.
constexpr double crossing_margin = 0.02;
// Stretches shorter than this share of their edge hold no further crossing.
constexpr double min_stretch = 1e-9;

} // namespace

bool keep_apart(std::vector<double>& t, double low, double high)
{
    if (t.empty())
        return true;
    const double width = high - low;
    if (width < min_stretch)
        return false;
    const double count = static_cast<double>(t.size());
    const double gap = width * std::min(crossing_margin, 0.5 / (count + 1.0));
    double at_least = low + gap;
    for (double& x : t) {
        x = std::max(x, at_least);
        at_least = x + gap;
    }
    if (at_least > high)
        for (std::size_t k = 0; k < t.size(); ++k)
            t[k] = low + width * static_cast<double>(k + 1) / (count + 1.0);
    return true;
}

} // namespace bot2nurbs
