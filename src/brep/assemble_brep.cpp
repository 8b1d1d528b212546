// SPDX-License-Identifier: MIT
#include "bot2nurbs/brep.h"

#include "brep/bspline.h"
#include "brep/volume.h"

namespace bot2nurbs {

namespace {

constexpr std::array<TrimIso, 4> side_iso{TrimIso::south, TrimIso::east, TrimIso::north,
                                          TrimIso::west};

//! The curve of a patch side, counter-clockwise around the patch. The knots of both forms are
//! symmetric, so the curve of the neighbour is this one with its control points reversed.
BrepCurve3 side_curve(const BsplinePatch& patch, Index side)
{
    BrepCurve3 curve;
    curve.order = patch_order;
    curve.knots = patch.knots;
    curve.control.reserve(patch.size);
    for (Index k = 0; k < patch.size; ++k)
        curve.control.push_back(patch.control[side_control(patch.size, side, k)]);
    return curve;
}

void add_edges(Brep& brep, const QuadComplex& complex)
{
    brep.vertices.resize(complex.vertex_count());
    for (Index e = 0; e < complex.edge_count(); ++e) {
        const Index h = complex.halfedge_of_edge(e);
        BrepCurve3 curve =
            side_curve(brep.surfaces[QuadComplex::quad_of(h)], QuadComplex::side_of(h));
        BrepEdge edge;
        edge.curve = static_cast<Index>(brep.curves3.size());
        edge.vertex = {complex.from(h), complex.to(h)};
        edge.t0 = domain_start(curve.knots, curve.order);
        edge.t1 = domain_end(curve.knots, static_cast<Index>(curve.control.size()));
        brep.vertices[edge.vertex[0]].point = curve.control.front();
        brep.vertices[edge.vertex[1]].point = curve.control.back();
        brep.vertices[edge.vertex[0]].edges.push_back(e);
        brep.vertices[edge.vertex[1]].edges.push_back(e);
        brep.curves3.push_back(std::move(curve));
        brep.edges.push_back(std::move(edge));
    }
}

TrimType trim_type(const QuadComplex& complex, Index h)
{
    const Index twin = complex.twin(h);
    if (twin == invalid_index)
        return TrimType::boundary;
    return QuadComplex::quad_of(twin) == QuadComplex::quad_of(h) ? TrimType::seam : TrimType::mated;
}

//! One face with one loop of four straight trims around the parameter rectangle. Trim and 2D curve
//! numbers are those of the halfedges.
void add_face(Brep& brep, const QuadComplex& complex, Index q)
{
    const BsplinePatch& patch = brep.surfaces[q];
    const double low = domain_start(patch.knots, patch_order);
    const double high = domain_end(patch.knots, patch.size);
    const std::array<Vec2, 4> corner{Vec2{low, low}, Vec2{high, low}, Vec2{high, high},
                                     Vec2{low, high}};
    BrepLoop loop;
    loop.face = q;
    for (Index s = 0; s < 4; ++s) {
        const Index h = 4 * q + s;
        BrepTrim trim;
        trim.curve = h;
        trim.edge = complex.edge(h);
        trim.vertex = {complex.from(h), complex.to(h)};
        trim.reversed = complex.halfedge_of_edge(trim.edge) != h;
        trim.type = trim_type(complex, h);
        trim.iso = side_iso[s];
        trim.loop = q;
        trim.t0 = 0.0;
        trim.t1 = high - low;
        brep.curves2.push_back({corner[s], corner[(s + 1) % 4], trim.t0, trim.t1});
        brep.edges[trim.edge].trims.push_back(h);
        brep.trims.push_back(trim);
        loop.trims.push_back(h);
    }
    brep.loops.push_back(std::move(loop));
    brep.faces.push_back({{q}, q, false});
}

//! The control points of every shared side must be the same numbers on both patches.
Status check_shared_sides(const Brep& brep, const QuadComplex& complex)
{
    for (Index e = 0; e < complex.edge_count(); ++e) {
        const Index h = complex.halfedge_of_edge(e), t = complex.twin(h);
        if (t == invalid_index)
            continue;
        const BsplinePatch& a = brep.surfaces[QuadComplex::quad_of(h)];
        const BsplinePatch& b = brep.surfaces[QuadComplex::quad_of(t)];
        for (Index k = 0; k < a.size; ++k) {
            if (a.control[side_control(a.size, QuadComplex::side_of(h), k)] !=
                b.control[side_control(b.size, QuadComplex::side_of(t), b.size - 1 - k)]) {
                return Error{ErrorCode::brep_failed,
                             "patches " + std::to_string(QuadComplex::quad_of(h)) + " and " +
                                 std::to_string(QuadComplex::quad_of(t)) +
                                 " disagree on their common side, edge " + std::to_string(e),
                             e};
            }
        }
    }
    return {};
}

} // namespace

Result<Brep> assemble_brep(const QuadComplex& complex, const SplineSurface& surface, KnotForm form)
{
    if (complex.quad_count() != surface.patch_count()) {
        return Error{ErrorCode::bad_option,
                     "the domain has " + std::to_string(complex.quad_count()) +
                         " quads, the surface " + std::to_string(surface.patch_count()) +
                         " patches",
                     invalid_index};
    }
    Brep brep;
    brep.surfaces.reserve(complex.quad_count());
    for (Index q = 0; q < complex.quad_count(); ++q)
        brep.surfaces.push_back(bspline_patch(surface, q, form));
    if (Status error = check_shared_sides(brep, complex))
        return *error;
    add_edges(brep, complex);
    brep.curves2.reserve(complex.halfedge_count());
    brep.trims.reserve(complex.halfedge_count());
    for (Index q = 0; q < complex.quad_count(); ++q)
        add_face(brep, complex, q);

    if (complex.closed() && complex.quad_count() > 0) {
        if (signed_volume(brep) < 0.0) {
            for (BrepFace& face : brep.faces)
                face.reversed = true;
        }
        brep.solid = true;
    }
    const BrepReport report = check_brep(brep);
    if (!report.valid) {
        const BrepDefect& first = report.defects.front();
        return Error{ErrorCode::brep_failed, first.rule + ": " + first.message, first.element};
    }
    return brep;
}

} // namespace bot2nurbs
