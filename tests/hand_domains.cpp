// SPDX-License-Identifier: MIT
#include "hand_domains.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <numeric>
#include <string>

namespace bot2nurbs::test {

namespace {

//! Fixtures have no caller to hand an error to: a failure here is a bug in the test itself.
template <class T> T expect_value(Result<T> result, const char* what)
{
    if (!result.ok()) {
        std::fprintf(stderr, "hand_domains: %s: %s\n", what, result.error().message.c_str());
        std::abort();
    }
    return std::move(result.value());
}

//! Coarse quads and where their inner points lie.
struct CoarseSurface {
    Index vertex_count = 0;
    std::vector<std::array<Index, 4>> quads;
    std::function<Vec3(Index quad, double u, double v)> at;
};

//! Numbers the grid points of all coarse quads, shared ones once: corners, then sides, then
//! insides.
class GridNumbering {
public:
    GridNumbering(const QuadComplex& coarse, Index cells) : coarse_(coarse), cells_(cells) {}

    Index count() const
    {
        const Index inner = cells_ - 1;
        return coarse_.vertex_count() + coarse_.edge_count() * inner +
               coarse_.quad_count() * inner * inner;
    }
    Index operator()(Index q, Index i, Index j) const
    {
        const Index n = cells_;
        if (j == 0)
            return on_side(4 * q, i);
        if (i == n)
            return on_side(4 * q + 1, j);
        if (j == n)
            return on_side(4 * q + 2, n - i);
        if (i == 0)
            return on_side(4 * q + 3, n - j);
        return coarse_.vertex_count() + coarse_.edge_count() * (n - 1) + q * (n - 1) * (n - 1) +
               (j - 1) * (n - 1) + i - 1;
    }

private:
    Index on_side(Index h, Index step) const
    {
        if (step == 0)
            return coarse_.from(h);
        if (step == cells_)
            return coarse_.to(h);
        const Index e = coarse_.edge(h);
        const Index along = coarse_.halfedge_of_edge(e) == h ? step : cells_ - step;
        return coarse_.vertex_count() + e * (cells_ - 1) + along - 1;
    }

