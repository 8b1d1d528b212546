// SPDX-License-Identifier: MIT
#include "layout/quad_places.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <tuple>

namespace bot2nurbs {

namespace {

// A mesh vertex or edge this near to a place is taken for it: over the shortest edge (the height)
// of the face, and over the mean length of the quads' edges, whichever is less.
constexpr double snap_to_mesh = 0.12;
constexpr double snap_to_quads = 0.08;
// What is not on a vertex or edge keeps this distance from it, likewise, ...
constexpr double least_share = 0.1;
constexpr double least_distance = 0.05;
// ... and vertices of one quad this from each other, over the length of the quads' edges.
constexpr double least_gap = 0.02;
// Weights are multiples of this: far finer than any distance above, and coarse enough for the sum
// of three, and for thirteen halvings, to be exact.
constexpr double weight_step = 0x1p-40;
// A vertex that finds its place taken goes towards its neighbours by these steps of the way.
constexpr double retreat = 0.1;
constexpr int retreats = 7;

using Weights = std::array<double, 3>;

double rounded(double w)
{
    return std::round(w / weight_step) * weight_step;
}

class Chooser {
public:
    Chooser(const ManifoldMesh& source, const ClosestPoint& closest, const PlacedQuads& quads,
            const std::vector<Vec3>& normals, const CurveMatch& match)
        : source_(source), closest_(closest), quads_(quads), normals_(normals), match_(match),
          covered_vertex_(source.vertex_count(), 0), covered_edge_(source.halfedge_count(), 0),
          places_(quads.complex.vertex_count())
    {
    }

    Result<std::vector<SourcePoint>> run()
    {
        for (const std::vector<CurveSite>& sites : match_.sites)
            for (const CurveSite& site : sites)
                if (site.node != invalid_index)
                    take(site.vertex, at_vertex(site.node));
        for (Index l = 0; l < match_.lines.size(); ++l)
            place_on_line(l);
        for (const CurveEdge& e : match_.edges)
            cover(e);
        for (Index v = 0; v < places_.size(); ++v)
            if (places_[v].face == invalid_index && !place_freely(v))
                return Error{ErrorCode::invalid_domain,
                             "finds no place on the mesh that is not taken", v};
        return std::move(places_);
    }

private:
    // What a place lies on: a vertex {v, none, none}, an edge {name, t, none} or a face.
    using Key = std::tuple<int, Index, double, double>;
    Key key_of(const SourcePoint& p) const
    {
        const auto zeros = std::count(p.bary.begin(), p.bary.end(), 0.0);
        for (Index k = 0; k < 3; ++k) {
            const Index h = 3 * p.face + k;
            if (zeros == 2 && p.bary[k] != 0.0)
                return {0, source_.from(h), 0.0, 0.0};
            if (zeros == 1 && p.bary[(k + 2) % 3] == 0.0) {
                const Index e = source_.edge(h);
                return {1, e, e == h ? p.bary[(k + 1) % 3] : p.bary[k], 0.0};
            }
        }
        return {2, p.face, p.bary[0], p.bary[1]};
    }
    bool take(Index v, const SourcePoint& p)
    {
        if (!taken_.insert(key_of(p)).second)
            return false;
        places_[v] = p;
        return true;
    }
    SourcePoint at_vertex(Index m) const
    {
        const Index h = source_.halfedge_at(m);
        SourcePoint p{ManifoldMesh::face(h), {}};
        p.bary[h % 3] = 1.0;
        return p;
    }
    // On the edge from a to b.
    SourcePoint on_edge(Index a, Index b, double t) const
    {
        t = rounded(t);
        Index h = source_.find_halfedge(a, b);
        if (h == invalid_index) {
            h = source_.find_halfedge(b, a);
            t = 1.0 - t;
        }
        SourcePoint p{ManifoldMesh::face(h), {}};
        p.bary[h % 3] = 1.0 - t;
        p.bary[ManifoldMesh::next(h) % 3] = t;
        return p;
    }
    double shorter_edge(const CurveLine& line, std::size_t i) const
    {
        const std::size_t last = line.arc.size() - 1;
        const double before = line.arc[i > 0 ? i : last] - line.arc[i > 0 ? i - 1 : last - 1];
        const double after = i < last ? line.arc[i + 1] - line.arc[i] : line.arc[1];
        return std::min(before, after);
    }

