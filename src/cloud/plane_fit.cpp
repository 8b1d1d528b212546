// SPDX-License-Identifier: MIT
#include "cloud/plane_fit.h"

#include <Eigen/Dense>
#include <cmath>

namespace bot2nurbs {

namespace {

constexpr int coefficients = 6;

} // namespace

PlaneFit fit_plane(const std::vector<Vec3>& points, const PointTree::Neighbor* found,
                   std::size_t count)
{
    const double n = static_cast<double>(count);
    PlaneFit fit;
    // Relative to one of the points, so that nothing is lost far from the origin.
    const Vec3 origin = points[found[0].point];
    for (std::size_t i = 0; i < count; ++i)
        fit.centroid += points[found[i].point] - origin;
    const Vec3 mean = fit.centroid / n;
    fit.centroid = origin + mean;
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 d = points[found[i].point] - origin - mean;
        const Eigen::Vector3d v(d.x, d.y, d.z);
        covariance += v * v.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance / n);
    for (int k = 0; k < 3; ++k) {
        const Eigen::Vector3d v = solver.eigenvectors().col(k);
        fit.axes[static_cast<std::size_t>(k)] = {v.x(), v.y(), v.z()};
        fit.variances[static_cast<std::size_t>(k)] = std::max(solver.eigenvalues()[k], 0.0);
    }
    return fit;
}

double quadric_residual(const std::vector<Vec3>& points, const PointTree::Neighbor* found,
                        std::size_t count, const PlaneFit& plane)
{
    if (count <= coefficients)
        return INFINITY;
    using Vector6 = Eigen::Matrix<double, coefficients, 1>;
    Eigen::Matrix<double, coefficients, coefficients> normal;
    normal.setZero();
    Vector6 right = Vector6::Zero();
    double heights = 0.0;
    // In units of the neighbourhood, so that the equations are well scaled.
    const double unit = std::sqrt(plane.variances[1] + plane.variances[2]);
    if (!(unit > 0.0))
        return 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 d = (points[found[i].point] - plane.centroid) / unit;
        const double u = dot(d, plane.axes[1]), v = dot(d, plane.axes[2]);
        const double h = dot(d, plane.axes[0]);
        Vector6 row;
        row << 1.0, u, v, u * u, u * v, v * v;
        normal += row * row.transpose();
        right += h * row;
        heights += h * h;
    }
    const Vector6 solution = normal.ldlt().solve(right);
    const double rest = std::max(heights - solution.dot(right), 0.0);
    return unit * std::sqrt(rest / static_cast<double>(count - coefficients));
}

} // namespace bot2nurbs