    const QuadComplex& coarse_;
    Index cells_;
};

//! Builds mesh, domain and charts over `surface`: each coarse quad has `cells`^2 mesh squares and
//! (2^level)^2 domain quads.
HandDomain build_grid_domain(const CoarseSurface& surface, int level, int cells,
                             const std::function<void(ManifoldMesh&)>& adjust = {})
{
    const Index n = static_cast<Index>(cells);
    const Index per_side = Index{1} << level;
    const Index m = n / per_side;
    if (n < 2 || m * per_side != n) {
        std::fprintf(stderr, "hand_domains: cells must be a multiple of 2^level, at least 2\n");
        std::abort();
    }
    const QuadComplex coarse =
        expect_value(QuadComplex::build(surface.vertex_count, surface.quads), "coarse complex");
    const GridNumbering number(coarse, n);

    std::vector<Vec3> positions(number.count());
    std::vector<char> placed(number.count(), 0);
    std::vector<std::array<Index, 3>> triangles;
    for (Index q = 0; q < coarse.quad_count(); ++q) {
        for (Index j = 0; j <= n; ++j)
            for (Index i = 0; i <= n; ++i) {
                const Index v = number(q, i, j);
                if (!placed[v])
                    positions[v] = surface.at(q, double(i) / n, double(j) / n);
                placed[v] = 1;
            }
        for (Index j = 0; j < n; ++j)
            for (Index i = 0; i < n; ++i) {
                const Index a = number(q, i, j), b = number(q, i + 1, j);
                const Index c = number(q, i + 1, j + 1), d = number(q, i, j + 1);
                triangles.push_back({a, b, c});
                triangles.push_back({a, c, d});
            }
    }

    HandDomain hand;
    hand.mesh = expect_value(ManifoldMesh::build(positions, triangles), "grid mesh");
    if (adjust)
        adjust(hand.mesh);
    QuadDomain& domain = hand.domain;
    domain.source_signature = signature(hand.mesh);
    domain.carrier = CarrierMesh::from_source(hand.mesh);
    domain.origin = "supplied";

    std::map<Index, Index> domain_vertex; // by mesh vertex
    std::vector<std::array<Index, 4>> quads;
    for (Index q = 0; q < coarse.quad_count(); ++q)
        for (Index J = 0; J < per_side; ++J)
            for (Index I = 0; I < per_side; ++I) {
                std::array<Index, 4> quad{};
                const Index at[4][2] = {{I, J}, {I + 1, J}, {I + 1, J + 1}, {I, J + 1}};
                for (int k = 0; k < 4; ++k) {
                    const Index v = number(q, at[k][0] * m, at[k][1] * m);
                    const auto [it, added] =
                        domain_vertex.emplace(v, static_cast<Index>(domain.vertices.size()));
                    if (added)
                        domain.vertices.push_back(v);
                    quad[k] = it->second;
                }
                quads.push_back(quad);
            }
    domain.complex = expect_value(
        QuadComplex::build(static_cast<Index>(domain.vertices.size()), quads), "domain complex");

    const auto quad_point = [&](Index dq, Index i, Index j) {
        const Index q = dq / (per_side * per_side);
        const Index I = dq % per_side, J = dq / per_side % per_side;
        return number(q, I * m + i, J * m + j);
    };
    for (Index e = 0; e < domain.complex.edge_count(); ++e) {
        const Index h = domain.complex.halfedge_of_edge(e);
        DomainEdge edge;
        edge.a = domain.complex.from(h);
        edge.b = domain.complex.to(h);
        for (Index k = 1; k < m; ++k) {
            const Index side = QuadComplex::side_of(h), q = QuadComplex::quad_of(h);
            const Index v = side == 0   ? quad_point(q, k, 0)
                            : side == 1 ? quad_point(q, m, k)
                            : side == 2 ? quad_point(q, m - k, m)
                                        : quad_point(q, 0, m - k);
            edge.path.push_back({v, v, 0.0});
        }
        domain.edges.push_back(std::move(edge));
    }

    for (Index dq = 0; dq < domain.complex.quad_count(); ++dq) {
        const Index q = dq / (per_side * per_side);
        const Index I = dq % per_side, J = dq / per_side % per_side;
        QuadChart chart;
        for (Index j = 0; j <= m; ++j)
            for (Index i = 0; i <= m; ++i)
                chart.vertices.push_back(
                    {hand.mesh.position(quad_point(dq, i, j)), {double(i) / m, double(j) / m}});
        for (Index j = 0; j < m; ++j)
            for (Index i = 0; i < m; ++i) {
                const Index a = j * (m + 1) + i, b = a + 1, d = a + m + 1, c = d + 1;
                const Index face = 2 * (q * n * n + (J * m + j) * n + I * m + i);
                chart.triangles.push_back({a, b, c});
                chart.triangles.push_back({a, c, d});
                for (Index k = 0; k < 2; ++k) {
                    chart.source_face.push_back(face + k);
                    chart.bary.push_back({{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}});
                }
            }
        hand.charts.push_back(std::move(chart));
    }
    return hand;
}

Vec3 torus_point(double u, double v, double minor)
{
    const double r = 1.0 + minor * std::cos(2 * M_PI * v);
    return {r * std::cos(2 * M_PI * u), r * std::sin(2 * M_PI * u), minor * std::sin(2 * M_PI * v)};
}

//! The boundary quads of a set of voxels, outward, and their vertices on the integer lattice.
struct VoxelSurface {
    std::vector<std::array<int, 3>> vertices;
    std::vector<std::array<Index, 4>> quads;
};

VoxelSurface voxel_surface(const std::vector<std::array<int, 3>>& voxels)
{
    VoxelSurface surface;
    std::map<std::array<int, 3>, Index> number;
    for (const auto& voxel : voxels)
        for (int axis = 0; axis < 3; ++axis)
            for (int up = 0; up < 2; ++up) {
                auto neighbour = voxel;
                neighbour[axis] += up ? 1 : -1;
                if (std::find(voxels.begin(), voxels.end(), neighbour) != voxels.end())
                    continue;
                // Counter-clockwise seen from outside: (b, c) are the axes after `axis`.
                const int b = (axis + 1) % 3, c = (axis + 2) % 3;
                const int turn[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
                std::array<Index, 4> quad{};
                for (int k = 0; k < 4; ++k) {
                    auto p = voxel;
                    const int kk = up ? k : (4 - k) % 4;
                    p[axis] += up;
                    p[b] += turn[kk][0];
                    p[c] += turn[kk][1];
                    const auto [it, added] =
                        number.emplace(p, static_cast<Index>(surface.vertices.size()));
                    if (added)
                        surface.vertices.push_back(p);
                    quad[k] = it->second;
                }
                surface.quads.push_back(quad);
            }
    return surface;
}

//! Rounds of averaging over neighbours; the mesh keeps its topology.
void smooth(ManifoldMesh& mesh, int rounds)
{
    std::vector<Vec3> p = mesh.positions();
    for (int round = 0; round < rounds; ++round) {
        std::vector<Vec3> sum(p.size());
        std::vector<double> count(p.size(), 0.0);
        for (const auto& t : mesh.triangles())
            for (int k = 0; k < 3; ++k) {
                sum[t[k]] += p[t[(k + 1) % 3]] + p[t[(k + 2) % 3]];
                count[t[k]] += 2.0;
            }
        for (std::size_t v = 0; v < p.size(); ++v)
            p[v] = 0.5 * p[v] + 0.5 * (sum[v] / count[v]);
    }
    mesh = expect_value(ManifoldMesh::build(std::move(p), mesh.triangles()), "smoothed mesh");
}

Vec3 bilinear(const std::array<Vec3, 4>& c, double u, double v)
{
    return (1 - v) * ((1 - u) * c[0] + u * c[1]) + v * ((1 - u) * c[3] + u * c[2]);
}

CoarseSurface lattice_surface(const VoxelSurface& voxels)
{
    CoarseSurface surface;
    surface.vertex_count = static_cast<Index>(voxels.vertices.size());
    surface.quads = voxels.quads;
    surface.at = [voxels](Index q, double u, double v) {
        std::array<Vec3, 4> c;
        for (int k = 0; k < 4; ++k) {
            const auto& p = voxels.vertices[voxels.quads[q][k]];
            c[k] = {double(p[0]), double(p[1]), double(p[2])};
        }
        return bilinear(c, u, v);
    };
    return surface;
}

} // namespace

HandDomain sphere_cube(int level, int cells)
{
    CoarseSurface surface = lattice_surface(voxel_surface({{0, 0, 0}}));
    const auto cube = surface.at;
    surface.at = [cube](Index q, double u, double v) {
        // Equal angles: the tangent spreads grid lines evenly over the sphere.
        const Vec3 p = 2.0 * cube(q, u, v) - Vec3{1, 1, 1};
        return normalized(
            {std::tan(M_PI / 4 * p.x), std::tan(M_PI / 4 * p.y), std::tan(M_PI / 4 * p.z)});
    };
    return build_grid_domain(surface, level, cells);
}

HandDomain torus_grid(int around, int across, int cells, double minor)
{
    CoarseSurface surface;
    const Index nu = static_cast<Index>(around), nv = static_cast<Index>(across);
    surface.vertex_count = nu * nv;
    for (Index j = 0; j < nv; ++j)
        for (Index i = 0; i < nu; ++i) {
            const Index i1 = (i + 1) % nu, j1 = (j + 1) % nv;
            surface.quads.push_back({j * nu + i, j * nu + i1, j1 * nu + i1, j1 * nu + i});
        }
    surface.at = [=](Index q, double u, double v) {
        return torus_point((q % nu + u) / nu, (q / nu + v) / nv, minor);
    };
    return build_grid_domain(surface, 0, cells);
}

HandDomain genus2_voxels(int level, int cells)
{
    std::vector<std::array<int, 3>> voxels;
    for (int x = 0; x < 5; ++x)
        for (int y = 0; y < 3; ++y)
            if (!(y == 1 && (x == 1 || x == 3)))
                voxels.push_back({x, y, 0});
    // Enough rounds to round the lattice's edges off at any refinement, few enough to keep volume.
    return build_grid_domain(lattice_surface(voxel_surface(voxels)), level, cells,
                             [cells](ManifoldMesh& mesh) { smooth(mesh, cells * cells / 2); });
}

HandDomain open_cylinder(int around, int along, int cells)
{
    CoarseSurface surface;
    const Index nu = static_cast<Index>(around), nv = static_cast<Index>(along);
    surface.vertex_count = nu * (nv + 1);
    for (Index j = 0; j < nv; ++j)
        for (Index i = 0; i < nu; ++i) {
            const Index i1 = (i + 1) % nu;
            surface.quads.push_back({j * nu + i, j * nu + i1, (j + 1) * nu + i1, (j + 1) * nu + i});
        }
    surface.at = [=](Index q, double u, double v) {
        const double angle = 2 * M_PI * (q % nu + u) / nu;
        return Vec3{std::cos(angle), std::sin(angle), (q / nu + v) * 0.8};
    };
    return build_grid_domain(surface, 0, cells);
}

HandDomain plane_l(int cells)
{
    CoarseSurface surface;
    surface.vertex_count = 6;
    surface.quads = {{1, 2, 3, 0}, {1, 0, 4, 5}};
    const std::vector<Vec3> corner{{1, 1, 0}, {0, 0, 0}, {5, 0, 0},
                                   {5, 1, 0}, {1, 2, 0}, {0, 2, 0}};
    surface.at = [=](Index q, double u, double v) {
        const auto& c = surface.quads[q];
        return (1 - v) * ((1 - u) * corner[c[0]] + u * corner[c[1]]) +
               v * ((1 - u) * corner[c[3]] + u * corner[c[2]]);
    };
    HandDomain hand = build_grid_domain(surface, 0, cells);
    const QuadComplex& k = hand.domain.complex;
    std::vector<Index> corners(k.vertex_count());
    std::iota(corners.begin(), corners.end(), Index{0});
    hand.domain.complex =
        expect_value(QuadComplex::build(k.vertex_count(), k.quads(), {}, corners), "plane L");
    return hand;
}

HandDomain torus_askew(int turns, int step, double minor)
{
    const int n = 5 * step * turns;
    const auto wrap = [n](int i) { return ((i % n) + n) % n; };
    const auto mesh_vertex = [&](int i, int j) {
        return static_cast<Index>(wrap(j) * n + wrap(i));
    };
    std::vector<Vec3> positions;
    std::vector<std::array<Index, 3>> triangles;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            positions.push_back(torus_point(double(i) / n, double(j) / n, minor));
            const Index a = mesh_vertex(i, j), b = mesh_vertex(i + 1, j);
            const Index c = mesh_vertex(i + 1, j + 1), d = mesh_vertex(i, j + 1);
            triangles.push_back({a, b, c});
            triangles.push_back({a, c, d});
        }
    HandDomain hand;
    hand.mesh = expect_value(ManifoldMesh::build(positions, triangles), "torus mesh");
    QuadDomain& domain = hand.domain;
    domain.source_signature = signature(hand.mesh);
    domain.carrier = CarrierMesh::from_source(hand.mesh);
    domain.origin = "supplied";

