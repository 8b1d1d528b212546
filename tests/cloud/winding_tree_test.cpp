// SPDX-License-Identifier: MIT
#include "cloud/winding_tree.h"
#include "cloud_fixtures.h"

#include <gtest/gtest.h>

namespace bot2nurbs {
namespace {

constexpr double pi = 3.14159265358979323846;
// Of the tree: it handles far points through moments. Errors are relative to the largest value.
constexpr double tree_error = 0.03;

struct Pairs {
    std::vector<Vec3> points, dipoles; // in the order of the tree
    std::vector<double> charges, softening;
};

// r / (4 pi |r|^3) from a to b, softened.
Vec3 kernel(const Pairs& s, std::size_t a, std::size_t b)
{
    const Vec3 r = s.points[b] - s.points[a];
    const double r2 = norm_squared(r) + s.softening[a] + s.softening[b];
    return r2 > 0.0 ? r / (4.0 * pi * r2 * std::sqrt(r2)) : Vec3{};
}

class WindingTreeSums : public ::testing::Test {
protected:
    void SetUp() override
    {
        const auto torus = fixtures::torus_points(700);
        auto built = WindingTree::build(torus.points, 1.0, context);
        ASSERT_TRUE(built);
        tree = std::make_unique<WindingTree>(std::move(*built));
        std::vector<double> widths;
        for (std::size_t i = 0; i < torus.points.size(); ++i)
            widths.push_back(0.05 + 0.02 * double(i % 3));
        tree->set_widths(widths);
        dipoles = VectorField(tree->size());
        for (std::size_t i = 0; i < tree->size(); ++i) {
            const Index p = tree->order()[i];
            pairs.points.push_back(torus.points[p]);
            pairs.dipoles.push_back(0.01 * (torus.normals[p] + Vec3{0.1, 0.0, 0.2}));
            pairs.charges.push_back(0.3 + 0.1 * std::sin(double(p)));
            pairs.softening.push_back(0.5 * widths[p] * widths[p]);
            dipoles.x[i] = float(pairs.dipoles[i].x);
            dipoles.y[i] = float(pairs.dipoles[i].y);
            dipoles.z[i] = float(pairs.dipoles[i].z);
            charges.push_back(float(pairs.charges[i]));
        }
    }

    Context context;
    std::unique_ptr<WindingTree> tree;
    Pairs pairs;
    VectorField dipoles;
    ScalarField charges;
};

TEST_F(WindingTreeSums, winding_numbers_are_those_of_all_pairs)
{
    ScalarField found;
    tree->winding(dipoles, found, context);
    double largest = 0.0, error = 0.0;
    for (std::size_t i = 0; i < tree->size(); ++i) {
        double expected = 0.0;
        for (std::size_t j = 0; j < tree->size(); ++j)
            expected += dot(pairs.dipoles[j], kernel(pairs, i, j));
        largest = std::max(largest, std::abs(expected));
        error = std::max(error, std::abs(expected - double(found[i])));
    }
    EXPECT_LT(error, tree_error * largest);
}

TEST_F(WindingTreeSums, the_adjoint_is_the_transpose)
{
    ScalarField winding;
    VectorField adjoint;
    tree->winding(dipoles, winding, context);
    tree->adjoint(charges, adjoint, context);
    double left = 0.0, right = 0.0;
    for (std::size_t i = 0; i < tree->size(); ++i) {
        left += double(charges[i]) * double(winding[i]);
        right += pairs.dipoles[i].x * double(adjoint.x[i]) +
                 pairs.dipoles[i].y * double(adjoint.y[i]) +
                 pairs.dipoles[i].z * double(adjoint.z[i]);
    }
    EXPECT_NEAR(left, right, tree_error * std::abs(left));
}

TEST_F(WindingTreeSums, outward_is_the_negated_gradient_of_the_winding_number)
{
    VectorField found;
    tree->outward(dipoles, found, context);
    double largest = 0.0, error = 0.0;
    constexpr double h = 1e-5;
    for (std::size_t i = 0; i < tree->size(); i += 7) {
        Vec3 gradient;
        for (int axis = 0; axis < 3; ++axis) {
            double values[2] = {};
            for (const int side : {0, 1}) {
                Pairs moved = pairs;
                moved.points[i][axis] += side == 0 ? -h : h;
                for (std::size_t j = 0; j < tree->size(); ++j) {
                    // The field of the point itself stays where it was.
                    const Vec3 r = pairs.points[j] - moved.points[i];
                    const double r2 = norm_squared(r) + pairs.softening[i] + pairs.softening[j];
                    values[side] += dot(pairs.dipoles[j], r) / (4.0 * pi * r2 * std::sqrt(r2));
                }
            }
            gradient[axis] = (values[1] - values[0]) / (2.0 * h);
        }
        const Vec3 here{found.x[i], found.y[i], found.z[i]};
        largest = std::max(largest, norm(gradient));
        error = std::max(error, norm(here + gradient));
    }
    EXPECT_LT(error, tree_error * largest);
}

TEST(WindingTree, a_sphere_has_winding_number_one_inside_and_zero_outside)
{
    constexpr std::size_t n = 4000;
    auto s = fixtures::sphere_points(n, 3.0, {10.0, -20.0, 5.0});
    // Points without a dipole feel the field of the others.
    const std::vector<Vec3> probes{
        {10.0, -20.0, 5.0}, {12.0, -20.0, 5.0}, {10.0, -20.0, 9.0}, {14.0, -20.0, 5.0}};
    s.points.insert(s.points.end(), probes.begin(), probes.end());
    Context context;
    const auto tree = WindingTree::build(s.points, 6.0, context);
    ASSERT_TRUE(tree);
    VectorField dipoles(s.points.size());
    const double area = 4.0 * pi / n * (3.0 / 6.0) * (3.0 / 6.0); // in units of 6
    for (std::size_t i = 0; i < s.points.size(); ++i) {
        const Index p = tree->order()[i];
        const Vec3 d = p < n ? area * s.normals[p] : Vec3{};
        dipoles.x[i] = float(d.x), dipoles.y[i] = float(d.y), dipoles.z[i] = float(d.z);
    }
    ScalarField w;
    tree->winding(dipoles, w, context);
    std::vector<double> found(s.points.size());
    for (std::size_t i = 0; i < s.points.size(); ++i)
        found[tree->order()[i]] = double(w[i]);
    EXPECT_NEAR(found[n], 1.0, tree_error);
    EXPECT_NEAR(found[n + 1], 1.0, tree_error);
    EXPECT_NEAR(found[n + 2], 0.0, tree_error);
    EXPECT_NEAR(found[n + 3], 0.0, tree_error);
}

} // namespace
} // namespace bot2nurbs
