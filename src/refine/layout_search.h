// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/result.h"

#include <algorithm>
#include <limits>

namespace bot2nurbs {

//! Which layout to refine: decides, after a fit to each, whether to try a finer one and how fine.
class LayoutSearch {
public:
    struct Verdict {
        bool best; //!< Of those so far.
        bool done; //!< No other layout need be tried: the best one is it.
    };

    //! Share of the patches that should be within the tolerance before any is cut. With fewer,
    //! closing the marks would cut nearly all patches; with all of them, the worst patch would set
    //! the size of every other.
    static constexpr double wanted_share = 0.9;

    explicit LayoutSearch(Index max_patches) : most_(max_patches) {}

    //! Number of patches to ask for next.
    Index patches() const { return static_cast<Index>(std::min(patches_, most_)); }
    //! \param count number of patches of the layout that was made for patches()
    //! \param beyond number of those that are not known to be within the tolerance, at least one
    //! \param ratio the distance that the wanted share of them are within, over the tolerance
    Verdict look_at(Index count, Index beyond, double ratio);

private:
    //! \return whether the limit has been asked for already.
    bool grow(Index count, double growth);

    double most_;
    double patches_ = 24; //!< A few more than the six of a cube: no limb gets its own below that.
    double best_ratio_ = std::numeric_limits<double>::infinity();
    double fewest_ = std::numeric_limits<double>::infinity(); //!< That the best may end with.
    int steps_in_vain_ = 0, small_steps_ = 0;
};

} // namespace bot2nurbs
