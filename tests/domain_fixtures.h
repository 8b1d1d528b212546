// SPDX-License-Identifier: MIT
#pragma once

//! Quadrilateral domains built in code, with a position for every vertex. Quads turn outward.

#include "bot2nurbs/quad_complex.h"
#include "bot2nurbs/vec.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace bot2nurbs::fixtures {

using Quads = std::vector<std::array<Index, 4>>;
using VertexPairs = std::vector<std::pair<Index, Index>>;

struct Domain {
    std::string name;
    QuadComplex complex;
    std::vector<Vec3> positions;
};

//! Topology of quads that are known to be valid; throws otherwise, which fails the test.
inline Domain make_domain(std::string name, std::vector<Vec3> positions, Quads quads,
                          VertexPairs creases = {}, std::vector<Index> corners = {})
{
    auto built = QuadComplex::build(static_cast<Index>(positions.size()), std::move(quads),
                                    std::move(creases), std::move(corners));
    if (!built)
        throw std::logic_error(name + ": " + built.error().message);
    return {std::move(name), std::move(*built), std::move(positions)};
}

//! The same quads with creases and corners.
inline Domain with_features(const Domain& d, std::string name, VertexPairs creases,
                            std::vector<Index> corners = {})
{
    return make_domain(std::move(name), d.positions, d.complex.quads(), std::move(creases),
                       std::move(corners));
}

//! The six faces of [-1, 1]^3: eight vertices of valence 3.
inline Domain cube()
{
    return make_domain(
        "cube",
        {{-1, -1, -1},
         {1, -1, -1},
         {1, 1, -1},
         {-1, 1, -1},
         {-1, -1, 1},
         {1, -1, 1},
         {1, 1, 1},
         {-1, 1, 1}},
        {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}});
}

//! Splits polygons of any size into quads, one a corner: vertices, then edge midpoints and face
//! centres in order of use.
inline std::pair<std::vector<Vec3>, Quads> split_polygons(std::vector<Vec3> positions,
                                                          const std::vector<std::vector<Index>>& f)
{
    std::map<std::pair<Index, Index>, Index> middle;
    const auto mid = [&](Index a, Index b) {
        const auto [it, fresh] = middle.try_emplace({std::min(a, b), std::max(a, b)},
                                                    static_cast<Index>(positions.size()));
        if (fresh)
            positions.push_back(0.5 * (positions[a] + positions[b]));
        return it->second;
    };
    Quads quads;
    for (const auto& polygon : f) {
        const std::size_t n = polygon.size();
        Vec3 sum;
        for (Index v : polygon)
            sum += positions[v];
        const Index center = static_cast<Index>(positions.size());
        positions.push_back(sum / static_cast<double>(n));
        for (std::size_t i = 0; i < n; ++i) {
            const Index here = polygon[i];
            const Index after = mid(here, polygon[(i + 1) % n]);
            const Index before = mid(polygon[(i + n - 1) % n], here);
            quads.push_back({here, after, center, before});
        }
    }
    return {std::move(positions), std::move(quads)};
}

//! Every quad split into four; old vertices keep their numbers. Creases and corners are inherited.
inline Domain refine(const Domain& d)
{
    const QuadComplex& k = d.complex;
    std::vector<std::vector<Index>> polygons;
    for (const auto& q : k.quads())
        polygons.emplace_back(q.begin(), q.end());
    auto [positions, quads] = split_polygons(d.positions, polygons);
    VertexPairs creases;
    for (Index q = 0; q < k.quad_count(); ++q) {
        for (Index s = 0; s < 4; ++s) {
            if (!k.is_crease(k.edge(4 * q + s)))
                continue;
            const Index mid = quads[4 * q + s][1];
            creases.push_back({k.quad(q)[s], mid});
            creases.push_back({mid, k.quad(q)[(s + 1) % 4]});
        }
    }
    std::vector<Index> corners;
    for (Index v = 0; v < k.vertex_count(); ++v) {
        if (k.is_corner(v))
            corners.push_back(v);
    }
    return make_domain(d.name + "_refined", std::move(positions), std::move(quads),
                       std::move(creases), std::move(corners));
}