    void place_on_line(Index l)
    {
        const CurveLine& line = match_.lines[l];
        const std::vector<CurveSite>& sites = match_.sites[l];
        const std::size_t last = line.vertices.size() - 1;
        // First which sites get a vertex of the line.
        std::vector<std::size_t> at(sites.size(), last + 1);
        for (std::size_t k = 0; k < sites.size(); ++k) {
            const std::size_t i = nearest(line, sites[k].s);
            const Index v = sites[k].vertex;
            const double snap =
                std::min(snap_to_mesh * shorter_edge(line, i), snap_to_quads * quads_.size[v]);
            if (sites[k].node != invalid_index || (std::fabs(sites[k].s - line.arc[i]) <= snap &&
                                                   take(v, at_vertex(line.vertices[i]))))
                at[k] = i;
        }
        // The others between the vertices of the line, in their order.
        std::size_t k = 0;
        for (std::size_t i = 0; i < last; ++i) {
            std::vector<std::pair<Index, double>> inside; // Vertex of the quads, share of the edge.
            for (; k < sites.size() && sites[k].s <= line.arc[i + 1]; ++k) {
                if (at[k] <= last && at[k] > i)
                    break; // At the far end: what comes after it is on the next edge.
                if (at[k] > last)
                    inside.emplace_back(sites[k].vertex, (sites[k].s - line.arc[i]) /
                                                             (line.arc[i + 1] - line.arc[i]));
            }
            place_on_edge(line.vertices[i], line.vertices[i + 1], std::move(inside));
        }
    }

    static std::size_t nearest(const CurveLine& line, double s)
    {
        const auto after = std::lower_bound(line.arc.begin(), line.arc.end(), s);
        if (after == line.arc.end())
            return line.arc.size() - 1;
        const std::size_t i = static_cast<std::size_t>(after - line.arc.begin());
        return i > 0 && s - line.arc[i - 1] < line.arc[i] - s ? i - 1 : i;
    }

    void place_on_edge(Index a, Index b, std::vector<std::pair<Index, double>> inside)
    {
        double gap = std::min(least_share, 0.5 / (static_cast<double>(inside.size()) + 1.0));
        for (const auto& [v, t] : inside)
            gap = std::min(gap, edge_margin(v, a, b));
        double bound = gap;
        for (auto& [v, t] : inside) {
            t = std::max(t, bound);
            bound = t + gap;
        }
        bound = 1.0 - gap;
        for (std::size_t i = inside.size(); i-- > 0;) {
            inside[i].second = std::min(inside[i].second, bound);
            bound = inside[i].second - gap;
        }
        for (const auto& [v, t] : inside)
            take(v, on_edge(a, b, t));
    }
    // Least share of an edge between a site and the edge's ends.
    double edge_margin(Index v, Index a, Index b) const
    {
        const double length = norm(source_.position(b) - source_.position(a));
        return std::min(least_share, least_distance * quads_.size[v] / length);
    }

    // Marks the edges and vertices of the line under an edge of the quads.
    void cover(const CurveEdge& e)
    {
        const CurveLine& line = match_.lines[e.line];
        const auto [begin, end] = match_.span(e);
        for (std::size_t i = 0; i + 1 < line.arc.size(); ++i)
            for (const double shift : {0.0, line.length()})
                if (line.arc[i] + shift < end && line.arc[i + 1] + shift > begin) {
                    const Index a = line.vertices[i], b = line.vertices[i + 1];
                    Index h = source_.find_halfedge(a, b);
                    if (h == invalid_index)
                        h = source_.find_halfedge(b, a);
                    covered_edge_[source_.edge(h)] = 1;
                    covered_vertex_[a] = covered_vertex_[b] = 1;
                }
    }

