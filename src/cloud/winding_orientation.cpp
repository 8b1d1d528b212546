// SPDX-License-Identifier: MIT
//
// Lin, Shi, Liu, Fast and Globally Consistent Normal Orientation based on the Winding Number Normal
// Consistency, 2024: a step of least squares towards winding numbers of one half alternates with
// turning every dipole against the gradient of the winding number.
//
// Differs from the paper: the length of a dipole is the area its point stands for, which the
// density says, in place of what the least squares leave it with; widths of the kernel follow the
// spacing and the noise at each point in place of one width for all.
#include "cloud/winding_orientation.h"

#include "cloud/local_scale.h"
#include "cloud/winding_tree.h"

#include <algorithm>
#include <cmath>

namespace bot2nurbs {

namespace {

//! With a third less some sparse thin parts keep a wrong side; more changes nothing.
constexpr int rounds = 30;
//! The kernel's width falls from round to round: wide kernels settle inside and outside of the
//! whole, narrow ones the details. It is the largest of these: a multiple of the point's own
//! spacing, of the cloud's median spacing (which alone starts wide: in a sparse part a wide kernel
//! would reach through it), and of the noise. Measured on bodies with clean, uneven, noisy and
//! outlier-ridden samples (docs/algorithms/cloud.md).
constexpr double first_own_width = 2.0, first_median_width = 8.0, last_width = 0.7;
constexpr double noise_width = 2.0;

double falling(double first, double share)
{
    return first * std::pow(last_width / first, share);
}

double squared_sum(const ScalarField& v)
{
    double sum = 0.0;
    for (const float f : v)
        sum += double(f) * f;
    return sum;
}

double squared_sum(const VectorField& v)
{
    return squared_sum(v.x) + squared_sum(v.y) + squared_sum(v.z);
}

//! One step of least squares towards winding numbers of one half, along the gradient.
void step_to_half(const WindingTree& tree, VectorField& dipoles, const Context& context)
{
    ScalarField rest, change;
    VectorField step;
    tree.winding(dipoles, rest, context);
    for (float& r : rest)
        r = 0.5f - r;
    tree.adjoint(rest, step, context);
    tree.winding(step, change, context);
    const double below = squared_sum(change);
    const auto length = static_cast<float>(below > 0.0 ? squared_sum(step) / below : 0.0);
    for (std::size_t i = 0; i < dipoles.size(); ++i) {
        dipoles.x[i] += length * step.x[i];
        dipoles.y[i] += length * step.y[i];
        dipoles.z[i] += length * step.z[i];
    }
}

//! Turns the dipoles to where the winding number falls; their lengths become the areas.
void turn_outward(const WindingTree& tree, const ScalarField& areas, VectorField& dipoles,
                  VectorField& outward, const Context& context)
{
    tree.outward(dipoles, outward, context);
    for (std::size_t i = 0; i < dipoles.size(); ++i) {
        const float x = outward.x[i], y = outward.y[i], z = outward.z[i];
        const float length = std::sqrt(x * x + y * y + z * z);
        const float f = length > 0.0f ? areas[i] / length : 0.0f;
        dipoles.x[i] = f * x;
        dipoles.y[i] = f * y;
        dipoles.z[i] = f * z;
    }
}

} // namespace

Result<std::vector<Vec3>> winding_directions(const std::vector<Vec3>& points,
                                             const std::vector<double>& spacing, double noise,
                                             Context& context)
{
    const std::size_t n = points.size();
    Box3 box;
    for (const Vec3& p : points)
        box.add(p);
    const double unit = box.diagonal() > 0.0 ? box.diagonal() : 1.0;
    Result<WindingTree> tree = WindingTree::build(points, unit, context);
    if (!tree)
        return tree.error();
    ScalarField areas(n);
    for (std::size_t i = 0; i < n; ++i) {
        const double s = spacing[tree->order()[i]] / unit;
        areas[i] = static_cast<float>(s * s);
    }
    const double median = median_of(spacing);
    VectorField dipoles(n), outward;
    std::vector<double> widths(n);
    for (int round = 0; round < rounds; ++round) {
        const double share = double(round) / (rounds - 1);
        const double least =
            std::max(falling(first_median_width, share) * median, noise_width * noise);
        for (std::size_t i = 0; i < n; ++i)
            widths[i] = std::max(falling(first_own_width, share) * spacing[i], least);
        tree->set_widths(widths);
        step_to_half(*tree, dipoles, context);
        turn_outward(*tree, areas, dipoles, outward, context);
        if (context.cancelled())
            return Context::cancelled_error("orientation");
    }
    std::vector<Vec3> directions(n);
    for (std::size_t i = 0; i < n; ++i)
        directions[tree->order()[i]] = normalized(Vec3{outward.x[i], outward.y[i], outward.z[i]});
    return directions;
}

} // namespace bot2nurbs
