// SPDX-License-Identifier: MIT
#pragma once

//! What the tests of the spline layer share: random and smooth values of the unknowns of a network.

#include "bot2nurbs/spline_network.h"
#include "domain_fixtures.h"
#include "spline/patch_grid.h"

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>
#include <cstdint>
#include <gtest/gtest.h>

namespace bot2nurbs::fixtures {

//! A network that must exist.
inline SplineNetwork network_of(const Domain& d, SplineScheme scheme = SplineScheme::peters)
{
    auto built = build_spline_network(d.complex, scheme);
    if (!built)
        throw std::logic_error(d.name + ": " + built.error().message);
    return std::move(*built);
}

//! The networks of the schemes that cover every domain.
inline std::vector<SplineNetwork> networks_of(const Domain& d)
{
    return {network_of(d), network_of(d, SplineScheme::full)};
}

inline const char* name_of(SplineScheme scheme)
{
    return scheme == SplineScheme::peters ? "peters"
           : scheme == SplineScheme::full ? "full"
                                          : "eck_hoppe";
}

//! Reproducible numbers on every platform (the distributions of <random> are not).
class Random {
public:
    explicit Random(std::uint64_t seed) : state_(seed) {}
    //! Uniform in [-1, 1].
    double next()
    {
        state_ = state_ * 6364136223846793005u + 1442695040888963407u;
        return static_cast<double>(state_ >> 11) * 0x1p-52 - 1.0;
    }
    Vec3 point() { return {next(), next(), next()}; }

private:
    std::uint64_t state_;
};

inline Vec3 row_value(const SparseRows& rows, Index row, const std::vector<Vec3>& x)
{
    Vec3 sum;
    for (std::size_t i = rows.offset[row]; i < rows.offset[row + 1]; ++i) {
        sum += rows.weight[i] * x[rows.column[i]];
    }
    return sum;
}

//! Moves x to the nearest values that satisfy the constraint rows (their supports are disjoint).
inline void satisfy_constraints(const SplineNetwork& network, std::vector<Vec3>& x)
{
    const SparseRows& c = network.constraints;
    for (Index r = 0; r < c.row_count(); ++r) {
        double squares = 0.0;
        for (std::size_t i = c.offset[r]; i < c.offset[r + 1]; ++i) {
            squares += c.weight[i] * c.weight[i];
        }
        const Vec3 excess = row_value(c, r, x) / squares;
        for (std::size_t i = c.offset[r]; i < c.offset[r + 1]; ++i) {
            x[c.column[i]] -= c.weight[i] * excess;
        }
    }
}

inline std::vector<Vec3> random_unknowns(const SplineNetwork& network, std::uint64_t seed,
                                         bool constrained = true)
{
    Random random(seed);
    std::vector<Vec3> x(network.unknown_count);
    for (Vec3& p : x)
        p = random.point();
    if (constrained)
        satisfy_constraints(network, x);
    return x;
}

//! The network nearest to the bilinear patches over the domain's positions: a surface without folds
//! when the positions are those of a convex or gentle shape.
inline std::vector<Vec3> bilinear_unknowns(const SplineNetwork& network,
                                           const std::vector<Vec3>& positions)
{
    const SparseRows &s = network.stencils, &c = network.constraints;
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::MatrixXd target(s.row_count(), 3);
    for (Index r = 0; r < s.row_count(); ++r) {
        for (std::size_t i = s.offset[r]; i < s.offset[r + 1]; ++i) {
            entries.emplace_back(r, s.column[i], s.weight[i]);
        }
        const auto& q = network.complex.quad(r / 169);
        const double u = (r % 169) / 13 / 12.0, v = r % 13 / 12.0;
        const Vec3 p = (1 - u) * ((1 - v) * positions[q[0]] + v * positions[q[3]]) +
                       u * ((1 - v) * positions[q[1]] + v * positions[q[2]]);
        target.row(r) << p.x, p.y, p.z;
    }
    Eigen::SparseMatrix<double> b(s.row_count(), network.unknown_count);
    b.setFromTriplets(entries.begin(), entries.end());
    Eigen::SparseMatrix<double> normal = b.transpose() * b;
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(normal);
    const Eigen::MatrixXd x = solver.solve(b.transpose() * target);
    std::vector<Vec3> out(network.unknown_count);
    for (Index i = 0; i < network.unknown_count; ++i)
        out[i] = {x(i, 0), x(i, 1), x(i, 2)};
    if (c.row_count() > 0)
        satisfy_constraints(network, out);
    return out;
}

//! Bezier coefficient at (along, depth) as seen from the corner at the start of halfedge h.
inline Vec3 local_bezier(const SplineSurface& s, Index h, Index along, Index depth)
{
    const auto [i, j] = from_side(QuadComplex::side_of(h), along, depth, 12);
    return s.bezier(QuadComplex::quad_of(h), i, j);
}

//! Halfedges at an inner vertex, counter-clockwise: the sectors of its closed fan.
inline std::vector<Index> sectors_at(const QuadComplex& k, Index v)
{
    std::vector<Index> out;
    Index h = k.halfedge_at(v);
    do {
        out.push_back(h);
        h = k.rotate_ccw(h);
    } while (h != invalid_index && h != k.halfedge_at(v));
    return out;
}

//! cos(2 pi / n), exactly zero for n = 4.
inline double fan_cosine(Index n)
{
    return n == 4 ? 0.0 : std::cos(2.0 * M_PI / n);
}

inline double max_abs(const Vec3& v)
{
    return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
}

} // namespace bot2nurbs::fixtures