//! `levels` times refine(cube()), the positions on the unit sphere: 6 * 4^levels quads.
inline Domain sphere_cube(int levels)
{
    Domain d = cube();
    for (int i = 0; i < levels; ++i)
        d = refine(d);
    for (Vec3& p : d.positions)
        p = normalized(p);
    d.name = "sphere_cube_" + std::to_string(levels);
    return d;
}

//! Triangles of the double pyramid over a regular n-gon; apexes are vertices n (top) and n + 1.
inline std::pair<std::vector<Vec3>, std::vector<std::vector<Index>>> bipyramid_triangles(Index n)
{
    std::vector<Vec3> p;
    for (Index i = 0; i < n; ++i) {
        const double a = 2.0 * M_PI * i / n;
        p.push_back({std::cos(a), std::sin(a), 0.0});
    }
    p.push_back({0, 0, 1});
    p.push_back({0, 0, -1});
    std::vector<std::vector<Index>> t;
    for (Index i = 0; i < n; ++i) {
        t.push_back({i, (i + 1) % n, n});
        t.push_back({(i + 1) % n, i, n + 1});
    }
    return {std::move(p), std::move(t)};
}

//! A bipyramid with each triangle split into three quads: two vertices of valence n (the apexes n
//! and n + 1), the rest 4 and 3. Extraordinary vertices are not neighbours.
inline Domain split_bipyramid(Index n)
{
    auto [p, t] = bipyramid_triangles(n);
    auto [positions, quads] = split_polygons(std::move(p), t);
    return make_domain("split_bipyramid_" + std::to_string(n), std::move(positions),
                       std::move(quads));
}

//! One quad per edge of a bipyramid, from its two vertices and the centres of its two triangles:
//! the apexes n and n + 1 have valence n, the rest 4 and 3, neighbours both extraordinary.
inline Domain radial_bipyramid(Index n)
{
    auto [positions, t] = bipyramid_triangles(n);
    const Index first_center = static_cast<Index>(positions.size());
    std::map<std::pair<Index, Index>, Index> left;
    for (Index f = 0; f < t.size(); ++f) {
        for (int i = 0; i < 3; ++i)
            left[{t[f][i], t[f][(i + 1) % 3]}] = first_center + f;
    }
    for (const auto& f : t) {
        positions.push_back((positions[f[0]] + positions[f[1]] + positions[f[2]]) / 3.0);
    }
    Quads quads;
    for (const auto& [edge, center] : left) {
        const auto [a, b] = edge;
        if (a < b)
            quads.push_back({a, left.at({b, a}), b, center});
    }
    return make_domain("radial_bipyramid_" + std::to_string(n), std::move(positions),
                       std::move(quads));
}

//! Regular m x n grid on a ring torus of radii 3 and 1: all valences 4, m, n >= 3.
inline Domain torus_grid(Index m, Index n)
{
    std::vector<Vec3> p;
    Quads quads;
    for (Index i = 0; i < m; ++i) {
        for (Index j = 0; j < n; ++j) {
            const double a = 2.0 * M_PI * i / m, b = 2.0 * M_PI * j / n;
            p.push_back(
                {(3 + std::cos(b)) * std::cos(a), (3 + std::cos(b)) * std::sin(a), std::sin(b)});
            const Index i1 = (i + 1) % m, j1 = (j + 1) % n;
            quads.push_back({i * n + j, i1 * n + j, i1 * n + j1, i * n + j1});
        }
    }
    return make_domain("torus_" + std::to_string(m) + "x" + std::to_string(n), std::move(p),
                       std::move(quads));
}

