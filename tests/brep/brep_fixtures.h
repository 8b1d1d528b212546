// SPDX-License-Identifier: MIT
#pragma once

//! B-Reps made in code for tests.

#include "bot2nurbs/brep.h"
#include "domain_fixtures.h"

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>

#include <algorithm>
#include <array>
#include <cmath>
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

//! One quad over the square, its points placed by a function.
template <class Point> Brep one_face(Point point)
{
    const Domain d = disk_grid(1, 1);
    Result<Brep> brep = assemble_brep(d.complex, surface_of_points(1, point), KnotForm::c1);
    // Built by hand where assemble_brep itself refuses: the arrays of a good face, other points.
    Brep b = brep ? *brep
                  : must_assemble(d.complex,
                                  surface_of_points(1,
                                                    [](Index, Index i, Index j) {
                                                        return Vec3{double(i), double(j), 0.0};
                                                    }),
                                  KnotForm::c1);
    const std::array<Index, 10> pick{0, 1, 2, 4, 5, 7, 8, 10, 11, 12};
    BsplinePatch& s = b.surfaces[0];
    for (Index i = 0; i < 10; ++i) {
        for (Index j = 0; j < 10; ++j)
            s.control[10 * i + j] = point(0, pick[i], pick[j]);
    }
    for (const BrepTrim& t : b.trims) {
        BrepCurve3& c = b.curves3[b.edges[t.edge].curve];
        for (Index k = 0; k < 10; ++k) {
            const Index i = t.iso == TrimIso::south   ? k
                            : t.iso == TrimIso::east  ? 9
                            : t.iso == TrimIso::north ? 9 - k
                                                      : 0;
            const Index j = t.iso == TrimIso::south   ? 0
                            : t.iso == TrimIso::east  ? k
                            : t.iso == TrimIso::north ? 9
                                                      : 9 - k;
            c.control[t.reversed ? 9 - k : k] = s.control[10 * i + j];
        }
        b.vertices[b.edges[t.edge].vertex[0]].point = c.control.front();
        b.vertices[b.edges[t.edge].vertex[1]].point = c.control.back();
    }
    return b;
}

//! An open tube of one face, closed in u: one seam edge, two closed boundary edges.
inline Brep seam_tube()
{
    const Brep patch = one_face([](Index, Index i, Index j) {
        const double a = i == 12 ? 0.0 : M_PI / 6 * i;
        return Vec3{std::cos(a), std::sin(a), j / 12.0};
    });
    Brep b;
    b.surfaces = patch.surfaces;
    b.curves2 = {{{0, 0}, {4, 0}, 0, 4},
                 {{4, 0}, {4, 4}, 0, 4},
                 {{4, 4}, {0, 4}, 0, 4},
                 {{0, 4}, {0, 0}, 0, 4}};
    // Curves: bottom circle, seam upward, top circle; all in the direction of growing parameters.
    const auto pick = [&](Index start, Index step) {
        BrepCurve3 c;
        c.knots = b.surfaces[0].knots;
        for (Index k = 0; k < 10; ++k)
            c.control.push_back(b.surfaces[0].control[start + step * k]);
        return c;
    };
    b.curves3 = {pick(0, 10), pick(0, 1), pick(9, 10)};
    b.vertices = {{b.curves3[0].control[0], {0, 0, 1}}, {b.curves3[2].control[0], {1, 2, 2}}};
    b.edges = {{0, {0, 0}, {0}, 0, 4}, {1, {0, 1}, {1, 3}, 0, 4}, {2, {1, 1}, {2}, 0, 4}};
    b.trims = {{0, 0, {0, 0}, false, TrimType::boundary, TrimIso::south, 0, 0, 4},
               {1, 1, {0, 1}, false, TrimType::seam, TrimIso::east, 0, 0, 4},
               {2, 2, {1, 1}, true, TrimType::boundary, TrimIso::north, 0, 0, 4},
               {3, 1, {1, 0}, true, TrimType::seam, TrimIso::west, 0, 0, 4}};
    b.loops = {{{0, 1, 2, 3}, 0}};
    b.faces = {{{0}, 0, false}};
    return b;
}

} // namespace bot2nurbs::fixtures
