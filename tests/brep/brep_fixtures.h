// SPDX-License-Identifier: MIT
#pragma once

//! B-Reps made in code for tests.

#include "bot2nurbs/brep.h"
#include "domain_fixtures.h"

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>

#include <functional>
#include <stdexcept>

namespace bot2nurbs::fixtures {

using Projection = std::function<Vec3(const Vec3&)>;

inline Vec3 to_unit_sphere(const Vec3& p)
{
    return normalized(p);
}
inline Vec3 stay(const Vec3& p)
{
    return p;
}

//! The Peters network over a domain whose Bezier points are, in the least squares sense, the
//! bilinear patches moved by `project`; exact G1 because the constraints are kept.
inline SplineSurface network_surface(const Domain& d, const Projection& project)
{
    const Result<SplineNetwork> network = build_spline_network(d.complex, SplineScheme::peters);
    if (!network)
        throw std::logic_error(d.name + ": " + network.error().message);
    const SparseRows &rows = network->stencils, &fixed = network->constraints;
    const int n = static_cast<int>(network->unknown_count);
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::MatrixXd target(rows.row_count(), 3);
    for (Index r = 0; r < rows.row_count(); ++r) {
        for (std::size_t i = rows.offset[r]; i < rows.offset[r + 1]; ++i)
            entries.emplace_back(r, rows.column[i], rows.weight[i]);
        const auto& q = d.complex.quad(r / 169);
        const double u = (r % 169) / 13 / 12.0, v = r % 13 / 12.0;
        const Vec3 p = project((1 - u) * ((1 - v) * d.positions[q[0]] + v * d.positions[q[3]]) +
                               u * ((1 - v) * d.positions[q[1]] + v * d.positions[q[2]]));
        target.row(r) << p.x, p.y, p.z;
    }
    Eigen::SparseMatrix<double> b(rows.row_count(), n);
    b.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SparseMatrix<double> normal = b.transpose() * b;
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(normal);
    Eigen::MatrixXd x = solver.solve(b.transpose() * target);
    for (Index r = 0; r < fixed.row_count(); ++r) { // disjoint rows: one projection each
        Eigen::RowVector3d excess = Eigen::RowVector3d::Zero();
        double squares = 0.0;
        for (std::size_t i = fixed.offset[r]; i < fixed.offset[r + 1]; ++i) {
            excess += fixed.weight[i] * x.row(fixed.column[i]);
            squares += fixed.weight[i] * fixed.weight[i];
        }
        for (std::size_t i = fixed.offset[r]; i < fixed.offset[r + 1]; ++i)
            x.row(fixed.column[i]) -= fixed.weight[i] / squares * excess;
    }
    std::vector<Vec3> unknowns(n);
    for (int i = 0; i < n; ++i)
        unknowns[i] = {x(i, 0), x(i, 1), x(i, 2)};
    return SplineSurface(*network, unknowns);
}

//! A B-Rep that must exist.
inline Brep must_assemble(const QuadComplex& complex, const SplineSurface& surface, KnotForm form)
{
    Result<Brep> brep = assemble_brep(complex, surface, form);
    if (!brep)
        throw std::logic_error(brep.error().message);
    return std::move(*brep);
}

inline Brep brep_of(const Domain& d, KnotForm form, const Projection& project = stay)
{
    Brep brep = must_assemble(d.complex, network_surface(d, project), form);
    brep.name = d.name;
    return brep;
}

//! 6 * 4^levels patches close to the unit sphere.
inline Brep sphere_brep(int levels, KnotForm form)
{
    return brep_of(sphere_cube(levels), form, to_unit_sphere);
}

//! A surface whose Bezier point (i, j) of patch q is point(q, i, j).
template <class Point> SplineSurface surface_of_points(Index patches, Point point)
{
    SplineSurface surface;
    surface.bezier().resize(std::size_t{169} * patches);
    for (Index q = 0; q < patches; ++q) {
        for (Index i = 0; i < 13; ++i) {
            for (Index j = 0; j < 13; ++j)
                surface.bezier()[SplineNetwork::row(q, i, j)] = point(q, i, j);
        }
    }
    return surface;
}

//! Moves and scales all points.
inline void transform(Brep& brep, double scale, const Vec3& offset)
{
    const auto move = [&](Vec3& p) { p = scale * p + offset; };
    for (BrepCurve3& c : brep.curves3)
        std::for_each(c.control.begin(), c.control.end(), move);
    for (BsplinePatch& s : brep.surfaces)
        std::for_each(s.control.begin(), s.control.end(), move);
    for (BrepVertex& v : brep.vertices)
        move(v.point);
}

//! Appends the arrays of another B-Rep; nothing is shared between the two.
inline void append(Brep& brep, const Brep& other)
{
    const Index c2 = static_cast<Index>(brep.curves2.size()),
                c3 = static_cast<Index>(brep.curves3.size()),
                s = static_cast<Index>(brep.surfaces.size()),
                v = static_cast<Index>(brep.vertices.size()),
                e = static_cast<Index>(brep.edges.size()),
                t = static_cast<Index>(brep.trims.size()),
                l = static_cast<Index>(brep.loops.size()),
                f = static_cast<Index>(brep.faces.size());
    const auto shift = [](std::vector<Index>& list, Index by) {
        for (Index& i : list)
            i += by;
    };
    brep.curves2.insert(brep.curves2.end(), other.curves2.begin(), other.curves2.end());
    brep.curves3.insert(brep.curves3.end(), other.curves3.begin(), other.curves3.end());
    brep.surfaces.insert(brep.surfaces.end(), other.surfaces.begin(), other.surfaces.end());
    for (BrepVertex vertex : other.vertices) {
        shift(vertex.edges, e);
        brep.vertices.push_back(vertex);
    }
    for (BrepEdge edge : other.edges) {
        edge.curve += c3;
        edge.vertex = {edge.vertex[0] + v, edge.vertex[1] + v};
        shift(edge.trims, t);
        brep.edges.push_back(edge);
    }
    for (BrepTrim trim : other.trims) {
        trim.curve += c2;
        trim.edge += e;
        trim.vertex = {trim.vertex[0] + v, trim.vertex[1] + v};
        trim.loop += l;
        brep.trims.push_back(trim);
    }
    for (BrepLoop loop : other.loops) {
        shift(loop.trims, t);
        loop.face += f;
        brep.loops.push_back(loop);
    }
    for (BrepFace face : other.faces) {
        shift(face.loops, l);
        face.surface += s;
        brep.faces.push_back(face);
    }
    brep.solid = brep.solid && other.solid;
}

} // namespace bot2nurbs::fixtures
