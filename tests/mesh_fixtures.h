// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/manifold_mesh.h"

#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

//! Meshes built in code for tests. Closed ones turn outward unless the name says otherwise.
namespace bot2nurbs::fixtures {

inline constexpr double pi = 3.14159265358979323846;

//! Builds a mesh that a fixture promises to be manifold; a failure is a bug of the fixture.
inline ManifoldMesh must_build(std::vector<Vec3> positions,
                               std::vector<std::array<Index, 3>> triangles)
{
    Result<ManifoldMesh> mesh = ManifoldMesh::build(std::move(positions), std::move(triangles));
    if (!mesh)
        std::abort();
    return std::move(mesh.value());
}

inline TriangleSoup soup_of(const ManifoldMesh& mesh)
{
    TriangleSoup soup;
    soup.positions = mesh.positions();
    soup.triangles = mesh.triangles();
    soup.source_face.resize(soup.triangles.size());
    for (std::size_t f = 0; f < soup.triangles.size(); ++f)
        soup.source_face[f] = static_cast<Index>(f);
    return soup;
}

//! `a` with the elements of `b` behind its own.
inline TriangleSoup joined(TriangleSoup a, const TriangleSoup& b)
{
    const Index shift = static_cast<Index>(a.positions.size());
    a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
    for (const auto& t : b.triangles) {
        a.source_face.push_back(static_cast<Index>(a.triangles.size()));
        a.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
    }
    return a;
}

//! The soup with every position replaced by f(position).
inline TriangleSoup moved(TriangleSoup soup, const std::function<Vec3(const Vec3&)>& f)
{
    for (Vec3& p : soup.positions)
        p = f(p);
    return soup;
}

//! The mesh with every position replaced by f(position).
inline ManifoldMesh moved(const ManifoldMesh& mesh, const std::function<Vec3(const Vec3&)>& f)
{
    std::vector<Vec3> positions = mesh.positions();
    for (Vec3& p : positions)
        p = f(p);
    return must_build(std::move(positions), mesh.triangles());
}

//! All faces turned round.
inline TriangleSoup turned(TriangleSoup soup)
{
    for (auto& t : soup.triangles)
        std::swap(t[1], t[2]);
    return soup;
}

//! Every face with three vertices of its own.
inline TriangleSoup unwelded(const TriangleSoup& soup)
{
    TriangleSoup out;
    for (const auto& t : soup.triangles) {
        const Index v = static_cast<Index>(out.positions.size());
        for (const Index i : t)
            out.positions.push_back(soup.positions[i]);
        out.source_face.push_back(static_cast<Index>(out.triangles.size()));
        out.triangles.push_back({v, v + 1, v + 2});
    }
    return out;
}

//! Each face split into four at the middles of its edges.
inline ManifoldMesh split_in_four(const ManifoldMesh& mesh)
{
    std::vector<Vec3> positions = mesh.positions();
    std::vector<Index> middle(mesh.halfedge_count(), invalid_index);
    for (Index h = 0; h < mesh.halfedge_count(); ++h) {
        if (mesh.edge(h) != h)
            continue;
        middle[h] = static_cast<Index>(positions.size());
        positions.push_back(0.5 * (mesh.position(mesh.from(h)) + mesh.position(mesh.to(h))));
    }
    std::vector<std::array<Index, 3>> triangles;
    for (Index f = 0; f < mesh.face_count(); ++f) {
        const auto& t = mesh.triangle(f);
        std::array<Index, 3> m{};
        for (Index k = 0; k < 3; ++k)
            m[k] = middle[mesh.edge(3 * f + k)];
        triangles.push_back({t[0], m[0], m[2]});
        triangles.push_back({m[0], t[1], m[1]});
        triangles.push_back({m[2], m[1], t[2]});
        triangles.push_back({m[0], m[1], m[2]});
    }
    return must_build(std::move(positions), std::move(triangles));
}

inline ManifoldMesh tetrahedron()
{
    return must_build({{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}},
                      {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}});
}

inline ManifoldMesh octahedron()
{
    return must_build(
        {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
        {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}});
}