    // Domain vertices are the lattice of g0 = step (2, 1) and g1 = step (-1, 2), which contains the
    // torus' periods (n, 0) and (0, n).
    const int g[2][2] = {{2 * step, step}, {-step, 2 * step}};
    std::map<Index, Index> number;
    std::vector<std::array<int, 2>> lattice{{0, 0}};
    number[mesh_vertex(0, 0)] = 0;
    for (std::size_t k = 0; k < lattice.size(); ++k)
        for (const auto& d : g) {
            const int x = wrap(lattice[k][0] + d[0]), y = wrap(lattice[k][1] + d[1]);
            if (number.emplace(mesh_vertex(x, y), static_cast<Index>(lattice.size())).second)
                lattice.push_back({x, y});
        }
    const auto at = [&](std::size_t k, int a, int b) {
        return number.at(mesh_vertex(lattice[k][0] + a * g[0][0] + b * g[1][0],
                                     lattice[k][1] + a * g[0][1] + b * g[1][1]));
    };
    std::vector<std::array<Index, 4>> quads;
    for (std::size_t k = 0; k < lattice.size(); ++k) {
        domain.vertices.push_back(mesh_vertex(lattice[k][0], lattice[k][1]));
        quads.push_back({at(k, 0, 0), at(k, 1, 0), at(k, 1, 1), at(k, 0, 1)});
    }
    domain.complex = expect_value(QuadComplex::build(static_cast<Index>(lattice.size()), quads),
                                  "askew complex");

