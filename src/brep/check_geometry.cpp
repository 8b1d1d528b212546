// SPDX-License-Identifier: MIT
#include "brep/brep_rules.h"

#include "brep/bspline.h"
#include "brep/volume.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace bot2nurbs {

namespace {

// Shorter than this share of the diagonal is nothing: a nanometre on a part of one metre. BRL-CAD's
// quality check uses 1e-8 mm for duplicate vertices and edge lengths.
constexpr double length_share = 1e-9;
// Shorter than this share of the parameter rectangle's side is nothing (BRL-CAD: 1e-10 absolute).
constexpr double trim_share = 1e-10;
// A face thinner than this is likely a mistake (BRL-CAD: 1e5).
constexpr double aspect_limit = 1e5;
// Parameters per knot span where an edge with other knots than its face's side is compared.
constexpr int gap_samples = 8;

enum class Side { south, east, north, west, none };

//! The side of the rectangle [low, high]^2 that holds both points.
Side side_of(const Vec2& a, const Vec2& b, double low, double high)
{
    if (a.y == low && b.y == low)
        return Side::south;
    if (a.x == high && b.x == high)
        return Side::east;
    if (a.y == high && b.y == high)
        return Side::north;
    if (a.x == low && b.x == low)
        return Side::west;
    return Side::none;
}

TrimIso iso_of(Side side)
{
    switch (side) {
    case Side::south: return TrimIso::south;
    case Side::east: return TrimIso::east;
    case Side::north: return TrimIso::north;
    default: return TrimIso::west;
    }
}

bool inside(const Vec2& p, double low, double high)
{
    return p.x >= low && p.x <= high && p.y >= low && p.y <= high;
}

//! A length as people read it, whatever its size.
std::string to_text(double length)
{
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.3g", length);
    return text.data();
}

//! Length of the control polygon: zero only when the curve is a point.
double polygon_length(const std::vector<Vec3>& control)
{
    double length = 0.0;
    for (std::size_t i = 1; i < control.size(); ++i)
        length += norm(control[i] - control[i - 1]);
    return length;
}

//! State of one run: what earlier rules found keeps later ones from telling it again.
class GeometryCheck {
public:
    GeometryCheck(const Brep& brep, DefectList& defects, DefectList& warnings, BrepReport& report)
        : brep_(brep), defects_(defects), warnings_(warnings), report_(report),
          diagonal_(bounding_box(brep).diagonal()), bad_trim_(brep.trims.size(), 0),
          bad_edge_(brep.edges.size(), 0), merged_vertex_(brep.vertices.size(), 0)
    {
    }

    void run()
    {
        for (Index e = 0; e < brep_.edges.size(); ++e)
            check_edge(e);
        for (Index t = 0; t < brep_.trims.size(); ++t)
            check_trim(t);
        for (Index l = 0; l < brep_.loops.size(); ++l)
            check_loop(l);
        check_vertices();
        for (Index t = 0; t < brep_.trims.size(); ++t)
            check_gap(t);
        for (Index f = 0; f < brep_.faces.size(); ++f)
            check_face(f);
        check_duplicate_vertices();
        check_overlap();
    }

private:
    const BsplinePatch& patch_of(const BrepTrim& trim) const
    {
        return brep_.surfaces[brep_.faces[brep_.loops[trim.loop].face].surface];
    }

    void check_edge(Index e)
    {
        const BrepEdge& edge = brep_.edges[e];
        const BrepCurve3& curve = brep_.curves3[edge.curve];
        const Index count = static_cast<Index>(curve.control.size());
        if (!(edge.t0 < edge.t1) || edge.t0 < domain_start(curve.knots, curve.order) ||
            edge.t1 > domain_end(curve.knots, count)) {
            defects_.add("edge_domain", e,
                         "the domain of edge " + std::to_string(e) + " is not inside its curve's");
            bad_edge_[e] = 1;
            return;
        }
        const double limit = length_share * diagonal_;
        if (polygon_length(curve.control) <= limit) {
            defects_.add("zero_length_edge", e, "edge " + std::to_string(e) + " has no length");
            merged_vertex_[edge.vertex[0]] = merged_vertex_[edge.vertex[1]] = 1;
            bad_edge_[e] = 1;
        } else if (norm(curve.control.back() - curve.control.front()) <= limit) {
            warnings_.add("closed_edge", e,
                          "edge " + std::to_string(e) +
                              " ends where it starts; BRL-CAD's quality check refuses that");
        }
    }

