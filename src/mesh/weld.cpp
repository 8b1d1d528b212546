// SPDX-License-Identifier: MIT
#include "mesh/weld.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace bot2nurbs {

namespace {

// Groups up to this size are compared pair by pair.
constexpr std::size_t pairwise = 32;

class Welder {
public:
    Welder(const std::vector<Vec3>& points, double distance)
        : points_(points), distance_(distance), parent_(points.size())
    {
        for (std::size_t i = 0; i < points.size(); ++i)
            parent_[i] = static_cast<Index>(i);
    }

    //! Splits the range wherever consecutive coordinates along an axis are farther apart than the
    //! distance, axis after axis until none splits it; nearly all points are alone by then.
    void split(Index* first, Index* last)
    {
        struct Range {
            Index *first, *last;
            int axis, failed;
        };
        std::vector<Range> open{{first, last, 0, 0}};
        while (!open.empty()) {
            const Range r = open.back();
            open.pop_back();
            if (r.last - r.first < 2)
                continue;
            if (r.failed == 3) {
                compare(r.first, r.last);
                continue;
            }
            std::sort(r.first, r.last, [&](Index i, Index j) {
                const double x = points_[i][r.axis], y = points_[j][r.axis];
                return x < y || (x == y && i < j);
            });
            const int axis = (r.axis + 1) % 3;
            Index* start = r.first;
            bool cut = false;
            for (Index* i = r.first + 1; i <= r.last; ++i)
                if (i == r.last || points_[*i][r.axis] - points_[i[-1]][r.axis] > distance_) {
                    cut = cut || i != r.last;
                    open.push_back({start, i, axis, 0});
                    start = i;
                }
            if (!cut)
                open.back().failed = r.failed + 1;
        }
    }

    std::vector<Index> groups()
    {
        for (Index i = 0; i < parent_.size(); ++i)
            parent_[i] = root(i);
        return std::move(parent_);
    }

private:
    Index root(Index i)
    {
        while (parent_[i] != i) {
            parent_[i] = parent_[parent_[i]];
            i = parent_[i];
        }
        return i;
    }
    void join_if_near(Index i, Index j)
    {
        if (norm_squared(points_[i] - points_[j]) <= distance_ * distance_) {
            i = root(i);
            j = root(j);
            parent_[std::max(i, j)] = std::min(i, j);
        }
    }

    void compare(Index* first, Index* last)
    {
        const Vec3 origin = points_[*first];
        const bool equal = std::all_of(first, last, [&](Index i) { return points_[i] == origin; });
        if (equal) {
            for (Index* i = first + 1; i != last; ++i)
                join_if_near(*first, *i);
            return;
        }
        if (static_cast<std::size_t>(last - first) <= pairwise) {
            for (Index* i = first; i != last; ++i)
                for (Index* j = i + 1; j != last; ++j)
                    join_if_near(*i, *j);
            return;
        }
        compare_in_grid(first, last);
    }

    //! Cells as wide as the distance: near points lie in the same or neighbouring cells.
    void compare_in_grid(const Index* first, const Index* last)
    {
        struct Entry {
            std::array<std::int64_t, 3> cell;
            Index point;
            bool operator<(const Entry& o) const
            {
                return cell < o.cell || (cell == o.cell && point < o.point);
            }
        };
        Box3 box;
        for (const Index* i = first; i != last; ++i)
            box.add(points_[*i]);
        std::vector<Entry> entries;
        for (const Index* i = first; i != last; ++i) {
            Entry e{{}, *i};
            // distance > 0 here: without one, the splits leave equal points only.
            for (int k = 0; k < 3; ++k)
                e.cell[k] = static_cast<std::int64_t>(
                    std::floor((points_[*i][k] - box.min[k]) / distance_));
            entries.push_back(e);
        }
        std::sort(entries.begin(), entries.end());
        for (const Entry& e : entries)
            for (std::int64_t dx = -1; dx <= 1; ++dx)
                for (std::int64_t dy = -1; dy <= 1; ++dy) {
                    // Cells in a row along z follow each other.
                    const Entry low{{e.cell[0] + dx, e.cell[1] + dy, e.cell[2] - 1}, 0};
                    for (auto i = std::lower_bound(entries.begin(), entries.end(), low);
                         i != entries.end() && i->cell[0] == low.cell[0] &&
                         i->cell[1] == low.cell[1] && i->cell[2] <= e.cell[2] + 1;
                         ++i)
                        if (i->point > e.point && root(i->point) != root(e.point))
                            join_if_near(e.point, i->point);
                }
    }

    const std::vector<Vec3>& points_;
    double distance_;
    std::vector<Index> parent_;
};

} // namespace

std::vector<Index> weld_points(const std::vector<Vec3>& points, const std::vector<char>& chosen,
                               double distance)
{
    std::vector<Index> order;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (chosen.empty() || chosen[i])
            order.push_back(static_cast<Index>(i));
    Welder welder(points, distance);
    welder.split(order.data(), order.data() + order.size());
    return welder.groups();
}

} // namespace bot2nurbs