    for (Index e = 0; e < domain.complex.edge_count(); ++e) {
        const Index h = domain.complex.halfedge_of_edge(e), side = QuadComplex::side_of(h);
        DomainEdge edge;
        edge.a = domain.complex.from(h);
        edge.b = domain.complex.to(h);
        const int sign = side < 2 ? 1 : -1;
        const int dx = sign * g[side % 2][0], dy = sign * g[side % 2][1];
        const int x0 = lattice[edge.a][0], y0 = lattice[edge.a][1];
        // All crossings are at multiples of 1 / den along the edge; whole numbers only.
        const int den = std::abs(dx) * std::abs(dy) * std::abs(dx - dy);
        const auto floor_div = [](int a, int b) { return a >= 0 ? a / b : -((b - 1 - a) / b); };
        for (int p = 1; p < den; ++p) {
            const int x = x0 * den + p * dx, y = y0 * den + p * dy;
            const int fx = floor_div(x, den), fy = floor_div(y, den);
            const bool on_x = x == fx * den, on_y = y == fy * den;
            const double tx = double(x - fx * den) / den, ty = double(y - fy * den) / den;
            const Index v = mesh_vertex(fx, fy);
            if (on_x && on_y)
                edge.path.push_back({v, v, 0.0});
            else if (on_x)
                edge.path.push_back({v, mesh_vertex(fx, fy + 1), ty});
            else if (on_y)
                edge.path.push_back({v, mesh_vertex(fx + 1, fy), tx});
            else if (x - fx * den == y - fy * den)
                edge.path.push_back({v, mesh_vertex(fx + 1, fy + 1), tx});
        }
        domain.edges.push_back(std::move(edge));
    }
    return hand;
}

HandDomain with_refined_carrier(const HandDomain& hand)
{
    HandDomain refined = hand;
    refined.charts.clear();
    const ManifoldMesh& source = hand.mesh;
    CarrierMesh& carrier = refined.domain.carrier;
    carrier = CarrierMesh::from_source(source);
    carrier.refined = true;
    std::vector<Vec3> positions = source.positions();
    std::vector<std::array<Index, 3>> triangles;
    carrier.face_source.clear();
    // The point inside sits near corner 0: away from any path that crosses only edges, but paths
    // that cross the face would meet the new edges, so such faces stay whole.
    std::vector<char> crossed(source.face_count(), 0);
    const auto mark = [&](Index a, Index b) {
        for (const Index h : {source.find_halfedge(a, b), source.find_halfedge(b, a)})
            if (h != invalid_index)
                crossed[ManifoldMesh::face(h)] = 1;
    };
    for (const DomainEdge& edge : hand.domain.edges)
        for (const PathPoint& p : edge.path)
            if (!p.is_vertex())
                mark(p.from, p.to);
    for (Index f = 0; f < source.face_count(); ++f) {
        const auto& t = source.triangle(f);
        if (crossed[f]) {
            triangles.push_back(t);
            carrier.face_source.push_back(f);
            continue;
        }
        const Index inside = static_cast<Index>(positions.size());
        const SourcePoint point{f, {0.5, 0.25, 0.25}};
        positions.push_back(source.at(point));
        carrier.vertex_source.push_back(point);
        for (int k = 0; k < 3; ++k) {
            triangles.push_back({t[k], t[(k + 1) % 3], inside});
            carrier.face_source.push_back(f);
        }
    }
    carrier.mesh = expect_value(ManifoldMesh::build(positions, triangles), "refined carrier");
    return refined;
}

} // namespace bot2nurbs::test
