// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/vec.h"

#include <array>
#include <vector>

namespace bot2nurbs {

//! Triangles of a closed polygon in space with the shortest diagonals, as corners of it in its
//! order; none when every triangulation needs a diagonal that `forbidden(i, j)` rules out.
//! Cost O(n^3).
class LoopTriangles {
public:
    template <class Forbidden> const std::vector<std::array<int, 3>>&
    find(const std::vector<Vec3>& polygon, const Forbidden& forbidden)
    {
        n_ = static_cast<int>(polygon.size());
        allowed_cost_.assign(static_cast<std::size_t>(n_) * static_cast<std::size_t>(n_), 0.0);
        for (int i = 0; i < n_; ++i)
            for (int j = i + 2; j < n_; ++j)
                if (i != 0 || j != n_ - 1)
                    allowed_cost_[at(i, j)] =
                        forbidden(i, j) ? INFINITY
                                        : norm_squared(polygon[static_cast<std::size_t>(i)] -
                                                       polygon[static_cast<std::size_t>(j)]);
        return solve();
    }

private:
    std::size_t at(int i, int j) const
    {
        return static_cast<std::size_t>(i) * static_cast<std::size_t>(n_) +
               static_cast<std::size_t>(j);
    }
    const std::vector<std::array<int, 3>>& solve();
    void collect(int i, int j);

    int n_ = 0;
    std::vector<double> allowed_cost_, cost_;
    std::vector<int> middle_;
    std::vector<std::array<int, 3>> triangles_;
};

} // namespace bot2nurbs
