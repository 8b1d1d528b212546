// SPDX-License-Identifier: MIT
#include "maps/convex_map.h"

#include "core/predicates.h"

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <boost/multiprecision/cpp_bin_float.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace bot2nurbs {

namespace {

// Bounds of a cotangent weight. The lower one keeps weights positive where opposite angles add up
// to more than a half turn. Needles and slivers have large weights next to negative ones that
// cancel them; where the lower bound takes the negative ones away, the large ones would pull a
// vertex onto its neighbour or the border, so there is an upper bound not far from the lower one.
constexpr double min_weight = 0.2;
constexpr double max_weight = 5.0;
// Up to this many inner vertices a dense solve is faster than a sparse one.
constexpr Index dense_limit = 48;

// Weights of one overlay as a list of directed entries between inner vertices and anything.
struct Edge {
    Index a, b;
    double weight;
};

double cotangent(const Vec3& at, const Vec3& p, const Vec3& q)
{
    const Vec3 u = p - at, v = q - at;
    const double area = norm(cross(u, v));
    const double cosine = dot(u, v);
    // A degenerate triangle has no angle to speak of: the bounds decide.
    return area > 0.0 ? cosine / area : (cosine > 0.0 ? max_weight : -max_weight);
}

// The undirected edges with at least one inner end, each once, with symmetric weights.
std::vector<Edge> weighted_edges(const Overlay& overlay, bool harmonic)
{
    const std::vector<Index>& opposite = overlay.opposite;
    std::vector<Edge> edges;
    edges.reserve(2 * overlay.triangles.size());
    const auto half_cotangent = [&overlay](Index h) {
        const auto& t = overlay.triangles[h / 3];
        return 0.5 * cotangent(overlay.vertices[t[(h + 2) % 3]].position,
                               overlay.vertices[t[h % 3]].position,
                               overlay.vertices[t[(h + 1) % 3]].position);
    };
    for (Index h = 0; h < opposite.size(); ++h) {
        const Index g = opposite[h];
        if (g == invalid_index || g < h)
            continue;
        const Index a = overlay.triangles[h / 3][h % 3], b = overlay.triangles[h / 3][(h + 1) % 3];
        if (a < overlay.boundary_count && b < overlay.boundary_count)
            continue;
        const double weight =
            harmonic ? std::clamp(half_cotangent(h) + half_cotangent(g), min_weight, max_weight)
                     : 1.0;
        edges.push_back({std::min(a, b), std::max(a, b), weight});
    }
    return edges;
}

// Border points that lie on one place, as where a face has no area, still get this share of their
// side between them: a triangle on three points of a line needs them apart.
constexpr double least_step = 1e-6;

// Puts the border vertices on the polygon, by arc length along each side.
std::vector<Vec2> place_border(const Overlay& overlay, const std::vector<Vec2>& corners)
{
    std::vector<Vec2> uv(overlay.vertices.size());
    const Index sides = overlay.side_count(), n = overlay.boundary_count;
    for (Index s = 0; s < sides; ++s) {
        const Index first = overlay.corners[s];
        const Index last = s + 1 < sides ? overlay.corners[s + 1] : n;
        std::vector<double> step;
        for (Index i = first; i < last; ++i)
            step.push_back(
                norm(overlay.vertices[(i + 1) % n].position - overlay.vertices[i].position));
        const double least = least_step * std::accumulate(step.begin(), step.end(), 0.0);
        std::vector<double> arc{0.0};
        for (const double length : step)
            arc.push_back(arc.back() + std::max(length, least));
        const Vec2 a = corners[s], b = corners[(s + 1) % sides];
        const double count = static_cast<double>(last - first);
        for (Index i = first; i < last; ++i) {
            const double even = static_cast<double>(i - first) / count;
            const double t = arc.back() > 0.0 ? arc[i - first] / arc.back() : even;
            uv[i] = (1.0 - t) * a + t * b;
        }
    }
    return uv;
}

// Solves for the inner vertices in the arithmetic of Scalar.
template <class Scalar>
bool solve_inner(const Overlay& overlay, const std::vector<Edge>& edges, std::vector<Vec2>& uv)
{
    const Index border = overlay.boundary_count;
    const Index inner = static_cast<Index>(overlay.vertices.size()) - border;
    using Rhs = Eigen::Matrix<Scalar, Eigen::Dynamic, 2>;
    Rhs rhs = Rhs::Zero(inner, 2);
    Eigen::Matrix<Scalar, Eigen::Dynamic, 1> diagonal =
        Eigen::Matrix<Scalar, Eigen::Dynamic, 1>::Zero(inner);
    for (const Edge& e : edges) {
        diagonal(e.b - border) += Scalar(e.weight); // e.a < e.b, so e.b is inner.
        if (e.a >= border) {
            diagonal(e.a - border) += Scalar(e.weight);
        } else {
            rhs(e.b - border, 0) += Scalar(e.weight) * Scalar(uv[e.a].x);
            rhs(e.b - border, 1) += Scalar(e.weight) * Scalar(uv[e.a].y);
        }
    }
    Rhs solution;
    if (inner <= dense_limit) {
        using Dense = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
        Dense A = Dense::Zero(inner, inner);
        for (Index i = 0; i < inner; ++i)
            A(i, i) = diagonal(i);
        for (const Edge& e : edges)
            if (e.a >= border)
                A(e.b - border, e.a - border) = -Scalar(e.weight);
        Eigen::LLT<Dense, Eigen::Lower> factor(A);
        if (factor.info() != Eigen::Success)
            return false;
        solution = factor.solve(rhs);
    } else {
        std::vector<Eigen::Triplet<Scalar>> entries;
        entries.reserve(edges.size() + inner);
        for (Index i = 0; i < inner; ++i)
            entries.emplace_back(i, i, diagonal(i));
        for (const Edge& e : edges)
            if (e.a >= border)
                entries.emplace_back(e.b - border, e.a - border, -Scalar(e.weight));
        Eigen::SparseMatrix<Scalar> A(inner, inner);
        A.setFromTriplets(entries.begin(), entries.end());
        Eigen::SimplicialLLT<Eigen::SparseMatrix<Scalar>, Eigen::Lower> factor(A);
        if (factor.info() != Eigen::Success)
            return false;
        solution = factor.solve(rhs);
    }
    for (Index i = 0; i < inner; ++i)
        uv[border + i] = {static_cast<double>(solution(i, 0)), static_cast<double>(solution(i, 1))};
    return true;
}

// |Su|^2 + |Sv|^2 for the triangle with edges p, q over the one with edges a, b and twice the area
// `target`.
double squared_speed(const Vec3& p, const Vec3& q, const Vec2& a, const Vec2& b, double target)
{
    return norm_squared((b.y * p - a.y * q) / target) + norm_squared((a.x * q - b.x * p) / target);
}

// Squared L2 stretch of the inverse of a map, 1 for a similarity: around every vertex, and on
// average over the area.
struct Stretch {
    std::vector<double> at;
    double mean = 0.0;
};

// Triangles that rounding has collapsed or folded count as squeezed by so much.
constexpr double most_squeezed = 1e-60;

Stretch measure_stretch(const Overlay& overlay, const std::vector<Vec2>& uv)
{
    double source_area = 0.0, target_area = 0.0;
    std::vector<double> twice_area(overlay.triangles.size());
    for (std::size_t i = 0; i < overlay.triangles.size(); ++i) {
        const auto& t = overlay.triangles[i];
        const Vec3& apex = overlay.vertices[t[0]].position;
        twice_area[i] = norm(
            cross(overlay.vertices[t[1]].position - apex, overlay.vertices[t[2]].position - apex));
        source_area += twice_area[i];
        target_area += cross(uv[t[1]] - uv[t[0]], uv[t[2]] - uv[t[0]]);
    }
    Stretch stretch;
    stretch.at.assign(uv.size(), 0.0);
    if (!(source_area > 0.0))
        return stretch;
    const double scale = target_area / source_area;
    std::vector<double> area(uv.size(), 0.0);
    for (std::size_t i = 0; i < overlay.triangles.size(); ++i) {
        if (!(twice_area[i] > 0.0))
            continue;
        const auto& t = overlay.triangles[i];
        const Vec3 p = overlay.vertices[t[1]].position - overlay.vertices[t[0]].position;
        const Vec3 q = overlay.vertices[t[2]].position - overlay.vertices[t[0]].position;
        const Vec2 a = uv[t[1]] - uv[t[0]], b = uv[t[2]] - uv[t[0]];
        const double target = std::max(cross(a, b), most_squeezed * scale * twice_area[i]);
        const double weighted = twice_area[i] * 0.5 * scale * squared_speed(p, q, a, b, target);
        stretch.mean += weighted / source_area;
        for (const Index v : t) {
            stretch.at[v] += weighted;
            area[v] += twice_area[i];
        }
    }
    for (std::size_t v = 0; v < area.size(); ++v)
        stretch.at[v] = area[v] > 0.0 ? stretch.at[v] / area[v] : 1.0;
    return stretch;
}

// Makes springs weaker where much surface is squeezed into little of the plane. Positive and
// symmetric they stay. \cite yoshizawa_2004 divide by the stretch of one end; with both ends that
// is a power of 1/4 of its squares.
void weaken(const Stretch& stretch, double power, std::vector<Edge>& edges)
{
    constexpr double least = 1e-8, most = 1e48;
    for (Edge& e : edges)
        e.weight /= std::pow(std::clamp(stretch.at[e.a], least, most) *
                                 std::clamp(stretch.at[e.b], least, most),
                             power);
}

// Maps with these weights, then with weaker and weaker ones where that lowers the stretch, until it
// is low or so many solves are done. \return whether the map is injective.
bool map_with_little_stretch(const Overlay& overlay, const std::vector<Vec2>& border,
                             std::vector<Edge> edges, std::vector<Vec2>& uv)
{
    // Below, solving again moves charts about and gains nothing: most charts have 1.1 to 2.
    constexpr double low_stretch = 4.0;
    constexpr double most_power = 0.25, least_power = 0.03;
    constexpr int most_solves = 16;
    std::vector<Vec2> next = border;
    if (!solve_inner<double>(overlay, edges, next))
        return false;
    bool injective = false;
    double power = most_power, least = INFINITY;
    Stretch stretch;
    std::vector<Edge> weights;
    for (int solves = 1;; ++solves) {
        Stretch now = measure_stretch(overlay, next);
        const bool valid = is_injective(overlay, next);
        if ((valid && !injective) || (valid == injective && now.mean < least)) {
            if (solves > 1)
                power = std::min(most_power, 1.5 * power);
            uv = next;
            injective = valid;
            least = now.mean;
            stretch = std::move(now);
            weights = edges;
        } else {
            power *= 0.5;
        }
        if ((injective && least < low_stretch) || solves == most_solves || power < least_power)
            return injective;
        edges = weights;
        weaken(stretch, power, edges);
        next = border;
        if (!solve_inner<double>(overlay, edges, next))
            return injective;
    }
}

} // namespace

std::vector<Vec2> regular_polygon(Index sides)
{
    constexpr double turn = 6.283185307179586;
    std::vector<Vec2> corners(sides);
    for (Index i = 0; i < sides; ++i) {
        const double angle = turn * static_cast<double>(i) / static_cast<double>(sides);
        corners[i] = {std::cos(angle), std::sin(angle)};
    }
    return corners;
}

std::vector<Vec2> unit_square()
{
    return {{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}};
}

bool is_injective(const Overlay& overlay, const std::vector<Vec2>& uv)
{
    for (const auto& t : overlay.triangles)
        if (orient2d(uv[t[0]], uv[t[1]], uv[t[2]]) <= 0)
            return false;
    return true;
}

std::optional<ConvexMap> map_to_polygon(const Overlay& overlay, const std::vector<Vec2>& corners,
                                        MapLevel first)
{
    // What rounding of the solve, not of the result, destroyed comes back with more digits.
    using Extended = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<100>,
                                                   boost::multiprecision::et_off>;
    const std::vector<Vec2> border = place_border(overlay, corners);
    for (const MapLevel level : {MapLevel::harmonic, MapLevel::uniform, MapLevel::exact}) {
        if (level < first)
            continue;
        ConvexMap map{border, level};
        const std::vector<Edge> edges = weighted_edges(overlay, level == MapLevel::harmonic);
        if (level == MapLevel::exact
                ? solve_inner<Extended>(overlay, edges, map.uv) && is_injective(overlay, map.uv)
                : map_with_little_stretch(overlay, border, edges, map.uv))
            return map;
    }
    return std::nullopt;
}

// Heights of source triangles below this share of the longest side count as so much in harmonic
// energy: a triangle on three points of a line has any energy, and none of its map's making.
constexpr double least_height = 0.05;

MapDistortion measure_distortion(const Overlay& overlay, const std::vector<Vec2>& uv)
{
    double energy = 0.0, area = 0.0, stretch_squared = 0.0, source_area = 0.0;
    for (const auto& t : overlay.triangles) {
        const Vec3 p = overlay.vertices[t[1]].position - overlay.vertices[t[0]].position;
        const Vec3 q = overlay.vertices[t[2]].position - overlay.vertices[t[0]].position;
        const Vec2 a = uv[t[1]] - uv[t[0]], b = uv[t[2]] - uv[t[0]];
        const double twice_source = norm(cross(p, q)), twice_target = cross(a, b);
        area += 0.5 * twice_target;
        source_area += 0.5 * twice_source;
        if (twice_source <= 0.0 || twice_target <= 0.0)
            continue;
        // |grad u|^2 + |grad v|^2 = sum over the metric of the source triangle.
        const double pp = dot(p, p), pq = dot(p, q), qq = dot(q, q);
        const double aa = dot(a, a), ab = dot(a, b), bb = dot(b, b);
        const double least = least_height * std::max({pp, qq, norm_squared(q - p)});
        energy += 0.25 * (aa * qq - 2.0 * ab * pq + bb * pp) / std::max(twice_source, least);
        stretch_squared += 0.25 * twice_source * squared_speed(p, q, a, b, twice_target);
    }
    MapDistortion d;
    if (area > 0.0)
        d.dirichlet = energy / area;
    if (stretch_squared > 0.0 && source_area > 0.0) {
        d.stretch = stretch_squared / source_area * area / source_area;
    }
    return d;
}

} // namespace bot2nurbs
