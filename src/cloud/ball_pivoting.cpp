// SPDX-License-Identifier: MIT
#include "cloud/ball_pivoting.h"

#include "cloud/halfedge_key.h"
#include "cloud/point_tree.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>
#include <unordered_set>

namespace bot2nurbs {

namespace {

constexpr double pi = 3.14159265358979323846;
//! Radii in spacings: from the smallest that meets most neighbours of evenly scattered points, to
//! one that falls through none of the gaps they leave by chance; of the densest and sparsest
//! places.
constexpr double first_spacings = 1.2, last_spacings = 2.5;
constexpr double dense_share = 0.05, sparse_share = 0.95;
constexpr double growth = 1.6;
//! Balls of more spacings do not roll at a point: they would bridge what the points there show to
//! be open, and in places much denser than others touch too many points to try.
constexpr double widest_spacings = 6.0;
constexpr int most_radii = 10;
//! Neighbours of a point that are tried for a first triangle.
constexpr std::size_t seed_neighbors = 12;
//! Relative depth inside a ball, and angle in radians, that count as rounding: grids have many
//! points on one ball.
constexpr double rounding = 1e-7;
constexpr std::size_t triangles_per_poll = 4096, points_per_poll = 256;

//! The centre of the ball of a radius that touches a, b and c, on the side that a, b, c are seen
//! from in counterclockwise order; none when it is too small to touch all.
std::optional<Vec3> ball_center(const Vec3& a, const Vec3& b, const Vec3& c, double radius)
{
    const Vec3 ab = b - a, ac = c - a, normal = cross(ab, ac);
    const double area2 = norm_squared(normal);
    if (!(area2 > 0.0))
        return std::nullopt;
    const Vec3 to_center = (1.0 / (2.0 * area2)) * (norm_squared(ac) * cross(normal, ab) +
                                                    norm_squared(ab) * cross(ac, normal));
    const double height2 = radius * radius - norm_squared(to_center);
    if (!(height2 >= 0.0))
        return std::nullopt;
    return a + to_center + std::sqrt(height2 / area2) * normal;
}

class BallPivoting {
public:
    BallPivoting(const std::vector<Vec3>& points, const std::vector<Vec3>& normals,
                 const std::vector<double>& spacings, const PointTree& tree)
        : points_(points), normals_(normals), spacings_(spacings), tree_(tree),
          used_(points.size(), 0), open_edges_(points.size(), 0)
    {
    }

    //! \return false when cancelled
    bool roll(double radius, const Context& context)
    {
        radius_ = radius;
        reopen();
        if (!advance(context))
            return false;
        for (Index i = 0; i < points_.size(); ++i) {
            if (i % points_per_poll == 0 && context.cancelled())
                return false;
            if (used_[i] == 0 && fits(i) && seed(i) && !advance(context))
                return false;
        }
        return true;
    }

    std::vector<std::array<Index, 3>> triangles;

private:
    //! A side of a triangle without another triangle beside it: from a to b, the third corner, and
    //! where the ball lay.
    struct Edge {
        Index a, b, third;
        Vec3 center;
    };

    bool taken(Index from, Index to) const { return halfedges_.count(halfedge_key(from, to)) != 0; }
    //! Whether the ball is not much larger than the gaps beside a point.
    bool fits(Index i) const { return radius_ <= widest_spacings * spacings_[i]; }

    //! Whether a triangle faces where the normals of its corners do.
    bool agrees(Index a, Index b, Index c) const
    {
        const Vec3 n = cross(points_[b] - points_[a], points_[c] - points_[a]);
        return dot(n, normals_[a]) > 0.0 && dot(n, normals_[b]) > 0.0 && dot(n, normals_[c]) > 0.0;
    }

    bool empty(const Vec3& center, Index a, Index b, Index c)
    {
        tree_.within(center, (1.0 - rounding) * radius_, found_);
        return std::all_of(found_.begin(), found_.end(), [&](const PointTree::Neighbor& n) {
            return n.point == a || n.point == b || n.point == c;
        });
    }

    //! Adds a triangle whose three halfedges are free.
    void add(Index a, Index b, Index c, const Vec3& center)
    {
        const std::array<Index, 3> t{a, b, c};
        for (std::size_t k = 0; k < 3; ++k) {
            const Index from = t[k], to = t[(k + 1) % 3];
            used_[from] = 1;
            halfedges_.insert(halfedge_key(from, to));
            if (taken(to, from)) {
                --open_edges_[from];
                --open_edges_[to];
            } else {
                ++open_edges_[from];
                ++open_edges_[to];
                front_.push_back({from, to, t[(k + 2) % 3], center});
            }
        }
        triangles.push_back(t);
    }

