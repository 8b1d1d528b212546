// SPDX-License-Identifier: MIT
#include "cloud/even_subset.h"

#include <algorithm>
#include <numeric>

namespace bot2nurbs {

std::vector<Index> even_subset(const std::vector<Vec3>& points, std::size_t count)
{
    std::vector<Index> order(points.size()), chosen;
    std::iota(order.begin(), order.end(), Index{0});
    struct Cell {
        std::size_t begin, end, share; //!< Points of the cell; how many to choose.
    };
    std::vector<Cell> open{{0, points.size(), std::min(count, points.size())}};
    while (!open.empty()) {
        const Cell cell = open.back();
        open.pop_back();
        if (cell.share == 0)
            continue;
        Box3 box;
        Vec3 mean;
        for (std::size_t i = cell.begin; i < cell.end; ++i) {
            box.add(points[order[i]]);
            mean += points[order[i]];
        }
        if (cell.share == 1) {
            mean = mean / static_cast<double>(cell.end - cell.begin);
            Index best = order[cell.begin];
            for (std::size_t i = cell.begin; i < cell.end; ++i) {
                const double a = norm_squared(points[order[i]] - mean),
                             b = norm_squared(points[best] - mean);
                if (a < b || (a == b && order[i] < best))
                    best = order[i];
            }
            chosen.push_back(best);
            continue;
        }
        const Vec3 side = box.max - box.min;
        const int axis = side.x >= side.y && side.x >= side.z ? 0 : (side.y >= side.z ? 1 : 2);
        const std::size_t half = cell.share / 2;
        const std::size_t middle = cell.begin + (cell.end - cell.begin) * half / cell.share;
        const auto at = [&](std::size_t i) {
            return order.begin() + static_cast<std::ptrdiff_t>(i);
        };
        std::nth_element(at(cell.begin), at(middle), at(cell.end), [&](Index a, Index b) {
            return points[a][axis] != points[b][axis] ? points[a][axis] < points[b][axis] : a < b;
        });
        open.push_back({middle, cell.end, cell.share - half});
        open.push_back({cell.begin, middle, half});
    }
    std::sort(chosen.begin(), chosen.end());
    return chosen;
}

} // namespace bot2nurbs
