// SPDX-License-Identifier: MIT
#include "cloud/octree_hats.h"

#include <algorithm>

namespace bot2nurbs {

namespace {

//! Weight, in the hat at corner j of a cell, of the place of corner i of its child k.
constexpr double weight(int k, int i, int j)
{
    double w = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
        const int steps = (k >> axis & 1) + (i >> axis & 1); // 0, 1 or 2 halves
        w *= (j >> axis & 1) != 0 ? 0.5 * steps : 1.0 - 0.5 * steps;
    }
    return w;
}

struct Weights {
    double w[8][8][8] = {}; // [child][its corner][corner of the cell]

    constexpr Weights()
    {
        for (int k = 0; k < 8; ++k)
            for (int i = 0; i < 8; ++i)
                for (int j = 0; j < 8; ++j)
                    w[k][i][j] = weight(k, i, j);
    }
};
constexpr Weights weights;

//! The trilinear function with these corner values at the place of corner i of child k. Halfway
//! steps average two numbers at a time, so that rounding never leads out of their range: the sign
//! of a value between values of one sign is theirs.
double between(OctreeHats::Corners v, Index k, Index i)
{
    std::size_t count = 8;
    for (int axis = 2; axis >= 0; --axis) {
        count /= 2; // values of the low side, then those of the high side
        const Index steps = (k >> axis & 1) + (i >> axis & 1);
        for (std::size_t j = 0; j < count; ++j)
            v[j] =
                steps == 0 ? v[j] : (steps == 2 ? v[j + count] : 0.5 * v[j] + 0.5 * v[j + count]);
    }
    return v[0];
}

} // namespace

OctreeField OctreeHats::zeros() const
{
    OctreeField field;
    for (int l = 0; l <= tree_.depth(); ++l)
        field.emplace_back(tree_.level(l).vertex_count(), 0.0);
    return field;
}

void OctreeHats::to_values(OctreeField& field) const
{
    for (int l = 1; l <= tree_.depth(); ++l) {
        const OctreeLevel &level = tree_.level(l), &coarser = tree_.level(l - 1);
        const std::vector<double>& coarse = field[static_cast<std::size_t>(l) - 1];
        std::vector<double>& fine = field[static_cast<std::size_t>(l)];
        for_each_chunk(context_, level.vertex_count(), cells_per_chunk,
                       [&](std::size_t begin, std::size_t end) {
                           for (std::size_t v = begin; v < end; ++v) {
                               const Index slot = level.slots[level.first_slot[v]];
                               const Index cell = slot / 8, parent = tree_.parent(l, cell);
                               Corners corners;
                               for (Index j = 0; j < 8; ++j)
                                   corners[j] = coarse[coarser.corners[8 * parent + j]];
                               fine[v] += between(corners, cell % 8, slot % 8);
                           }
                       });
    }
}

OctreeHats::Corners OctreeHats::restricted(int l, Index cell,
                                           const std::vector<double>& finer) const
{
    Corners sums{};
    const OctreeLevel& level = tree_.level(l + 1);
    const Index first = tree_.level(l).children[cell];
    for (Index k = 0; k < 8; ++k)
        for (Index i = 0; i < 8; ++i) {
            const Index slot = 8 * (first + k) + i;
            const Index v = level.corners[slot];
            // Each vertex counts in one of the cells that share it.
            if (level.slots[level.first_slot[v]] != slot)
                continue;
            const double* w = weights.w[k][i];
            for (std::size_t j = 0; j < 8; ++j)
                sums[j] += w[j] * finer[v];
        }
    return sums;
}

void OctreeHats::gather(int l, std::vector<double>& field) const
{
    const OctreeLevel& level = tree_.level(l);
    for_each_chunk(context_, level.vertex_count(), cells_per_chunk,
                   [&](std::size_t begin, std::size_t end) {
                       for (std::size_t v = begin; v < end; ++v) {
                           double sum = 0.0;
                           for (Index s = level.first_slot[v]; s < level.first_slot[v + 1]; ++s)
                               sum += at_corners_[level.slots[s] / 8][level.slots[s] % 8];
                           field[v] = sum;
                       }
                   });
}

void OctreeHats::clear_without_hat(int l, std::vector<double>& field) const
{
    const OctreeLevel& level = tree_.level(l);
    for (Index v = 0; v < level.vertex_count(); ++v)
        if (!level.is_interior(v))
            field[v] = 0.0;
}

} // namespace bot2nurbs