    void check_trim(Index t)
    {
        const BrepTrim& trim = brep_.trims[t];
        const BrepCurve2& line = brep_.curves2[trim.curve];
        const BsplinePatch& patch = patch_of(trim);
        const double low = domain_start(patch.knots, patch_order);
        const double high = domain_end(patch.knots, patch.size);
        const std::string name = "trim " + std::to_string(t);
        bad_trim_[t] = 1;
        if (!(line.t0 < line.t1) || !(trim.t0 < trim.t1) || trim.t0 < line.t0 ||
            trim.t1 > line.t1) {
            defects_.add("trim_domain", t, "the domain of " + name + " is not inside its curve's");
        } else if (!(norm(end(trim, 1) - end(trim, 0)) > trim_share * (high - low))) {
            defects_.add("zero_length_trim", t, name + " has no length in the parameter plane");
        } else if (!inside(end(trim, 0), low, high) || !inside(end(trim, 1), low, high)) {
            defects_.add("trim_outside_surface", t, name + " leaves the parameter rectangle");
        } else if (const Side side = side_of(end(trim, 0), end(trim, 1), low, high);
                   side == Side::none || iso_of(side) != trim.iso) {
            defects_.add("trim_iso", t,
                         name + (side == Side::none ? " does not lie on a side of the rectangle"
                                                    : " is marked with another side"));
            bad_trim_[t] = side == Side::none;
        } else {
            bad_trim_[t] = 0;
        }
    }

    //! Place in the parameter plane of the start (0) or end (1) of a trim.
    Vec2 end(const BrepTrim& trim, int which) const { return at(trim, which == 0 ? 0.0 : 1.0); }
    //! At a share of the trim's domain.
    Vec2 at(const BrepTrim& trim, double share) const
    {
        const BrepCurve2& line = brep_.curves2[trim.curve];
        const double t = trim.t0 + share * (trim.t1 - trim.t0);
        if (t == line.t1)
            return line.b; // exact, where a + 1 (b - a) may round
        return line.a + (t - line.t0) / (line.t1 - line.t0) * (line.b - line.a);
    }

    void check_loop(Index l)
    {
        const std::vector<Index>& trims = brep_.loops[l].trims;
        bool known = true, chained = true;
        double area = 0.0;
        for (std::size_t i = 0; i < trims.size(); ++i) {
            const Index t = trims[i], n = trims[(i + 1) % trims.size()];
            if (bad_trim_[t] || bad_trim_[n]) {
                known = false;
                continue;
            }
            const BrepTrim &a = brep_.trims[t], &b = brep_.trims[n];
            const Index last = brep_.edges[a.edge].vertex[a.reversed ? 0 : 1];
            if (last != start_vertex(brep_, b) || !(end(a, 1) == end(b, 0)))
                chained = false;
            area += 0.5 * cross(end(a, 0), end(a, 1));
        }
        if (!chained) {
            defects_.add("loop_not_closed", l,
                         "a trim of loop " + std::to_string(l) +
                             " does not start where the one before ends");
            for (Index t : trims)
                bad_trim_[t] = 1;
        } else if (known && !(area > 0.0)) {
            defects_.add("loop_orientation", l,
                         "loop " + std::to_string(l) +
                             " does not run counter-clockwise in the parameter plane");
        }
    }

    void check_vertices()
    {
        std::vector<double> off(brep_.vertices.size(), 0.0);
        for (Index e = 0; e < brep_.edges.size(); ++e) {
            const BrepEdge& edge = brep_.edges[e];
            if (bad_edge_[e])
                continue;
            const BrepCurve3& curve = brep_.curves3[edge.curve];
            for (int k = 0; k < 2; ++k) {
                const Vec3 p = evaluate_curve(curve, k == 0 ? edge.t0 : edge.t1);
                double& d = off[edge.vertex[k]];
                d = std::max(d, norm(p - brep_.vertices[edge.vertex[k]].point));
            }
        }
        for (Index v = 0; v < off.size(); ++v) {
            if (off[v] > coincidence_share * diagonal_) {
                defects_.add("vertex_off_edge", v,
                             "an edge ends " + to_text(off[v]) + " away from its vertex " +
                                 std::to_string(v));
            }
        }
    }

