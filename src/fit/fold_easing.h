// SPDX-License-Identifier: MIT
#pragma once

#include "fit/fold_response.h"

#include <vector>

namespace bot2nurbs {

//! How much more fairness quads that fold get at the end of a fit, until they unfold, and how much
//! less again after that.
//!
//! A quad that folds gets ten times its fairness, then a hundred times, up to 1e5; if that is in
//! vain, once more with all quads around it, which then move as well. What has unfolded comes back
//! by tens, to its own fairness or as far as it stays unfolded.
class FoldEasing {
public:
    //! Quads that are solved for together.
    struct Region {
        std::vector<Index> core;  //!< Those that fold, or come back.
        std::vector<Index> quads; //!< Those whose unknowns move.
        std::vector<Index> near;  //!< Those that this may change, ascending.
        bool back = false;
        bool out = false; //!< Set by the caller: it does not move after all.
    };

    //! `response` must outlive this.
    FoldEasing(const FoldResponse& response, std::size_t quads)
        : response_(response), now_(quads), tried_(quads)
    {
    }

    //! What to try next, for these folds of each quad; empty: nothing is left to try.
    std::vector<Region> next(const std::vector<Index>& folds);
    //! Per quad: the factor of its fairness to try.
    std::vector<double> raised() const;
    //! What came of it: regions, and the folds after it.
    void learn(const std::vector<Region>& regions, const std::vector<Index>& folds);

private:
    struct Raise {
        int exponent = 0;  //!< Of ten.
        bool wide = false; //!< With the quads around.
        bool done = false;
    };
    Region grow(Index quad, const std::vector<Index>& folds, std::vector<char>& left) const;

    const FoldResponse& response_;
    std::vector<Raise> now_, tried_; //!< Per quad.
};

} // namespace bot2nurbs
