// SPDX-License-Identifier: MIT
#include "maps/convex_map.h"

#include "core/predicates.h"

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseLU>
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
// Bounds of what mean value weights are made of: the tangent of half an angle, infinite where a
// vertex lies on the line between two neighbours, and lengths over the longest.
constexpr double least_part = 1e-9;
constexpr double most_tangent = 1e3;
// Up to this many inner vertices a dense solve is faster than a sparse one.
constexpr Index dense_limit = 48;

// An edge with at least one inner end. Each end is a combination of its neighbours with the weights
// at it.
struct Edge {
    Index a, b; // a < b, so b is inner.
    double at_a, at_b;
};

// Positive weights of an overlay's edges.
struct Weights {
    std::vector<Edge> edges;
    bool symmetric = true; // As made: at_a == at_b for every edge.
};

double cotangent(const Vec3& at, const Vec3& p, const Vec3& q)
{
    const Vec3 u = p - at, v = q - at;
    const double area = norm(cross(u, v));
    const double cosine = dot(u, v);
    // A degenerate triangle has no angle to speak of: the bounds decide.
    return area > 0.0 ? cosine / area : (cosine > 0.0 ? max_weight : -max_weight);
}

// Tangent of half the angle between two edges of one corner.
double half_tangent(const Vec3& u, const Vec3& v)
{
    const double sine = norm(cross(u, v)), base = norm(u) * norm(v) + dot(u, v);
    return sine < most_tangent * base ? sine / base : most_tangent;
}

// Calls act(h, g, from, to) for every edge with at least one inner end, once: half edges h and g,
// and the ends of h.
template <class Act> void for_each_edge(const Overlay& overlay, const Act& act)
{
    for (Index h = 0; h < overlay.opposite.size(); ++h) {
        const Index g = overlay.opposite[h];
        if (g == invalid_index || g < h)
            continue;
        const auto& t = overlay.triangles[h / 3];
        const Index from = t[h % 3], to = t[(h + 1) % 3];
        if (from >= overlay.boundary_count || to >= overlay.boundary_count)
            act(h, g, from, to);
    }
}

// Corner k of the triangle of half edge h, counted from where h begins.
const Vec3& corner_of(const Overlay& overlay, Index h, Index k)
{
    return overlay.vertices[overlay.triangles[h / 3][(h + k) % 3]].position;
}

Weights symmetric_weights(const Overlay& overlay, bool harmonic)
{
    const auto half_cotangent = [&overlay](Index h) {
        return 0.5 * cotangent(corner_of(overlay, h, 2), corner_of(overlay, h, 0),
                               corner_of(overlay, h, 1));
    };
    Weights weights;
    weights.edges.reserve(2 * overlay.triangles.size());
    for_each_edge(overlay, [&](Index h, Index g, Index from, Index to) {
        const double w =
            harmonic ? std::clamp(half_cotangent(h) + half_cotangent(g), min_weight, max_weight)
                     : 1.0;
        weights.edges.push_back({std::min(from, to), std::max(from, to), w, w});
    });
    return weights;
}