    //! Distance between an edge and the side of the face that a trim follows: zero when their
    //! control points are the same numbers, else measured.
    void check_gap(Index t)
    {
        const BrepTrim& trim = brep_.trims[t];
        if (bad_trim_[t] || bad_edge_[trim.edge])
            return;
        const double gap = same_control_points(trim) ? 0.0 : sampled_gap(trim);
        report_.max_edge_gap = std::max(report_.max_edge_gap, gap);
        if (gap > coincidence_share * diagonal_) {
            defects_.add("edge_off_surface", t,
                         "edge " + std::to_string(trim.edge) + " is " + to_text(gap) +
                             " away from the side of face " +
                             std::to_string(brep_.loops[trim.loop].face));
        }
    }

    bool same_control_points(const BrepTrim& trim) const
    {
        const BsplinePatch& patch = patch_of(trim);
        const BrepEdge& edge = brep_.edges[trim.edge];
        const BrepCurve3& curve = brep_.curves3[edge.curve];
        const double low = domain_start(patch.knots, patch_order);
        const double high = domain_end(patch.knots, patch.size);
        const Vec2 from = end(trim, 0), to = end(trim, 1);
        if (curve.order != patch_order || curve.knots != patch.knots || edge.t0 != low ||
            edge.t1 != high || std::fabs(to.x - from.x) + std::fabs(to.y - from.y) != high - low)
            return false;
        const Index side = static_cast<Index>(side_of(from, to, low, high));
        const Vec2 start[4] = {{low, low}, {high, low}, {high, high}, {low, high}};
        const bool ccw = from == start[side];
        const bool forward = ccw != trim.reversed;
        // A curve that runs backward has the same control points only when its knots mirror.
        if (!forward && !symmetric_knots(curve.knots))
            return false;
        for (Index k = 0; k < patch.size; ++k) {
            const Index m = forward ? k : patch.size - 1 - k;
            if (curve.control[k] != patch.control[side_control(patch.size, side, m)])
                return false;
        }
        return true;
    }

    static bool symmetric_knots(const std::vector<double>& knots)
    {
        const double sum = knots.front() + knots.back();
        for (std::size_t i = 0, j = knots.size() - 1; i < j; ++i, --j) {
            if (knots[i] + knots[j] != sum)
                return false;
        }
        return true;
    }

    double sampled_gap(const BrepTrim& trim) const
    {
        const BrepEdge& edge = brep_.edges[trim.edge];
        const BrepCurve3& curve = brep_.curves3[edge.curve];
        const int samples = gap_samples * static_cast<int>(curve.knots.size());
        double gap = 0.0;
        for (int i = 0; i <= samples; ++i) {
            const double share = static_cast<double>(i) / samples;
            const Vec3 on_edge = evaluate_curve(curve, edge.t0 + share * (edge.t1 - edge.t0));
            const Vec2 uv = at(trim, trim.reversed ? 1.0 - share : share);
            gap =
                std::max(gap, norm(evaluate_patch(patch_of(trim), uv.x, uv.y).position - on_edge));
        }
        return gap;
    }

    void check_face(Index f)
    {
        const BsplinePatch& patch = brep_.surfaces[brep_.faces[f].surface];
        const double limit = length_share * diagonal_;
        Box3 box;
        for (const Vec3& c : patch.control)
            box.add(c);
        // A sliver narrower than the limit along its longest extent.
        if (!(patch_area(patch) > limit * box.diagonal())) {
            defects_.add("degenerate_face", f, "face " + std::to_string(f) + " has no area");
            return;
        }
        const Vec3 size = box.max - box.min;
        const double longest = std::max({size.x, size.y, size.z});
        double shortest = longest;
        for (int k = 0; k < 3; ++k) {
            if (size[k] > limit)
                shortest = std::min(shortest, size[k]);
        }
        if (longest > aspect_limit * shortest) {
            warnings_.add("face_aspect_ratio", f,
                          "the box of face " + std::to_string(f) + " is " +
                              to_text(longest / shortest) + " times as long as thin");
        }
    }