//! The outer faces of unit cells; cells must meet in a manifold way.
inline Domain voxel_surface(std::string name, std::vector<std::array<int, 3>> cells)
{
    using Cell = std::array<int, 3>;
    // Per direction: the four corners of the face, counter-clockwise from outside.
    static const std::array<std::pair<Cell, std::array<Cell, 4>>, 6> sides{{
        {{1, 0, 0}, {{{1, 0, 0}, {1, 1, 0}, {1, 1, 1}, {1, 0, 1}}}},
        {{-1, 0, 0}, {{{0, 0, 0}, {0, 0, 1}, {0, 1, 1}, {0, 1, 0}}}},
        {{0, 1, 0}, {{{0, 1, 0}, {0, 1, 1}, {1, 1, 1}, {1, 1, 0}}}},
        {{0, -1, 0}, {{{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}}}},
        {{0, 0, 1}, {{{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}}},
        {{0, 0, -1}, {{{0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}}}},
    }};
    std::sort(cells.begin(), cells.end());
    std::map<Cell, Index> number;
    std::vector<Vec3> p;
    Quads quads;
    for (const Cell& c : cells) {
        for (const auto& [d, corners] : sides) {
            const Cell beside{c[0] + d[0], c[1] + d[1], c[2] + d[2]};
            if (std::binary_search(cells.begin(), cells.end(), beside))
                continue;
            std::array<Index, 4> quad{};
            for (int i = 0; i < 4; ++i) {
                const Cell at{c[0] + corners[i][0], c[1] + corners[i][1], c[2] + corners[i][2]};
                const auto [it, fresh] = number.try_emplace(at, static_cast<Index>(p.size()));
                if (fresh) {
                    p.push_back({double(at[0]), double(at[1]), double(at[2])});
                }
                quad[i] = it->second;
            }
            quads.push_back(quad);
        }
    }
    return make_domain(std::move(name), std::move(p), std::move(quads));
}

//! A 5 x 3 x 1 block of cells with two holes: genus 2, valences 3, 4 and 5.
inline Domain genus2()
{
    std::vector<std::array<int, 3>> cells;
    for (int x = 0; x < 5; ++x) {
        for (int y = 0; y < 3; ++y) {
            if (!(y == 1 && (x == 1 || x == 3)))
                cells.push_back({x, y, 0});
        }
    }
    return voxel_surface("genus2", std::move(cells));
}

//! m x n quads of the plane, an open disk.
inline Domain disk_grid(Index m, Index n)
{
    std::vector<Vec3> p;
    Quads quads;
    for (Index i = 0; i <= m; ++i) {
        for (Index j = 0; j <= n; ++j)
            p.push_back({double(i), double(j), 0.0});
    }
    for (Index i = 0; i < m; ++i) {
        for (Index j = 0; j < n; ++j) {
            const Index v = i * (n + 1) + j;
            quads.push_back({v, v + n + 1, v + n + 2, v + 1});
        }
    }
    return make_domain("disk_" + std::to_string(m) + "x" + std::to_string(n), std::move(p),
                       std::move(quads));
}

//! m quads around, n up, open at both ends.
inline Domain open_cylinder(Index m, Index n)
{
    std::vector<Vec3> p;
    Quads quads;
    for (Index i = 0; i < m; ++i) {
        const double a = 2.0 * M_PI * i / m;
        for (Index j = 0; j <= n; ++j)
            p.push_back({std::cos(a), std::sin(a), double(j)});
    }
    for (Index i = 0; i < m; ++i) {
        for (Index j = 0; j < n; ++j) {
            const Index v = i * (n + 1) + j, w = ((i + 1) % m) * (n + 1) + j;
            quads.push_back({v, w, w + 1, v + 1});
        }
    }
    return make_domain("cylinder_" + std::to_string(m) + "x" + std::to_string(n), std::move(p),
                       std::move(quads));
}

//! The first `sectors` of n sectors of rings x rings quads around vertex 0, in the plane. With all
//! sectors vertex 0 is interior of valence n, otherwise it is a boundary vertex.
inline Domain star_sectors(Index n, Index rings, Index sectors)
{
    std::vector<Vec3> p{{0, 0, 0}};
    std::map<std::array<Index, 3>, Index> number;
    const auto direction = [&](Index s) {
        const double a = 2.0 * M_PI * s / n;
        return Vec3{std::cos(a), std::sin(a), 0.0};
    };
    const auto vertex = [&](Index s, Index j, Index k) -> Index {
        if (j == 0 && k == 0)
            return 0;
        const std::array<Index, 3> key = k == 0   ? std::array<Index, 3>{s % n, j, 0}
                                         : j == 0 ? std::array<Index, 3>{(s + 1) % n, k, 0}
                                                  : std::array<Index, 3>{s, j, k};
        const auto [it, fresh] = number.try_emplace(key, static_cast<Index>(p.size()));
        if (fresh) {
            p.push_back(double(key[1]) * direction(key[0]) +
                        double(key[2]) * direction(key[0] + 1));
        }
        return it->second;
    };
    Quads quads;
    for (Index s = 0; s < sectors; ++s) {
        for (Index j = 0; j < rings; ++j) {
            for (Index k = 0; k < rings; ++k) {
                quads.push_back({vertex(s, j, k), vertex(s, j + 1, k), vertex(s, j + 1, k + 1),
                                 vertex(s, j, k + 1)});
            }
        }
    }
    const std::string size = std::to_string(n) + "x" + std::to_string(rings);
    return make_domain(sectors == n ? "star_" + size
                                    : "fan_" + std::to_string(sectors) + "_of_" + size,
                       std::move(p), std::move(quads));
}

//! An open disk of n sectors around one interior vertex of valence n.
inline Domain star(Index n, Index rings = 1)
{
    return star_sectors(n, rings, n);
}

//! The vertices at the other ends of the edges at v, counter-clockwise from halfedge_at(v); at a
//! boundary vertex the last edge is included.
inline std::vector<Index> neighbours(const QuadComplex& k, Index v)
{
    std::vector<Index> out;
    Index h = k.halfedge_at(v);
    do {
        out.push_back(k.to(h));
        const Index rotated = k.rotate_ccw(h);
        if (rotated == invalid_index) {
            out.push_back(k.from(QuadComplex::prev(h)));
            break;
        }
        h = rotated;
    } while (h != k.halfedge_at(v));
    return out;
}

//! Closed smooth domains of genus 0, 1 and 2 with valences 3 to 10.
inline std::vector<Domain> closed_domains()
{
    std::vector<Domain> out{cube(), refine(cube()), torus_grid(5, 4), genus2()};
    for (Index n : {3u, 5u, 6u, 7u, 8u, 9u, 10u})
        out.push_back(split_bipyramid(n));
    for (Index n : {5u, 6u, 8u, 10u})
        out.push_back(radial_bipyramid(n));
    return out;
}

//! Domains with boundary but without creases.
inline std::vector<Domain> open_domains()
{
    std::vector<Domain> out{disk_grid(1, 1), disk_grid(3, 2), open_cylinder(5, 2)};
    for (Index n : {3u, 5u, 6u})
        out.push_back(star(n));
    out.push_back(star(7, 2));
    for (Index sectors : {2u, 3u, 4u, 5u})
        out.push_back(star_sectors(8, 2, sectors));
    return out;
}

//! Domains with creases, corners and darts.
inline std::vector<Domain> feature_domains()
{
    std::vector<Domain> out;
    const Domain torus = torus_grid(6, 5);
    VertexPairs loop;
    for (Index i = 0; i < 6; ++i)
        loop.push_back({i * 5, (i + 1) % 6 * 5});
    out.push_back(with_features(torus, "torus_crease_loop", loop));
    out.push_back(with_features(torus, "torus_crease_corners", loop, {0, 10}));
    out.push_back(with_features(torus, "torus_darts", {loop[0], loop[1], loop[2]}));
    for (Index n : {5u, 6u, 7u, 8u}) {
        const Domain d = split_bipyramid(n);
        const std::vector<Index> e = neighbours(d.complex, n);
        const std::string name = std::to_string(n);
        out.push_back(with_features(d, "dart_" + name, {{n, e[0]}}));
        out.push_back(with_features(d, "smooth_crease_" + name, {{n, e[0]}, {n, e[2]}}));
        out.push_back(with_features(d, "triple_crease_" + name, {{n, e[0]}, {n, e[1]}, {n, e[3]}}));
    }
    const Domain s = star(5, 2);
    const std::vector<Index> e = neighbours(s.complex, 0);
    out.push_back(with_features(s, "crease_in_star", {{0, e[0]}, {0, e[1]}}));
    for (Index sectors : {2u, 3u, 4u, 5u}) {
        Domain fan = star_sectors(8, 2, sectors);
        out.push_back(with_features(fan, "corner_" + fan.name, {}, {0}));
    }
    return out;
}

} // namespace bot2nurbs::fixtures
