// SPDX-License-Identifier: MIT
#include "cloud/poisson_surface.h"

#include "cloud/octree_surface.h"
#include "cloud/poisson_system.h"

#include <algorithm>
#include <cmath>

namespace bot2nurbs {

namespace {

//! Side of the cube over the longest side of the points' box: surfaces that close a hole need room
//! to bulge.
constexpr double cube_margin = 1.25;
//! Cells are at least this many spacings wide (and less than twice that). Smaller ones resolve the
//! single points and their noise, larger ones lose thin parts; measured on known bodies.
constexpr double cell_over_spacing = 0.7;
//! Cells narrower than twice the noise's deviation show the noise.
constexpr double cell_over_noise = 2.0;
//! The octree is full down to here, so that the surface is smooth where there are no points.
constexpr int full_level = 4;
constexpr int least_level = 3, most_level = 15;
//! How strongly the surface is held to the points; the value of \cite kazhdan_2013.
constexpr double point_weight = 4.0;

//! Between the coordinates of the points and the unit cube.
struct Cube {
    Vec3 corner;
    double side = 1.0;

    explicit Cube(const Box3& box)
    {
        const Vec3 s = box.max - box.min;
        side = cube_margin * std::max({s.x, s.y, s.z});
        corner = box.center() - 0.5 * side * Vec3{1.0, 1.0, 1.0};
    }
    Vec3 to_unit(const Vec3& p) const { return (p - corner) / side; }
    Vec3 from_unit(const Vec3& p) const { return side * p + corner; }
};

} // namespace

Result<PoissonSurface> poisson_surface(const std::vector<Vec3>& points,
                                       const SurfaceEstimate& estimate,
                                       const ReconstructOptions& options, int halvings,
                                       Context& context)
{
    Box3 box;
    std::size_t count = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (!estimate.outlier[i]) {
            box.add(points[i]);
            ++count;
        }
    if (count == 0 || !(box.diagonal() > 0.0))
        return Error{ErrorCode::bad_geometry, "no points show a surface", invalid_index};
    const Cube cube(box);
    // Each vertex of the mesh stands for this many points.
    const double growth =
        std::max(1.0, std::sqrt(static_cast<double>(count) / options.most_vertices));
    const int deepest = std::min(options.depth.value_or(most_level) + halvings, most_level);
    std::vector<PoissonSample> samples;
    std::vector<WantedCell> wanted;
    samples.reserve(count);
    wanted.reserve(count);
    int depth = full_level;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (estimate.outlier[i] || estimate.normals[i] == Vec3{})
            continue;
        const double spacing = estimate.spacing[i] / cube.side;
        const double cell = std::max(cell_over_spacing * growth * spacing,
                                     cell_over_noise * estimate.noise / cube.side);
        PoissonSample s;
        s.position = cube.to_unit(points[i]);
        s.normal = estimate.normals[i];
        s.area = spacing * spacing;
        // A cell of no width (points at one place) asks for the finest level.
        const double level = cell > 0.0 ? std::floor(-std::log2(cell)) + halvings : most_level;
        s.level = static_cast<int>(std::clamp<double>(level, least_level, deepest));
        s.weight = estimate.confidence[i] * point_weight * s.area / Octree::cell_size(s.level);
        samples.push_back(s);
        WantedCell w;
        w.level = s.level;
        const double cells = 1.0 / Octree::cell_size(s.level);
        for (int k = 0; k < 3; ++k)
            w.place[static_cast<std::size_t>(k)] =
                static_cast<std::uint32_t>(std::clamp(s.position[k] * cells, 0.0, cells - 1.0));
        wanted.push_back(w);
        depth = std::max(depth, s.level);
    }
    const Result<Octree> tree = Octree::build(wanted, full_level, depth, context);
    if (!tree)
        return tree.error();
    const Result<PoissonSolve> solved = solve_poisson(*tree, samples, context);
    if (!solved)
        return solved.error();
    Result<TriangleSoup> mesh = octree_surface(*tree, solved->function, context);
    if (!mesh)
        return mesh.error();
    if (mesh->triangles.empty())
        return Error{ErrorCode::bad_geometry,
                     "the points show no surface: their normals cancel each other", invalid_index};
    for (Vec3& p : mesh->positions)
        p = cube.from_unit(p);
    return PoissonSurface{std::move(*mesh), tree->depth()};
}

} // namespace bot2nurbs
