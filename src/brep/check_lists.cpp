// SPDX-License-Identifier: MIT
#include "brep/brep_rules.h"

#include "brep/bspline.h"

#include <algorithm>
#include <cmath>

namespace bot2nurbs {

namespace {

template <class List> bool all_below(const List& list, std::size_t size)
{
    return std::all_of(list.begin(), list.end(), [&](Index i) { return i < size; });
}

std::string no_such(const char* owner, Index i, const char* what)
{
    return std::string(owner) + " " + std::to_string(i) + " names " + what + " that does not exist";
}

//! Openings of openNURBS' rules for knots: ascending, every interior value at most degree times,
//! the ends exactly degree times, so that the curve starts and ends in its control points.
bool valid_knots(const std::vector<double>& knots, int order, Index count)
{
    const std::size_t degree = order - 1;
    if (knots.size() != count + order - 2)
        return false;
    for (std::size_t i = 0; i < knots.size(); ++i) {
        if (!std::isfinite(knots[i]) || (i > 0 && knots[i] < knots[i - 1]))
            return false;
        if (i >= degree && !(knots[i - degree] < knots[i]))
            return false;
    }
    return knots[0] == knots[degree - 1] && knots[knots.size() - degree] == knots.back();
}

bool all_finite(const std::vector<Vec3>& points)
{
    return std::all_of(points.begin(), points.end(), [](const Vec3& p) { return is_finite(p); });
}

template <class Range> bool same_multiset(Range a, Range b)
{
    std::sort(a.begin(), a.end());
    std::sort(b.begin(), b.end());
    return a == b;
}

} // namespace

void check_indices(const Brep& brep, DefectList& defects)
{
    for (Index i = 0; i < brep.vertices.size(); ++i) {
        if (!all_below(brep.vertices[i].edges, brep.edges.size()))
            defects.add("vertex_edge_range", i, no_such("vertex", i, "an edge"));
    }
    for (Index i = 0; i < brep.edges.size(); ++i) {
        const BrepEdge& e = brep.edges[i];
        if (e.curve >= brep.curves3.size())
            defects.add("edge_curve_range", i, no_such("edge", i, "a curve"));
        if (!all_below(e.vertex, brep.vertices.size()))
            defects.add("edge_vertex_range", i, no_such("edge", i, "a vertex"));
        if (!all_below(e.trims, brep.trims.size()))
            defects.add("edge_trim_range", i, no_such("edge", i, "a trim"));
    }
    for (Index i = 0; i < brep.trims.size(); ++i) {
        const BrepTrim& t = brep.trims[i];
        if (t.curve >= brep.curves2.size())
            defects.add("trim_curve_range", i, no_such("trim", i, "a curve"));
        if (t.edge >= brep.edges.size())
            defects.add("trim_edge_range", i, no_such("trim", i, "an edge"));
        if (!all_below(t.vertex, brep.vertices.size()))
            defects.add("trim_vertex_range", i, no_such("trim", i, "a vertex"));
        if (t.loop >= brep.loops.size())
            defects.add("trim_loop_range", i, no_such("trim", i, "a loop"));
    }
    for (Index i = 0; i < brep.loops.size(); ++i) {
        if (!all_below(brep.loops[i].trims, brep.trims.size()))
            defects.add("loop_trim_range", i, no_such("loop", i, "a trim"));
        if (brep.loops[i].face >= brep.faces.size())
            defects.add("loop_face_range", i, no_such("loop", i, "a face"));
    }
    for (Index i = 0; i < brep.faces.size(); ++i) {
        if (!all_below(brep.faces[i].loops, brep.loops.size()))
            defects.add("face_loop_range", i, no_such("face", i, "a loop"));
        if (brep.faces[i].surface >= brep.surfaces.size())
            defects.add("face_surface_range", i, no_such("face", i, "a surface"));
    }
}

void check_splines(const Brep& brep, DefectList& defects)
{
    for (Index i = 0; i < brep.curves3.size(); ++i) {
        const BrepCurve3& c = brep.curves3[i];
        const Index count = static_cast<Index>(c.control.size());
        if (c.order < 2 || c.order > max_spline_order || count < static_cast<Index>(c.order) ||
            !valid_knots(c.knots, c.order, count)) {
            defects.add("curve_knots", i,
                        "curve " + std::to_string(i) + " has no valid order, knots and size");
        } else if (!all_finite(c.control)) {
            defects.add("curve_finite", i,
                        "curve " + std::to_string(i) + " has a control point that is not finite");
        }
    }
    for (Index i = 0; i < brep.surfaces.size(); ++i) {
        const BsplinePatch& s = brep.surfaces[i];
        if (s.size < Index{patch_order} || s.control.size() != std::size_t{s.size} * s.size ||
            !valid_knots(s.knots, patch_order, s.size)) {
            defects.add("surface_knots", i,
                        "surface " + std::to_string(i) + " has no valid knots and size");
        } else if (!all_finite(s.control)) {
            defects.add("surface_finite", i,
                        "surface " + std::to_string(i) + " has a control point that is not finite");
        }
    }
    for (Index i = 0; i < brep.vertices.size(); ++i) {
        if (!is_finite(brep.vertices[i].point))
            defects.add("vertex_finite", i, "vertex " + std::to_string(i) + " is not finite");
    }
}

void check_lists(const Brep& brep, DefectList& defects)
{
    std::vector<std::vector<Index>> ends(brep.vertices.size()), uses(brep.edges.size());
    for (Index e = 0; e < brep.edges.size(); ++e) {
        for (Index v : brep.edges[e].vertex)
            ends[v].push_back(e);
    }
    for (Index v = 0; v < brep.vertices.size(); ++v) {
        if (!same_multiset(brep.vertices[v].edges, ends[v])) {
            defects.add("vertex_edge_list", v,
                        "vertex " + std::to_string(v) +
                            " does not list the edges that end at it, and these alone");
        } else if (ends[v].empty()) {
            defects.add("vertex_unused", v, "no edge ends at vertex " + std::to_string(v));
        }
    }
    for (Index t = 0; t < brep.trims.size(); ++t)
        uses[brep.trims[t].edge].push_back(t);
    for (Index e = 0; e < brep.edges.size(); ++e) {
        if (!same_multiset(brep.edges[e].trims, uses[e])) {
            defects.add("edge_trim_list", e,
                        "edge " + std::to_string(e) +
                            " does not list the trims that use it, and these alone");
        } else if (uses[e].empty()) {
            defects.add("edge_unused", e, "no face uses edge " + std::to_string(e));
        }
    }
    std::vector<std::vector<Index>> members(brep.loops.size()), owned(brep.faces.size());
    for (Index t = 0; t < brep.trims.size(); ++t)
        members[brep.trims[t].loop].push_back(t);
    for (Index l = 0; l < brep.loops.size(); ++l) {
        if (!same_multiset(brep.loops[l].trims, members[l])) {
            defects.add("loop_trim_list", l,
                        "loop " + std::to_string(l) +
                            " does not list the trims that belong to it, and these alone");
        } else if (members[l].empty()) {
            defects.add("loop_empty", l, "loop " + std::to_string(l) + " has no trims");
        }
        owned[brep.loops[l].face].push_back(l);
    }
    for (Index f = 0; f < brep.faces.size(); ++f) {
        if (!same_multiset(brep.faces[f].loops, owned[f])) {
            defects.add("face_loop_list", f,
                        "face " + std::to_string(f) +
                            " does not list the loops that belong to it, and these alone");
        } else if (owned[f].size() != 1) {
            defects.add("face_one_loop", f,
                        "face " + std::to_string(f) + " has " + std::to_string(owned[f].size()) +
                            " loops; a face over its whole rectangle has one");
        }
    }
}

} // namespace bot2nurbs
