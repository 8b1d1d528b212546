// SPDX-License-Identifier: MIT
#include "mesh/box_tree.h"

#include "core/parallel.h"

#include <algorithm>
#include <array>
#include <utility>

namespace bot2nurbs {

namespace {

constexpr Index leaf_items = 4;
// Split positions tried per node; more gain less than a percent in query time.
constexpr int bin_count = 16;
// Deeper nodes are halved by number, so that the depth stays below this plus log2 of the items
// whatever the boxes: queries keep their stack in an array.
constexpr int surface_area_depth = 28;
// Larger subtrees are made in two halves, side by side.
constexpr Index serial_items = 8192;

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

//! A range of items that becomes a node.
struct Task {
    Index first, count;
    int depth;
    Bounds bounds;
};

//! Makes nodes from the top down. Ranges of items do not overlap, so that subtrees may be made side
//! by side.
class Builder {
public:
    Builder(const std::vector<Box3>& boxes, const Context* context)
        : items_(boxes.size()), order_(boxes.size())
    {
        const auto fill = [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                items_[i] = {boxes[i], static_cast<Index>(i)};
        };
        if (context)
            for_each_chunk(*context, boxes.size(), serial_items, fill);
        else
            fill(0, boxes.size());
    }

    Task root() const
    {
        Task task{0, static_cast<Index>(items_.size()), 0, {}};
        for (const Item& item : items_)
            task.bounds.add(item);
        return task;
    }

    //! The nodes of the subtree of a task, its root first. Large ones are made in two halves, side
    //! by side if there is a context; their nodes come in the same order in any case.
    std::vector<BoxTree::Node> subtree(const Task& task, const Context* context)
    {
        if (context && context->cancelled())
            return {};
        if (task.count <= serial_items)
            return small_subtree(task);
        std::array<Task, 2> half = divide(task);
        std::array<std::vector<BoxTree::Node>, 2> made;
        const auto make = [&](std::size_t i) { made[i] = subtree(half[i], context); };
        if (context) {
            run_both(
                *context, [&] { make(0); }, [&] { make(1); });
        } else {
            make(0);
            make(1);
        }
        if (made[0].empty() || made[1].empty())
            return {}; // cancelled
        // The root, the roots of both halves, then the rest of one after the other.
        std::vector<BoxTree::Node> nodes{inner_node(task, 1), made[0][0], made[1][0]};
        nodes.reserve(1 + made[0].size() + made[1].size());
        for (std::size_t i = 0; i < 2; ++i) {
            const Index shift = static_cast<Index>(nodes.size()) - 1;
            for (BoxTree::Node& node : made[i])
                if (node.count == 0)
                    node.first += shift;
            nodes[1 + i] = made[i][0];
            nodes.insert(nodes.end(), made[i].begin() + 1, made[i].end());
        }
        return nodes;
    }

    std::vector<Index> take_order() { return std::move(order_); }

private:
    static BoxTree::Node inner_node(const Task& task, Index first_child)
    {
        return {task.bounds.items.min, task.bounds.items.max, first_child, 0};
    }

    std::vector<BoxTree::Node> small_subtree(const Task& root)
    {
        std::vector<BoxTree::Node> nodes(1);
        std::vector<std::pair<Task, Index>> open{{root, 0}}; // With the numbers of their nodes.
        while (!open.empty()) {
            const auto [task, at] = open.back();
            open.pop_back();
            if (task.count <= leaf_items) {
                for (Index i = 0; i < task.count; ++i)
                    order_[task.first + i] = items_[task.first + i].number;
                std::sort(order_.begin() + task.first, order_.begin() + task.first + task.count);
                nodes[at] = {task.bounds.items.min, task.bounds.items.max, task.first, task.count};
                continue;
            }
            const Index child = static_cast<Index>(nodes.size());
            nodes[at] = inner_node(task, child);
            nodes.resize(nodes.size() + 2);
            const std::array<Task, 2> half = divide(task);
            open.push_back({half[1], child + 1});
            open.push_back({half[0], child});
        }
        return nodes;
    }

    //! Puts the items of the first half in front.
    std::array<Task, 2> divide(const Task& task)
    {
        Item* const first = items_.data() + task.first;
        Item* const last = first + task.count;
        const Split split = task.depth < surface_area_depth
                                ? find_split(first, last, task.bounds.centers)
                                : Split{};
        Bounds left, right;
        Index kept = task.count / 2;
        if (split.axis < 0) {
            for (Index i = 0; i < task.count; ++i)
                (i < kept ? left : right).add(first[i]);
        } else {
            kept = 0;
            Index end = task.count;
            const auto goes_left = [&](Index i) { return split.bin_of(first[i].box) < split.bin; };
            for (;;) {
                while (kept < end && goes_left(kept))
                    left.add(first[kept++]);
                while (kept < end && !goes_left(end - 1))
                    right.add(first[--end]);
                if (kept == end)
                    break;
                std::swap(first[kept], first[end - 1]);
            }
        }
        return {Task{task.first, kept, task.depth + 1, left},
                Task{task.first + kept, task.count - kept, task.depth + 1, right}};
    }

    std::vector<Item> items_;
    std::vector<Index> order_;
};

} // namespace

BoxTree::BoxTree(const std::vector<Box3>& boxes, const Context* context)
{
    if (boxes.empty())
        return;
    Builder builder(boxes, context);
    nodes_ = builder.subtree(builder.root(), context);
    if (!nodes_.empty())
        items_ = builder.take_order();
}

} // namespace bot2nurbs
