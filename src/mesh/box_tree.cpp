// SPDX-License-Identifier: MIT
#include "mesh/box_tree.h"

#include <algorithm>
#include <array>

namespace bot2nurbs {

namespace {

constexpr Index leaf_items = 4;
// Split positions tried per node; more gain less than a percent in query time.
constexpr int bin_count = 16;
// Deeper nodes are halved by number, so that the depth stays below this plus log2 of the items
// whatever the boxes: queries keep their stack in an array.
constexpr int surface_area_depth = 28;

double half_area(const Box3& b)
{
    if (b.empty())
        return 0.0;
    const Vec3 d = b.max - b.min;
    return d.x * d.y + d.y * d.z + d.z * d.x;
}

void add(Box3& box, const Box3& other)
{
    box.add(other.min);
    box.add(other.max);
}

//! An item with its box; kept together and moved, as the tree is made faster from what lies side
//! by side in memory.
struct Item {
    Box3 box;
    Index number;
};

//! The boxes around some items and around the centres of their boxes.
struct Bounds {
    Box3 items, centers;

    void add(const Item& item)
    {
        bot2nurbs::add(items, item.box);
        centers.add(item.box.center());
    }
};

struct Split {
    int axis = -1; //!< -1: none.
    int bin = 0;   //!< Items in bins below go to the first child.
    double origin = 0.0, scale = 0.0;

    int bin_of(const Box3& box) const
    {
        const double c = 0.5 * (box.min[axis] + box.max[axis]);
        return std::min(bin_count - 1, static_cast<int>((c - origin) * scale));
    }
};

//! The split with the least sum of (area x items) of both sides over the bins of the longest axis
//! of the box centres.
Split find_split(const Item* first, const Item* last, const Box3& centers)
{
    const Vec3 extent = centers.max - centers.min;
    Split split;
    split.axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : (extent.y >= extent.z ? 1 : 2);
    split.origin = centers.min[split.axis];
    split.scale = bin_count / extent[split.axis];
    if (!(extent[split.axis] > 0.0) || !std::isfinite(split.scale))
        return {};
    std::array<Box3, bin_count> box;
    std::array<Index, bin_count> count{};
    for (const Item* i = first; i != last; ++i) {
        const int b = split.bin_of(i->box);
        add(box[b], i->box);
        ++count[b];
    }
    std::array<double, bin_count> right_cost{};
    Box3 side;
    Index items = 0;
    for (int b = bin_count - 1; b > 0; --b) {
        add(side, box[b]);
        items += count[b];
        right_cost[b] = half_area(side) * items;
    }
    side = {};
    items = 0;
    double best = INFINITY;
    for (int b = 1; b < bin_count; ++b) {
        add(side, box[b - 1]);
        items += count[b - 1];
        const double cost = half_area(side) * items + right_cost[b];
        if (items > 0 && items < static_cast<Index>(last - first) && cost < best) {
            best = cost;
            split.bin = b;
        }
    }
    return best < INFINITY ? split : Split{};
}

} // namespace

BoxTree::BoxTree(const std::vector<Box3>& boxes, const Context* context)
{
    const Index n = static_cast<Index>(boxes.size());
    if (n == 0)
        return;
    struct Task {
        Index node, first, count;
        int depth;
        Bounds bounds;
    };
    Task root{0, 0, n, 0, {}};
    std::vector<Item> items(n), moved(n);
    for (Index i = 0; i < n; ++i) {
        items[i] = {boxes[i], i};
        root.bounds.add(items[i]);
    }
    items_.resize(n);
    nodes_.reserve(n);
    nodes_.emplace_back();
    std::vector<Task> tasks{root};
    while (!tasks.empty()) {
        if (context && context->cancelled()) {
            *this = {};
            return;
        }
        const Task task = tasks.back();
        tasks.pop_back();
        Item* const first = items.data() + task.first;
        Item* const last = first + task.count;
        nodes_[task.node].min = task.bounds.items.min;
        nodes_[task.node].max = task.bounds.items.max;
        if (task.count <= leaf_items) {
            // Partitions are stable, so items of a leaf are in the order of their numbers.
            for (Index i = 0; i < task.count; ++i)
                items_[task.first + i] = first[i].number;
            nodes_[task.node].first = task.first;
            nodes_[task.node].count = task.count;
            continue;
        }
        Bounds left_bounds, right_bounds;
        Index left = task.count / 2;
        const Split split = task.depth < surface_area_depth
                                ? find_split(first, last, task.bounds.centers)
                                : Split{};
        if (split.axis >= 0) {
            Index kept = 0, gone = 0;
            for (const Item* i = first; i != last; ++i) {
                if (split.bin_of(i->box) < split.bin) {
                    left_bounds.add(*i);
                    first[kept++] = *i;
                } else {
                    right_bounds.add(*i);
                    moved[gone++] = *i;
                }
            }
            std::copy(moved.begin(), moved.begin() + gone, first + kept);
            left = kept;
        } else {
            for (Index i = 0; i < task.count; ++i)
                (i < left ? left_bounds : right_bounds).add(first[i]);
        }
        const Index child = static_cast<Index>(nodes_.size());
        nodes_[task.node].first = child;
        nodes_[task.node].count = 0;
        nodes_.emplace_back();
        nodes_.emplace_back();
        tasks.push_back(
            {child + 1, task.first + left, task.count - left, task.depth + 1, right_bounds});
        tasks.push_back({child, task.first, left, task.depth + 1, left_bounds});
    }
}

} // namespace bot2nurbs