    //! A first triangle at an unused point.
    bool seed(Index i)
    {
        std::vector<PointTree::Neighbor> near;
        tree_.nearest(points_[i], seed_neighbors, near);
        for (std::size_t s = 0; s < near.size(); ++s)
            for (std::size_t t = s + 1; t < near.size(); ++t) {
                Index j = near[s].point, k = near[t].point;
                if (j == i || k == i || used_[j] != 0 || used_[k] != 0)
                    continue;
                if (!agrees(i, j, k))
                    std::swap(j, k);
                if (!agrees(i, j, k))
                    continue;
                const auto center = ball_center(points_[i], points_[j], points_[k], radius_);
                if (!center || !empty(*center, i, j, k))
                    continue;
                add(i, j, k, *center);
                return true;
            }
        return false;
    }

    //! Balls of the new radius at the edges where those of the last one found nothing.
    void reopen()
    {
        front_.clear();
        for (const auto& t : triangles)
            for (std::size_t k = 0; k < 3; ++k) {
                const Index a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3];
                if (taken(b, a) || !(fits(a) || fits(b)))
                    continue;
                const auto center = ball_center(points_[a], points_[b], points_[c], radius_);
                if (center && empty(*center, a, b, c))
                    front_.push_back({a, b, c, *center});
            }
    }

    bool advance(const Context& context)
    {
        for (std::size_t count = 0; !front_.empty(); ++count) {
            if (count % triangles_per_poll == 0 && context.cancelled())
                return false;
            const Edge edge = front_.front();
            front_.pop_front();
            if (!taken(edge.b, edge.a) && (fits(edge.a) || fits(edge.b)))
                pivot(edge);
        }
        return true;
    }

    //! Turns the ball around an edge, away from its triangle, until it meets a point, and makes a
    //! triangle with that if the surface allows it.
    void pivot(const Edge& edge)
    {
        const Vec3 &a = points_[edge.a], &b = points_[edge.b];
        const Vec3 middle = 0.5 * (a + b), axis = normalized(b - a), arm = edge.center - middle;
        tree_.within(middle, 2.0 * radius_, found_);
        Index next = invalid_index;
        double least = 2.0 * pi;
        Vec3 center;
        for (const PointTree::Neighbor& n : found_) {
            if (n.point == edge.a || n.point == edge.b || n.point == edge.third)
                continue;
            const auto met = ball_center(b, a, points_[n.point], radius_);
            if (!met)
                continue;
            const Vec3 other = *met - middle;
            double angle = std::atan2(dot(axis, cross(arm, other)), dot(arm, other));
            if (angle < 0.0)
                angle = angle > -rounding ? 0.0 : angle + 2.0 * pi;
            if (angle < least || (angle == least && n.point < next)) {
                least = angle;
                next = n.point;
                center = *met;
            }
        }
        if (next == invalid_index || (used_[next] != 0 && open_edges_[next] == 0) ||
            taken(edge.a, next) || taken(next, edge.b) || !agrees(edge.b, edge.a, next))
            return;
        add(edge.b, edge.a, next, center);
    }

    const std::vector<Vec3>& points_;
    const std::vector<Vec3>& normals_;
    const std::vector<double>& spacings_;
    const PointTree& tree_;
    double radius_ = 0.0;
    std::unordered_set<std::uint64_t> halfedges_; //!< Of the triangles.
    std::deque<Edge> front_;
    std::vector<char> used_;
    std::vector<int> open_edges_; //!< Per point: edges with one triangle.
    std::vector<PointTree::Neighbor> found_;
};

//! \pre there are spacings
std::vector<double> ball_radii(std::vector<double> spacings)
{
    std::sort(spacings.begin(), spacings.end());
    const auto at = [&](double share) {
        return spacings[std::min(spacings.size() - 1,
                                 static_cast<std::size_t>(share * double(spacings.size())))];
    };
    std::vector<double> radii{first_spacings * at(dense_share)};
    const double last = last_spacings * at(sparse_share);
    while (radii.back() < last && static_cast<int>(radii.size()) < most_radii)
        radii.push_back(growth * radii.back());
    return radii;
}

} // namespace

Result<std::vector<std::array<Index, 3>>>
pivot_balls(const std::vector<Vec3>& points, const SurfaceEstimate& estimate, Context& context)
{
    std::vector<Vec3> kept, normals;
    std::vector<double> spacings;
    std::vector<Index> number;
    for (Index i = 0; i < points.size(); ++i)
        if (estimate.outlier[i] == 0) {
            kept.push_back(points[i]);
            normals.push_back(estimate.normals[i]);
            spacings.push_back(estimate.spacing[i]);
            number.push_back(i);
        }
    const Result<PointTree> tree = PointTree::build(kept, context);
    if (!tree)
        return tree.error();
    BallPivoting balls(kept, normals, spacings, *tree);
    for (const double radius : ball_radii(spacings))
        if (!balls.roll(radius, context))
            return Context::cancelled_error("reconstruction");
    for (auto& t : balls.triangles)
        for (Index& v : t)
            v = number[v];
    return std::move(balls.triangles);
}

} // namespace bot2nurbs
