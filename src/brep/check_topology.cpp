// SPDX-License-Identifier: MIT
#include "brep/brep_rules.h"

#include "core/disjoint_sets.h"

#include <numeric>

namespace bot2nurbs {

namespace {

bool runs_with_outside(const Brep& brep, const BrepTrim& trim)
{
    return trim.reversed == brep.faces[brep.loops[trim.loop].face].reversed;
}

TrimType expected_type(const Brep& brep, const BrepEdge& edge)
{
    if (edge.trims.size() == 1)
        return TrimType::boundary;
    if (edge.trims.size() == 2 && brep.loops[brep.trims[edge.trims[0]].loop].face ==
                                      brep.loops[brep.trims[edge.trims[1]].loop].face)
        return TrimType::seam;
    return TrimType::mated;
}

void check_trim(const Brep& brep, Index t, DefectList& defects)
{
    const BrepTrim& trim = brep.trims[t];
    const BrepEdge& edge = brep.edges[trim.edge];
    if (trim.type != expected_type(brep, edge)) {
        defects.add("trim_type", t,
                    "the type of trim " + std::to_string(t) + " does not fit the " +
                        std::to_string(edge.trims.size()) + " uses of edge " +
                        std::to_string(trim.edge));
    }
    const Index from = trim.reversed ? 1 : 0;
    if (trim.vertex[0] != edge.vertex[from] || trim.vertex[1] != edge.vertex[1 - from]) {
        defects.add("trim_vertices", t,
                    "the vertices of trim " + std::to_string(t) + " are not those of edge " +
                        std::to_string(trim.edge));
    }
}

//! The corners of faces at each vertex, joined over edges, must form one fan. Corner t is the one
//! where trim t starts.
void check_fans(const Brep& brep, DefectList& defects)
{
    const std::vector<Index> next = next_trims(brep);
    DisjointSets corners(brep.trims.size());
    std::vector<char> nonmanifold(brep.vertices.size(), 0);
    for (const BrepEdge& edge : brep.edges) {
        for (int end = 0; end < 2; ++end) {
            if (edge.trims.size() > 2)
                nonmanifold[edge.vertex[end]] = 1; // told already, for the edge
            Index first = invalid_index;
            for (Index t : edge.trims) {
                const bool starts = brep.trims[t].reversed == (end == 1);
                const Index corner = starts ? t : next[t];
                if (first == invalid_index)
                    first = corner;
                else
                    corners.join(first, corner);
            }
        }
    }
    std::vector<Index> fan(brep.vertices.size(), invalid_index);
    for (Index t = 0; t < brep.trims.size(); ++t) {
        const Index v = start_vertex(brep, brep.trims[t]), root = corners.find(t);
        if (fan[v] == invalid_index) {
            fan[v] = root;
        } else if (fan[v] != root && !nonmanifold[v]) {
            nonmanifold[v] = 1;
            defects.add("nonmanifold_vertex", v,
                        "the faces at vertex " + std::to_string(v) +
                            " are not all connected over edges there");
        }
    }
}

} // namespace

Index start_vertex(const Brep& brep, const BrepTrim& trim)
{
    return brep.edges[trim.edge].vertex[trim.reversed ? 1 : 0];
}

std::vector<Index> next_trims(const Brep& brep)
{
    std::vector<Index> next(brep.trims.size());
    for (const BrepLoop& loop : brep.loops) {
        for (std::size_t i = 0; i < loop.trims.size(); ++i)
            next[loop.trims[i]] = loop.trims[(i + 1) % loop.trims.size()];
    }
    return next;
}

FaceComponents face_components(const Brep& brep)
{
    DisjointSets sets(brep.faces.size());
    for (const BrepEdge& edge : brep.edges) {
        for (Index t : edge.trims)
            sets.join(brep.loops[brep.trims[edge.trims[0]].loop].face,
                      brep.loops[brep.trims[t].loop].face);
    }
    FaceComponents c;
    c.of_face.resize(brep.faces.size());
    for (Index f = 0; f < brep.faces.size(); ++f) {
        const Index root = sets.find(f); // the smallest face of the set, so already numbered
        c.of_face[f] = root == f ? c.count++ : c.of_face[root];
    }
    return c;
}

void check_topology(const Brep& brep, DefectList& defects, BrepReport& report)
{
    report.euler_characteristic = static_cast<int>(brep.vertices.size()) -
                                  static_cast<int>(brep.edges.size()) +
                                  static_cast<int>(brep.faces.size());
    report.components = face_components(brep).count;
    for (Index t = 0; t < brep.trims.size(); ++t)
        check_trim(brep, t, defects);
    for (Index e = 0; e < brep.edges.size(); ++e) {
        const std::vector<Index>& trims = brep.edges[e].trims;
        if (trims.size() == 1) {
            ++report.boundary_edges;
        } else if (trims.size() > 2) {
            ++report.nonmanifold_edges;
            defects.add("nonmanifold_edge", e,
                        std::to_string(trims.size()) + " faces meet at edge " + std::to_string(e));
        } else if (runs_with_outside(brep, brep.trims[trims[0]]) ==
                   runs_with_outside(brep, brep.trims[trims[1]])) {
            defects.add("mated_orientation", e,
                        "the two faces at edge " + std::to_string(e) +
                            " are not oriented consistently");
        }
    }
    check_fans(brep, defects);
}

} // namespace bot2nurbs
