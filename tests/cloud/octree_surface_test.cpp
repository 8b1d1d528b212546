// SPDX-License-Identifier: MIT
#include "bot2nurbs/manifold_mesh.h"
#include "cloud/octree_surface.h"

#include <functional>
#include <gtest/gtest.h>
#include <random>

namespace bot2nurbs {
namespace {

// Cells of many sizes: deep ones at random places.
Octree uneven_tree(unsigned seed, int deepest)
{
    std::mt19937 random(seed);
    std::vector<WantedCell> wanted;
    for (int i = 0; i < 30; ++i) {
        WantedCell cell;
        cell.level = 3 + static_cast<int>(random() % static_cast<unsigned>(deepest - 2));
        for (auto& x : cell.place)
            x = random() % (1u << cell.level);
        wanted.push_back(cell);
    }
    Context context;
    auto tree = Octree::build(wanted, 3, deepest, context);
    EXPECT_TRUE(tree);
    return std::move(tree.value());
}

// Values at the vertices of all levels: the function where a vertex belongs to no coarser leaf, and
// what the coarser leaf's trilinear function is there otherwise.
OctreeFunction function_on(const Octree& tree, const std::function<double(const Vec3&)>& f)
{
    OctreeFunction result;
    result.surface = 0.0;
    for (int l = 0; l <= tree.depth(); ++l) {
        const OctreeLevel& level = tree.level(l);
        std::vector<double> values(level.vertex_count());
        for (Index v = 0; v < level.vertex_count(); ++v) {
            const Lattice p = morton::decode(level.vertices[v]);
            const double h = Octree::cell_size(l);
            values[v] = f({h * p[0], h * p[1], h * p[2]});
            const bool even = p[0] % 2 == 0 && p[1] % 2 == 0 && p[2] % 2 == 0;
            if (l > 0 && even) {
                const Index coarse = tree.level(l - 1).find_vertex({p[0] / 2, p[1] / 2, p[2] / 2});
                values[v] = result.values.back()[coarse];
            } else if (l > 0 && !level.is_interior(v)) {
                // On the border of the level: halfway between vertices of the coarser one.
                double sum = 0.0;
                for (int k = 0; k < 8; ++k) {
                    Lattice q;
                    for (std::size_t axis = 0; axis < 3; ++axis)
                        q[axis] = (p[axis] + ((k >> axis & 1) != 0 ? p[axis] % 2 : 0u) -
                                   ((k >> axis & 1) != 0 ? 0u : p[axis] % 2)) /
                                  2;
                    sum += result.values.back()[tree.level(l - 1).find_vertex(q)];
                }
                values[v] = sum / 8.0;
            }
        }
        result.values.push_back(std::move(values));
    }
    return result;
}

TEST(Octree, leaves_that_touch_differ_by_one_level_at_most)
{
    for (unsigned seed = 1; seed <= 5; ++seed) {
        const Octree tree = uneven_tree(seed, 7);
        // A cell with children has all its neighbours within the cube.
        for (int l = 0; l < tree.depth(); ++l) {
            const OctreeLevel& level = tree.level(l);
            const std::uint32_t last = (std::uint32_t{1} << l) - 1;
            for (const Index c : level.refined) {
                const Lattice p = morton::decode(level.cells[c]);
                for (int k = 0; k < 27; ++k) {
                    Lattice q{p[0] + static_cast<std::uint32_t>(k % 3) - 1,
                              p[1] + static_cast<std::uint32_t>(k / 3 % 3) - 1,
                              p[2] + static_cast<std::uint32_t>(k / 9) - 1};
                    const bool within = q[0] <= last && q[1] <= last && q[2] <= last;
                    EXPECT_TRUE(!within || level.find_cell(q) != invalid_index);
                }
            }
        }
    }
}

TEST(Octree, the_leaves_fill_the_cube)
{
    const Octree tree = uneven_tree(3, 7);
    double volume = 0.0;
    for (int l = 0; l <= tree.depth(); ++l)
        for (Index c = 0; c < tree.level(l).cell_count(); ++c)
            if (tree.level(l).is_leaf(c))
                volume += std::pow(Octree::cell_size(l), 3);
    EXPECT_EQ(volume, 1.0);
}

TEST(OctreeSurface, a_sphere_across_cells_of_many_sizes_is_a_closed_mesh_of_genus_zero)
{
    for (unsigned seed = 1; seed <= 8; ++seed) {
        const Octree tree = uneven_tree(seed, 7);
        const auto f = function_on(tree, [](const Vec3& p) {
            return 0.3 - norm(p - Vec3{0.49, 0.51, 0.5});
        });
        Context context;
        const auto soup = octree_surface(tree, f, context);
        ASSERT_TRUE(soup);
        const auto mesh = ManifoldMesh::build(soup->positions, soup->triangles);
        ASSERT_TRUE(mesh) << "seed " << seed << ": " << mesh.error().message;
        EXPECT_TRUE(mesh->closed());
        EXPECT_EQ(mesh->genus(), 0);
        // Cells of at most an eighth cut off less than the height h^2 / 4 R of their diagonals.
        constexpr double pi = 3.14159265358979323846, r = 0.3, h = 0.125;
        EXPECT_NEAR(mesh->volume(), 4.0 / 3.0 * pi * r * r * r,
                    4.0 * pi * r * r * h * h / (4.0 * r));
    }
}

// Values without any smoothness meet every case of a cell, ambiguous faces included.
TEST(OctreeSurface, random_values_give_a_closed_manifold_mesh)
{
    for (unsigned seed = 1; seed <= 20; ++seed) {
        const Octree tree = uneven_tree(seed, 6);
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> uniform(-1.0, 1.0);
        const auto f = function_on(tree, [&](const Vec3& p) {
            const double value = uniform(random);
            const bool border =
                std::min({p.x, p.y, p.z}) <= 0.0 || std::max({p.x, p.y, p.z}) >= 1.0;
            return border ? -1.0 : value;
        });
        Context context;
        const auto soup = octree_surface(tree, f, context);
        ASSERT_TRUE(soup);
        ASSERT_FALSE(soup->triangles.empty());
        const auto mesh = ManifoldMesh::build(soup->positions, soup->triangles);
        ASSERT_TRUE(mesh) << "seed " << seed << ": " << mesh.error().message;
        EXPECT_TRUE(mesh->closed());
        EXPECT_GT(mesh->volume(), 0.0);
    }
}

} // namespace
} // namespace bot2nurbs