    void check_duplicate_vertices()
    {
        const double limit = length_share * diagonal_;
        std::vector<Index> order(brep_.vertices.size());
        for (Index v = 0; v < order.size(); ++v)
            order[v] = v;
        std::sort(order.begin(), order.end(), [&](Index a, Index b) {
            const double x = brep_.vertices[a].point.x, y = brep_.vertices[b].point.x;
            return x != y ? x < y : a < b;
        });
        for (std::size_t i = 0; i < order.size(); ++i) {
            const Vec3& p = brep_.vertices[order[i]].point;
            for (std::size_t j = i + 1; j < order.size(); ++j) {
                const Vec3& q = brep_.vertices[order[j]].point;
                if (q.x - p.x > limit)
                    break;
                if (norm(q - p) > limit || (merged_vertex_[order[i]] && merged_vertex_[order[j]]))
                    continue;
                defects_.add("duplicate_vertices", std::max(order[i], order[j]),
                             "vertices " + std::to_string(std::min(order[i], order[j])) + " and " +
                                 std::to_string(std::max(order[i], order[j])) +
                                 " are at one place");
            }
        }
    }

    bool share_vertex(Index f, Index g) const
    {
        for (Index a : brep_.loops[brep_.faces[f].loops[0]].trims) {
            for (Index b : brep_.loops[brep_.faces[g].loops[0]].trims) {
                if (brep_.trims[a].vertex[0] == brep_.trims[b].vertex[0])
                    return true;
            }
        }
        return false;
    }

    //! BRL-CAD's screening for self-intersection: faces apart in topology whose boxes overlap so
    //! far that one holds the other's middle. Sorted by x, so that far faces are not compared.
    void check_overlap()
    {
        const Index n = static_cast<Index>(brep_.faces.size());
        std::vector<Box3> box(n);
        std::vector<Vec3> middle(n);
        std::vector<Index> order(n);
        for (Index f = 0; f < n; ++f) {
            const BsplinePatch& s = brep_.surfaces[brep_.faces[f].surface];
            for (const Vec3& c : s.control)
                box[f].add(c);
            const double t =
                0.5 * (domain_start(s.knots, patch_order) + domain_end(s.knots, s.size));
            middle[f] = evaluate_patch(s, t, t).position;
            order[f] = f;
        }
        std::sort(order.begin(), order.end(), [&](Index a, Index b) {
            return box[a].min.x != box[b].min.x ? box[a].min.x < box[b].min.x : a < b;
        });
        const auto holds = [](const Box3& b, const Vec3& p) {
            return p.x >= b.min.x && p.x <= b.max.x && p.y >= b.min.y && p.y <= b.max.y &&
                   p.z >= b.min.z && p.z <= b.max.z;
        };
        std::size_t pairs = 0;
        Index first = invalid_index;
        for (Index i = 0; i < n; ++i) {
            for (Index j = i + 1; j < n && box[order[j]].min.x <= box[order[i]].max.x; ++j) {
                const Index f = order[i], g = order[j];
                if ((holds(box[f], middle[g]) || holds(box[g], middle[f])) && !share_vertex(f, g)) {
                    ++pairs;
                    first = std::min({first, f, g});
                }
            }
        }
        if (pairs > 0) {
            warnings_.add("possible_self_intersection", first,
                          std::to_string(pairs) +
                              " pairs of faces without a common vertex have boxes that overlap "
                              "(first: face " +
                              std::to_string(first) + "); they may cross");
        }
    }

    const Brep& brep_;
    DefectList& defects_;
    DefectList& warnings_;
    BrepReport& report_;
    double diagonal_;
    std::vector<char> bad_trim_, bad_edge_, merged_vertex_;
};

} // namespace

void check_geometry(const Brep& brep, DefectList& defects, DefectList& warnings, BrepReport& report)
{
    GeometryCheck(brep, defects, warnings, report).run();
}

} // namespace bot2nurbs
