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
// Subtrees of about this size are made side by side.
constexpr Index subtree_items = 8192;

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

//! A node to be made of a range of items.
struct Task {
    Index node, first, count;
    int depth;
    Bounds bounds;
};

//! Makes nodes from the top down. Ranges of items do not overlap, so that subtrees may be made side
//! by side.
class Builder {
public:
    explicit Builder(const std::vector<Box3>& boxes)
        : items_(boxes.size()), moved_(boxes.size()), order_(boxes.size())
    {
        for (Index i = 0; i < boxes.size(); ++i)
            items_[i] = {boxes[i], i};
    }

    Task root() const
    {
        Task task{0, 0, static_cast<Index>(items_.size()), 0, {}};
        for (const Item& item : items_)
            task.bounds.add(item);
        return task;
    }

    //! Makes the subtree of a task; its node must be there. Tasks of at most `set_aside` items are
    //! left to `rest`, if there is one.
    void run(const Task& first, std::vector<BoxTree::Node>& nodes, const Context* context,
             Index set_aside = 0, std::vector<Task>* rest = nullptr)
    {
        std::vector<Task> tasks{first};
        while (!tasks.empty()) {
            if (context && context->cancelled())
                return;
            const Task task = tasks.back();
            tasks.pop_back();
            if (rest && task.count <= set_aside) {
                rest->push_back(task);
                continue;
            }
            nodes[task.node].min = task.bounds.items.min;
            nodes[task.node].max = task.bounds.items.max;
            if (task.count <= leaf_items) {
                // Partitions are stable, so items of a leaf are in the order of their numbers.
                for (Index i = 0; i < task.count; ++i)
                    order_[task.first + i] = items_[task.first + i].number;
                nodes[task.node].first = task.first;
                nodes[task.node].count = task.count;
                continue;
            }
            Bounds left_bounds, right_bounds;
            const Index left = divide(task, left_bounds, right_bounds);
            const Index child = static_cast<Index>(nodes.size());
            nodes[task.node].first = child;
            nodes[task.node].count = 0;
            nodes.emplace_back();
            nodes.emplace_back();
            tasks.push_back(
                {child + 1, task.first + left, task.count - left, task.depth + 1, right_bounds});
            tasks.push_back({child, task.first, left, task.depth + 1, left_bounds});
        }
    }

    std::vector<Index> take_order() { return std::move(order_); }

private:
    //! Puts the items of the first child in front. \return how many they are.
    Index divide(const Task& task, Bounds& left_bounds, Bounds& right_bounds)
    {
        Item* const first = items_.data() + task.first;
        Item* const last = first + task.count;
        Item* const moved = moved_.data() + task.first;
        const Split split = task.depth < surface_area_depth
                                ? find_split(first, last, task.bounds.centers)
                                : Split{};
        if (split.axis < 0) {
            const Index left = task.count / 2;
            for (Index i = 0; i < task.count; ++i)
                (i < left ? left_bounds : right_bounds).add(first[i]);
            return left;
        }
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
        std::copy(moved, moved + gone, first + kept);
        return kept;
    }

    std::vector<Item> items_, moved_;
    std::vector<Index> order_;
};

} // namespace

BoxTree::BoxTree(const std::vector<Box3>& boxes, const Context* context)
{
    if (boxes.empty())
        return;
    Builder builder(boxes);
    nodes_.reserve(boxes.size());
    nodes_.emplace_back();
    std::vector<Task> subtrees;
    builder.run(builder.root(), nodes_, context, subtree_items, &subtrees);
    std::vector<std::vector<Node>> made(subtrees.size());
    const auto make = [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            Task task = subtrees[i];
            task.node = 0;
            made[i].reserve(task.count);
            made[i].emplace_back();
            builder.run(task, made[i], context);
        }
    };
    if (!context)
        make(0, subtrees.size());
    else if (!for_each_chunk(*context, subtrees.size(), 1, make)) {
        *this = {};
        return;
    }
    for (std::size_t i = 0; i < subtrees.size(); ++i) {
        // The root of the subtree has its place already.
        const Index before = static_cast<Index>(nodes_.size()) - 1;
        for (Node& node : made[i])
            if (node.count == 0)
                node.first += before;
        nodes_[subtrees[i].node] = made[i][0];
        nodes_.insert(nodes_.end(), made[i].begin() + 1, made[i].end());
        made[i] = {};
    }
    items_ = builder.take_order();
}

} // namespace bot2nurbs
