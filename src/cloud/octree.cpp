// SPDX-License-Identifier: MIT
#include "cloud/octree.h"

#include "cloud/key_sort.h"
#include "core/parallel.h"

#include <algorithm>

namespace bot2nurbs {

namespace {

constexpr std::size_t cells_per_chunk = 4096;

//! Adds the 26 neighbours of every cell, one axis after the other, so that copies are dropped
//! early.
bool add_neighbors(std::vector<std::uint64_t>& cells, int l, const Context& context)
{
    const std::uint32_t last = (std::uint32_t{1} << l) - 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t count = cells.size();
        for (std::size_t i = 0; i < count; ++i) {
            if (i % (16 * cells_per_chunk) == 0 && context.cancelled())
                return false;
            Lattice p = morton::decode(cells[i]);
            const std::uint32_t x = p[axis];
            if (x > 0) {
                p[axis] = x - 1;
                cells.push_back(morton::encode(p));
            }
            if (x < last) {
                p[axis] = x + 1;
                cells.push_back(morton::encode(p));
            }
        }
        if (!sort_unique(cells, 3 * l, context))
            return false;
    }
    return true;
}

//! All cells of a level.
void add_all(std::vector<std::uint64_t>& cells, int l)
{
    cells.resize(std::size_t{1} << (3 * l));
    for (std::size_t i = 0; i < cells.size(); ++i)
        cells[i] = i;
}

Index find(const std::vector<std::uint64_t>& keys, std::uint64_t key)
{
    const auto at = std::lower_bound(keys.begin(), keys.end(), key);
    return at != keys.end() && *at == key ? static_cast<Index>(at - keys.begin()) : invalid_index;
}

} // namespace

Index OctreeLevel::find_cell(const Lattice& p) const
{
    return find(cells, morton::encode(p));
}

Index OctreeLevel::find_vertex(const Lattice& p) const
{
    return find(vertices, morton::encode(p));
}

Result<Octree> Octree::build(const std::vector<WantedCell>& wanted, int full, int deepest,
                             const Context& context)
{
    const auto cancelled = Context::cancelled_error("octree");
    // From the finest level up: the cells that must have children.
    std::vector<std::vector<std::uint64_t>> refined(static_cast<std::size_t>(deepest) + 1);
    std::vector<std::uint64_t> needed; // of the level at hand
    for (int l = deepest; l > 0; --l) {
        for (const WantedCell& cell : wanted)
            if (cell.level == l)
                needed.push_back(morton::encode(cell.place));
        if (!sort_unique(needed, 3 * l, context) || !add_neighbors(needed, l, context))
            return cancelled;
        std::vector<std::uint64_t>& parents = refined[static_cast<std::size_t>(l) - 1];
        if (l <= full) {
            add_all(parents, l - 1);
        } else {
            for (const std::uint64_t key : needed)
                if (parents.empty() || parents.back() != key >> 3)
                    parents.push_back(key >> 3); // ascending, as the keys are
        }
        needed = parents;
    }

    Octree tree;
    tree.levels_.resize(1);
    tree.levels_[0].cells.assign(1, 0);
    for (int l = 0; l <= deepest; ++l) {
        OctreeLevel& level = tree.levels_.back();
        level.children.assign(level.cells.size(), invalid_index);
        const std::vector<std::uint64_t>& parents = refined[static_cast<std::size_t>(l)];
        std::vector<std::uint64_t> below;
        below.reserve(8 * parents.size());
        Index c = 0;
        for (const std::uint64_t key : parents) {
            while (level.cells[c] != key)
                ++c;
            level.children[c] = static_cast<Index>(below.size());
            level.refined.push_back(c);
            for (std::uint64_t k = 0; k < 8; ++k)
                below.push_back(key << 3 | k);
        }
        if (!tree.number_vertices(level, l, context))
            return cancelled;
        if (below.empty())
            break;
        tree.levels_.emplace_back();
        tree.levels_.back().cells = std::move(below);
    }
    return tree;
}

bool Octree::number_vertices(OctreeLevel& level, int l, const Context& context)
{
    std::vector<KeyedSlot> items(8 * level.cells.size());
    for_each_chunk(
        context, level.cells.size(), cells_per_chunk, [&](std::size_t begin, std::size_t end) {
            for (std::size_t c = begin; c < end; ++c) {
                const Lattice p = morton::decode(level.cells[c]);
                for (std::uint32_t k = 0; k < 8; ++k)
                    items[8 * c + k] = {
                        morton::encode({p[0] + (k & 1), p[1] + (k >> 1 & 1), p[2] + (k >> 2)}),
                        static_cast<Index>(8 * c + k)};
            }
        });
    if (!sort_keys(items, 3 * (l + 1), context))
        return false;
    level.corners.resize(items.size());
    level.slots.resize(items.size());
    for (std::size_t i = 0; i < items.size(); ++i) {
        if (i % (16 * cells_per_chunk) == 0 && context.cancelled())
            return false;
        if (i == 0 || items[i].key != items[i - 1].key) {
            level.first_slot.push_back(static_cast<Index>(i));
            level.vertices.push_back(items[i].key);
        }
        level.slots[i] = items[i].slot;
        level.corners[items[i].slot] = static_cast<Index>(level.vertices.size() - 1);
    }
    level.first_slot.push_back(static_cast<Index>(items.size()));
    return true;
}

} // namespace bot2nurbs
