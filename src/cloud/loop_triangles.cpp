// SPDX-License-Identifier: MIT
#include "cloud/loop_triangles.h"

namespace bot2nurbs {

const std::vector<std::array<int, 3>>& LoopTriangles::solve()
{
    triangles_.clear();
    cost_.assign(allowed_cost_.size(), 0.0);
    middle_.assign(allowed_cost_.size(), -1);
    // Of the polygon's parts i .. j closed by the diagonal from j to i, short parts first.
    for (int length = 2; length < n_; ++length)
        for (int i = 0; i + length < n_; ++i) {
            const int j = i + length;
            double best = INFINITY;
            for (int k = i + 1; k < j; ++k) {
                const double cost = cost_[at(i, k)] + cost_[at(k, j)];
                if (cost < best) {
                    best = cost;
                    middle_[at(i, j)] = k;
                }
            }
            cost_[at(i, j)] = best + allowed_cost_[at(i, j)];
        }
    if (n_ >= 3 && cost_[at(0, n_ - 1)] < INFINITY)
        collect(0, n_ - 1);
    return triangles_;
}

void LoopTriangles::collect(int i, int j)
{
    if (j - i < 2)
        return;
    const int k = middle_[at(i, j)];
    triangles_.push_back({i, k, j});
    collect(i, k);
    collect(k, j);
}

} // namespace bot2nurbs