inline ManifoldMesh icosahedron()
{
    const double g = 0.5 * (1.0 + std::sqrt(5.0));
    std::vector<Vec3> positions = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                                   {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                                   {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
    for (Vec3& p : positions)
        p = normalized(p);
    return must_build(std::move(positions),
                      {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                       {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                       {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                       {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}});
}

//! Unit sphere with 20 * 4^levels faces.
inline ManifoldMesh icosphere(int levels)
{
    ManifoldMesh mesh = icosahedron();
    for (int i = 0; i < levels; ++i)
        mesh = moved(split_in_four(mesh), [](const Vec3& p) { return normalized(p); });
    return mesh;
}

//! Torus about the z axis with m x n cells of two triangles; m, n >= 3.
inline ManifoldMesh torus(int m, int n, double radius = 1.0, double tube = 0.4)
{
    std::vector<Vec3> positions;
    std::vector<std::array<Index, 3>> triangles;
    for (int i = 0; i < m; ++i)
        for (int j = 0; j < n; ++j) {
            const double a = 2.0 * pi * i / m, b = 2.0 * pi * j / n;
            const double r = radius + tube * std::cos(b);
            positions.push_back({r * std::cos(a), r * std::sin(a), tube * std::sin(b)});
            const auto at = [&](int p, int q) { return static_cast<Index>((p % m) * n + q % n); };
            triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    return must_build(std::move(positions), std::move(triangles));
}

//! Cylinder side about the z axis without caps: two boundary loops; m >= 3 around, n >= 1 up.
inline ManifoldMesh open_cylinder(int m, int n, double radius = 1.0, double height = 2.0)
{
    std::vector<Vec3> positions;
    std::vector<std::array<Index, 3>> triangles;
    for (int i = 0; i <= n; ++i)
        for (int j = 0; j < m; ++j) {
            const double a = 2.0 * pi * j / m;
            positions.push_back(
                {radius * std::cos(a), radius * std::sin(a), height * (double(i) / n - 0.5)});
            if (i == n)
                continue;
            const auto at = [&](int p, int q) { return static_cast<Index>(p * m + q % m); };
            triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
            triangles.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
        }
    return must_build(std::move(positions), std::move(triangles));
}

//! The unit square in the plane z = 0 with n x n cells: a disk.
inline ManifoldMesh square(int n)
{
    std::vector<Vec3> positions;
    std::vector<std::array<Index, 3>> triangles;
    for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n; ++j) {
            positions.push_back({double(j) / n, double(i) / n, 0.0});
            if (i == n || j == n)
                continue;
            const auto at = [&](int p, int q) { return static_cast<Index>(p * (n + 1) + q); };
            triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
            triangles.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
        }
    return must_build(std::move(positions), std::move(triangles));
}

//! Boundary of a union of unit cells of the integer grid; cells must not touch in a mere edge or
//! corner. Any genus can be made this way.
inline ManifoldMesh polycube(const std::vector<std::array<int, 3>>& cells)
{
    std::map<std::array<int, 3>, Index> vertex;
    std::vector<Vec3> positions;
    std::vector<std::array<Index, 3>> triangles;
    const auto at = [&](const std::array<int, 3>& c) {
        const auto [it, added] = vertex.try_emplace(c, static_cast<Index>(positions.size()));
        if (added)
            positions.push_back({double(c[0]), double(c[1]), double(c[2])});
        return it->second;
    };
    const std::set<std::array<int, 3>> solid(cells.begin(), cells.end());
    const auto filled = [&](const std::array<int, 3>& c) { return solid.count(c) != 0; };
    for (const auto& c : cells)
        for (int axis = 0; axis < 3; ++axis)
            for (int side = 0; side < 2; ++side) {
                std::array<int, 3> other = c;
                other[axis] += side == 1 ? 1 : -1;
                if (filled(other))
                    continue;
                const int u = (axis + 1) % 3, v = (axis + 2) % 3;
                std::array<int, 3> corner = c;
                corner[axis] += side;
                std::array<std::array<int, 3>, 4> q{corner, corner, corner, corner};
                ++q[1][u], ++q[2][u], ++q[2][v], ++q[3][v];
                std::array<Index, 4> i{at(q[0]), at(q[1]), at(q[2]), at(q[3])};
                if (side == 0)
                    std::swap(i[1], i[3]);
                triangles.push_back({i[0], i[1], i[2]});
                triangles.push_back({i[0], i[2], i[3]});
            }
    return must_build(std::move(positions), std::move(triangles));
}

//! The cube [-1, 1]^3 with n x n cells on each side.
inline ManifoldMesh cube(int n)
{
    std::vector<std::array<int, 3>> cells;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            for (int k = 0; k < n; ++k)
                cells.push_back({i, j, k});
    return moved(polycube(cells), [n](const Vec3& p) {
        return Vec3{2.0 * p.x / n - 1.0, 2.0 * p.y / n - 1.0, 2.0 * p.z / n - 1.0};
    });
}

//! Every vertex moved `rounds` times to the mean of its neighbours.
inline ManifoldMesh smoothed(const ManifoldMesh& mesh, int rounds)
{
    std::vector<Vec3> positions = mesh.positions();
    for (int i = 0; i < rounds; ++i) {
        std::vector<Vec3> sum(positions.size());
        std::vector<int> count(positions.size(), 0);
        for (Index h = 0; h < mesh.halfedge_count(); ++h) {
            sum[mesh.from(h)] += positions[mesh.to(h)];
            ++count[mesh.from(h)];
        }
        for (std::size_t v = 0; v < positions.size(); ++v)
            positions[v] = sum[v] / count[v];
    }
    return must_build(std::move(positions), mesh.triangles());
}

//! Plate with `genus` square holes, split `levels` times and smoothed: a closed surface of any
//! genus.
inline ManifoldMesh holed_plate(int genus, int levels = 1)
{
    std::vector<std::array<int, 3>> cells;
    for (int i = 0; i < 2 * genus + 1; ++i)
        for (int j = 0; j < 3; ++j)
            if (i % 2 == 0 || j != 1)
                cells.push_back({i, j, 0});
    ManifoldMesh mesh = polycube(cells);
    for (int i = 0; i < levels; ++i)
        mesh = smoothed(split_in_four(mesh), 2);
    return mesh;
}

//! A closed smooth-looking surface of genus two.
inline ManifoldMesh genus_two(int levels = 1)
{
    return holed_plate(2, levels);
}

//! Two unit spheres with centres 3 apart on the x axis.
inline TriangleSoup two_spheres(int levels = 1)
{
    const TriangleSoup sphere = soup_of(icosphere(levels));
    return joined(sphere, moved(sphere, [](const Vec3& p) { return p + Vec3{3, 0, 0}; }));
}

//! Moebius band of n cells: not orientable.
inline TriangleSoup moebius_band(int n = 24)
{
    TriangleSoup soup;
    for (int i = 0; i < n; ++i) {
        const double a = 2.0 * pi * i / n;
        for (const double s : {-0.4, 0.4}) {
            const double r = 1.0 + s * std::cos(0.5 * a);
            soup.positions.push_back({r * std::cos(a), r * std::sin(a), s * std::sin(0.5 * a)});
        }
        const Index p = static_cast<Index>(2 * i), q = p + 1;
        // The last cell joins the first with its two sides exchanged.
        const Index r = i + 1 < n ? p + 2 : 1, s = i + 1 < n ? p + 3 : 0;
        soup.triangles.push_back({p, r, s});
        soup.triangles.push_back({p, s, q});
        soup.source_face.push_back(static_cast<Index>(i));
        soup.source_face.push_back(static_cast<Index>(i));
    }
    return soup;
}

struct NamedMesh {
    std::string name;
    ManifoldMesh mesh;
    int genus;
};

//! One closed connected mesh of each kind.
inline std::vector<NamedMesh> closed_meshes()
{
    return {{"tetrahedron", tetrahedron(), 0}, {"octahedron", octahedron(), 0},
            {"icosphere", icosphere(2), 0},    {"cube", cube(4), 0},
            {"torus", torus(16, 9), 1},        {"genus_two", genus_two(), 2},
            {"holed_plate", holed_plate(5), 5}};
}

//! Open connected meshes.
inline std::vector<NamedMesh> open_meshes()
{
    return {{"open_cylinder", open_cylinder(12, 4), 0}, {"square", square(5), 0}};
}

} // namespace bot2nurbs::fixtures