// \cite floater_2003
Weights mean_value_weights(const Overlay& overlay)
{
    const auto length = [&overlay](Index h) {
        return norm(corner_of(overlay, h, 1) - corner_of(overlay, h, 0));
    };
    double longest = 0.0;
    for_each_edge(overlay,
                  [&](Index h, Index, Index, Index) { longest = std::max(longest, length(h)); });
    // Of the angle at corner k of half edge h's triangle.
    const auto tangent = [&overlay](Index h, Index k) {
        const Vec3& at = corner_of(overlay, h, k);
        return half_tangent(corner_of(overlay, h, k + 1) - at, corner_of(overlay, h, k + 2) - at);
    };
    Weights weights{{}, false};
    weights.edges.reserve(2 * overlay.triangles.size());
    for_each_edge(overlay, [&](Index h, Index g, Index from, Index to) {
        const double shrink = 1.0 / std::max(length(h), least_part * longest);
        const double at_from = shrink * std::max(tangent(h, 0) + tangent(g, 1), least_part);
        const double at_to = shrink * std::max(tangent(h, 1) + tangent(g, 0), least_part);
        weights.edges.push_back(from < to ? Edge{from, to, at_from, at_to}
                                          : Edge{to, from, at_to, at_from});
    });
    return weights;
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
bool solve_inner(const Overlay& overlay, const Weights& weights, std::vector<Vec2>& uv)
{
    const Index border = overlay.boundary_count;
    const Index inner = static_cast<Index>(overlay.vertices.size()) - border;
    using Rhs = Eigen::Matrix<Scalar, Eigen::Dynamic, 2>;
    using Dense = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
    using Sparse = Eigen::SparseMatrix<Scalar>;
    Rhs rhs = Rhs::Zero(inner, 2);
    Eigen::Matrix<Scalar, Eigen::Dynamic, 1> diagonal =
        Eigen::Matrix<Scalar, Eigen::Dynamic, 1>::Zero(inner);
    for (const Edge& e : weights.edges) {
        diagonal(e.b - border) += Scalar(e.at_b);
        if (e.a >= border) {
            diagonal(e.a - border) += Scalar(e.at_a);
        } else {
            rhs(e.b - border, 0) += Scalar(e.at_b) * Scalar(uv[e.a].x);
            rhs(e.b - border, 1) += Scalar(e.at_b) * Scalar(uv[e.a].y);
        }
    }
    // Calls add(row, column, value) for what is below the diagonal, and above where that differs.
    const auto for_each_entry = [&](const auto& add) {
        for (const Edge& e : weights.edges) {
            if (e.a < border)
                continue;
            add(e.b - border, e.a - border, -Scalar(e.at_b));
            if (!weights.symmetric)
                add(e.a - border, e.b - border, -Scalar(e.at_a));
        }
    };
    Rhs solution;
    const auto solve = [&](auto&& factor) {
        if (factor.info() != Eigen::Success)
            return false;
        solution = factor.solve(rhs);
        return true;
    };
    if (inner <= dense_limit) {
        Dense A = diagonal.asDiagonal();
        for_each_entry([&A](Index i, Index j, const Scalar& x) { A(i, j) = x; });
        if (weights.symmetric) {
            if (!solve(Eigen::LLT<Dense, Eigen::Lower>(A)))
                return false;
        } else {
            solution = Eigen::PartialPivLU<Dense>(A).solve(rhs);
        }
    } else {
        std::vector<Eigen::Triplet<Scalar>> entries;
        entries.reserve(2 * weights.edges.size() + inner);
        for (Index i = 0; i < inner; ++i)
            entries.emplace_back(i, i, diagonal(i));
        for_each_entry([&](Index i, Index j, const Scalar& x) { entries.emplace_back(i, j, x); });
        Sparse A(inner, inner);
        A.setFromTriplets(entries.begin(), entries.end());
        if (!(weights.symmetric ? solve(Eigen::SimplicialLLT<Sparse, Eigen::Lower>(A))
                                : solve(Eigen::SparseLU<Sparse, Eigen::COLAMDOrdering<int>>(A))))
            return false;
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

// Makes springs weaker where much surface is squeezed into little of the plane. Positive they stay,
// and symmetric if they were. \cite yoshizawa_2004 divide by the stretch of the other end; that of
// a vertex itself changes nothing in its row. With squares that is a power of 1/2.
void weaken(const Stretch& stretch, double power, Weights& weights)
{
    constexpr double least = 1e-8, most = 1e48;
    for (Edge& e : weights.edges) {
        const double by = std::pow(std::clamp(stretch.at[e.a], least, most) *
                                       std::clamp(stretch.at[e.b], least, most),
                                   power);
        e.at_a /= by;
        e.at_b /= by;
    }
}

// Below, solving again moves charts about and gains nothing: most charts have 1.1 to 2.
constexpr double low_stretch = 4.0;

// A map in doubles.
struct Trial {
    std::vector<Vec2> uv;
    Weights weights; // That it was made with.
    Stretch stretch;
    bool injective = false;

    bool better_than(const Trial& other) const
    {
        return injective == other.injective ? stretch.mean < other.stretch.mean : injective;
    }
    bool good() const { return injective && stretch.mean < low_stretch; }
};

// A system that cannot be solved is a trial as bad as can be.
Trial try_weights(const Overlay& overlay, const std::vector<Vec2>& border, Weights weights)
{
    Trial trial{border, std::move(weights), {{}, INFINITY}, false};
    if (solve_inner<double>(overlay, trial.weights, trial.uv)) {
        trial.stretch = measure_stretch(overlay, trial.uv);
        trial.injective = is_injective(overlay, trial.uv);
    }
    return trial;
}

// Maps with weaker and weaker weights where that lowers the stretch, until it is low or so many
// solves are done.
Trial lower_stretch(const Overlay& overlay, const std::vector<Vec2>& border, Trial best)
{
    constexpr double most_power = 0.25, least_power = 0.03;
    constexpr int most_solves = 16;
    double power = most_power;
    for (int solves = 1; solves < most_solves; ++solves) {
        if (best.good() || best.stretch.at.empty() || power < least_power)
            break;
        Weights weights = best.weights;
        weaken(best.stretch, power, weights);
        Trial next = try_weights(overlay, border, std::move(weights));
        if (next.better_than(best)) {
            power = std::min(most_power, 1.5 * power);
            best = std::move(next);
        } else {
            power *= 0.5;
        }
    }
    return best;
}

// With cotangents or, where these squeeze, with mean values if they do less: cotangents of needles
// are beyond their bounds, and say little about them.
Trial map_by_shape(const Overlay& overlay, const std::vector<Vec2>& border)
{
    Trial first = try_weights(overlay, border, symmetric_weights(overlay, true));
    if (first.good())
        return first;
    Trial second = try_weights(overlay, border, mean_value_weights(overlay));
    if (second.better_than(first))
        std::swap(first, second);
    first = lower_stretch(overlay, border, std::move(first));
    if (first.good())
        return first;
    second = lower_stretch(overlay, border, std::move(second));
    return second.better_than(first) ? second : first;
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
        Trial trial{border, {}, {}, false};
        if (level == MapLevel::harmonic)
            trial = map_by_shape(overlay, border);
        else if (level == MapLevel::uniform)
            trial = lower_stretch(overlay, border,
                                  try_weights(overlay, border, symmetric_weights(overlay, false)));
        else
            trial.injective =
                solve_inner<Extended>(overlay, symmetric_weights(overlay, false), trial.uv) &&
                is_injective(overlay, trial.uv);
        if (trial.injective)
            return ConvexMap{std::move(trial.uv), level};
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