    bool place_freely(Index v)
    {
        Vec3 middle;
        double count = 0.0;
        const QuadComplex& complex = quads_.complex;
        Index h = complex.halfedge_at(v);
        const Index first = h;
        do {
            middle += quads_.positions[complex.to(h)];
            count += 1.0;
            h = complex.rotate_ccw(h);
        } while (h != first && h != invalid_index);
        const Vec3 way = middle / count - quads_.positions[v];
        for (int i = 0; i <= retreats; ++i) {
            const Vec3 wanted = quads_.positions[v] + (i * retreat) * way;
            ClosestPoint::Hit hit = closest_.query_facing(wanted, normals_[v]);
            if (hit.where.face == invalid_index)
                hit = closest_.query(wanted);
            const SourcePoint p = tidied(v, hit.where);
            if (!is_crowded(v, source_.at(p)) && take(v, p))
                return true;
        }
        return false;
    }

    // Whether another vertex of a quad of v is at a point.
    bool is_crowded(Index v, const Vec3& p) const
    {
        const QuadComplex& complex = quads_.complex;
        Index h = complex.halfedge_at(v);
        const Index first = h;
        do {
            for (const Index u : complex.quad(QuadComplex::quad_of(h)))
                if (u != v && places_[u].face != invalid_index &&
                    norm(source_.at(places_[u]) - p) < least_gap * quads_.size[v])
                    return true;
            h = complex.rotate_ccw(h);
        } while (h != first && h != invalid_index);
        return false;
    }

    // A place on the nearby vertex or edge, or off them.
    SourcePoint tidied(Index v, const SourcePoint& at) const
    {
        const Index f = at.face;
        const Vec3 p = source_.at(at);
        double shortest = INFINITY;
        Index corner = 0;
        for (Index k = 0; k < 3; ++k) {
            const Index h = 3 * f + k;
            shortest = std::min(shortest, norm(source_.position(source_.to(h)) -
                                               source_.position(source_.from(h))));
            if (at.bary[k] > at.bary[corner])
                corner = k;
        }
        const Index m = source_.triangle(f)[corner];
        if (!covered_vertex_[m] && taken_.count({0, m, 0.0, 0.0}) == 0 &&
            norm(p - source_.position(m)) <=
                std::min(snap_to_mesh * shortest, snap_to_quads * quads_.size[v]))
            return at_vertex(m);

        const double area = norm(source_.area_vector(f));
        Weights margin{}; // Least weight of each corner off the side opposite.
        Index near = 3;
        for (Index k = 0; k < 3; ++k) {
            const Index h = 3 * f + (k + 1) % 3;
            const Vec3 side = source_.position(source_.to(h)) - source_.position(source_.from(h));
            const double height = area / norm(side);
            margin[k] = std::min(least_share, least_distance * quads_.size[v] / height);
            const double away = at.bary[k] * height;
            if (away <= std::min(snap_to_mesh * height, snap_to_quads * quads_.size[v]) &&
                !covered_edge_[source_.edge(h)] && (near == 3 || at.bary[k] < at.bary[near]))
                near = k;
        }
        if (near < 3) {
            const Index a = source_.triangle(f)[(near + 1) % 3];
            const Index b = source_.triangle(f)[(near + 2) % 3];
            const double least = edge_margin(v, a, b);
            const double t =
                at.bary[(near + 2) % 3] / (at.bary[(near + 1) % 3] + at.bary[(near + 2) % 3]);
            return on_edge(a, b, std::clamp(t, least, 1.0 - least));
        }
        SourcePoint inside{f, {}};
        double sum = 0.0;
        for (int k = 0; k < 3; ++k)
            sum += inside.bary[k] = std::max(at.bary[k], margin[k]);
        for (int k = 0; k < 2; ++k)
            inside.bary[k] = rounded(inside.bary[k] / sum);
        inside.bary[2] = 1.0 - inside.bary[0] - inside.bary[1];
        return inside;
    }

    const ManifoldMesh& source_;
    const ClosestPoint& closest_;
    const PlacedQuads& quads_;
    const std::vector<Vec3>& normals_;
    const CurveMatch& match_;
    std::vector<char> covered_vertex_; // Under an edge of the quads.
    std::vector<char> covered_edge_;   // By the edge's name.
    std::vector<SourcePoint> places_;
    std::set<Key> taken_;
};

} // namespace

Result<std::vector<SourcePoint>> quad_places(const ManifoldMesh& source,
                                             const ClosestPoint& closest, const PlacedQuads& quads,
                                             const std::vector<Vec3>& normals,
                                             const CurveMatch& match)
{
    return Chooser(source, closest, quads, normals, match).run();
}

} // namespace bot2nurbs
