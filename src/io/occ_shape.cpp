// SPDX-License-Identifier: MIT
#include "io/occ_shape.h"

#include "brep/brep_rules.h"
#include "brep/volume.h"

#include <BRep_Builder.hxx>
#include <Geom2d_BSplineCurve.hxx>
#include <Geom2d_Line.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColgp_Array1OfPnt.hxx>
#include <TColgp_Array1OfPnt2d.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <TopoDS_Vertex.hxx>
#include <TopoDS_Wire.hxx>

#include <algorithm>
#include <cmath>

namespace bot2nurbs {

namespace {

// Open CASCADE's own confusion distance; small models get a share of their diagonal instead, and no
// tolerance is below what evaluating a spline rounds to at the model's coordinates.
constexpr double confusion = 1e-7, tolerance_share = 1e-6, rounding_share = 1e-14;

double shape_tolerance(const Brep& brep)
{
    const Box3 box = bounding_box(brep);
    double largest = 0.0;
    for (int k = 0; k < 3; ++k)
        largest = std::max({largest, std::fabs(box.min[k]), std::fabs(box.max[k])});
    return std::max(std::min(confusion, tolerance_share * box.diagonal()),
                    rounding_share * largest);
}

gp_Pnt to_point(const Vec3& p)
{
    return {p.x, p.y, p.z};
}

//! Distinct knots and their multiplicities; the ends once more than openNURBS has them.
struct KnotTable {
    TColStd_Array1OfReal knots;
    TColStd_Array1OfInteger multiplicities;

    explicit KnotTable(const std::vector<double>& all)
        : knots(1, distinct(all)), multiplicities(1, distinct(all))
    {
        int n = 0;
        for (std::size_t i = 0; i < all.size(); ++i) {
            if (i == 0 || all[i] != all[i - 1]) {
                ++n;
                knots(n) = all[i];
                multiplicities(n) = 0;
            }
            ++multiplicities(n);
        }
        ++multiplicities(1);
        ++multiplicities(n);
    }

private:
    static int distinct(const std::vector<double>& all)
    {
        int n = 0;
        for (std::size_t i = 0; i < all.size(); ++i)
            n += i == 0 || all[i] != all[i - 1];
        return n;
    }
};

Handle(Geom_BSplineCurve) to_curve(const BrepCurve3& curve)
{
    TColgp_Array1OfPnt poles(1, static_cast<int>(curve.control.size()));
    for (std::size_t i = 0; i < curve.control.size(); ++i)
        poles(static_cast<int>(i) + 1) = to_point(curve.control[i]);
    const KnotTable table(curve.knots);
    return new Geom_BSplineCurve(poles, table.knots, table.multiplicities, curve.order - 1);
}

Handle(Geom_BSplineSurface) to_surface(const BsplinePatch& patch)
{
    constexpr int degree = 3;
    const int n = static_cast<int>(patch.size);
    TColgp_Array2OfPnt poles(1, n, 1, n);
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j)
            poles(i + 1, j + 1) = to_point(patch.control[i * n + j]);
    }
    const KnotTable table(patch.knots);
    return new Geom_BSplineSurface(poles, table.knots, table.knots, table.multiplicities,
                                   table.multiplicities, degree, degree);
}

//! The line of a trim with the parameter of its edge.
Handle(Geom2d_Curve) to_parameter_line(const Brep& brep, const BrepTrim& trim)
{
    const BrepCurve2& line = brep.curves2[trim.curve];
    const BrepEdge& edge = brep.edges[trim.edge];
    const Vec2 from = trim.reversed ? line.b : line.a, to = trim.reversed ? line.a : line.b;
    const double length = norm(to - from), range = edge.t1 - edge.t0;
    if (length == range) {
        const Vec2 direction = (1.0 / length) * (to - from);
        const Vec2 origin = from - edge.t0 * direction;
        return new Geom2d_Line(gp_Pnt2d(origin.x, origin.y), gp_Dir2d(direction.x, direction.y));
    }
    TColgp_Array1OfPnt2d poles(1, 2);
    poles(1) = gp_Pnt2d(from.x, from.y);
    poles(2) = gp_Pnt2d(to.x, to.y);
    TColStd_Array1OfReal knots(1, 2);
    knots(1) = edge.t0;
    knots(2) = edge.t1;
    TColStd_Array1OfInteger multiplicities(1, 2);
    multiplicities.Init(2);
    return new Geom2d_BSplineCurve(poles, knots, multiplicities, 1);
}

//! Makes the faces of one B-Rep, with shared edges and vertices.
class FaceBuilder {
public:
    explicit FaceBuilder(const Brep& brep) : brep_(brep), tolerance_(shape_tolerance(brep))
    {
        vertices_.resize(brep.vertices.size());
        for (Index v = 0; v < brep.vertices.size(); ++v)
            builder_.MakeVertex(vertices_[v], to_point(brep.vertices[v].point), tolerance_);
        edges_.resize(brep.edges.size());
        for (Index e = 0; e < brep.edges.size(); ++e)
            make_edge(e);
    }

    TopoDS_Face make_face(Index f)
    {
        const BrepFace& face = brep_.faces[f];
        TopoDS_Face shape;
        builder_.MakeFace(shape, to_surface(brep_.surfaces[face.surface]), tolerance_);
        for (Index l : face.loops) {
            TopoDS_Wire wire;
            builder_.MakeWire(wire);
            for (Index t : brep_.loops[l].trims) {
                const BrepTrim& trim = brep_.trims[t];
                add_parameter_line(trim, shape);
                builder_.Add(wire, edges_[trim.edge].Oriented(trim.reversed ? TopAbs_REVERSED
                                                                            : TopAbs_FORWARD));
            }
            wire.Closed(true);
            builder_.Add(shape, wire);
        }
        if (face.reversed)
            shape.Reverse();
        return shape;
    }

private:
    void make_edge(Index e)
    {
        const BrepEdge& edge = brep_.edges[e];
        TopoDS_Edge& shape = edges_[e];
        builder_.MakeEdge(shape, to_curve(brep_.curves3[edge.curve]), tolerance_);
        builder_.Add(shape, vertices_[edge.vertex[0]].Oriented(TopAbs_FORWARD));
        builder_.Add(shape, vertices_[edge.vertex[1]].Oriented(TopAbs_REVERSED));
        builder_.Range(shape, edge.t0, edge.t1);
        // True because the line on each face has the edge's own parameter.
        builder_.SameParameter(shape, true);
        builder_.SameRange(shape, true);
    }

    //! Adds the trim's line to its edge. A seam has two lines on one face, which go in together
    //! with the first of the two: first the one that runs with the edge.
    void add_parameter_line(const BrepTrim& trim, const TopoDS_Face& face)
    {
        const TopoDS_Edge& edge = edges_[trim.edge];
        if (trim.type != TrimType::seam) {
            builder_.UpdateEdge(edge, to_parameter_line(brep_, trim), face, tolerance_);
            return;
        }
        const std::vector<Index>& both = brep_.edges[trim.edge].trims;
        const BrepTrim &first = brep_.trims[both[0]], &second = brep_.trims[both[1]];
        const BrepTrim &with = first.reversed ? second : first,
                       &against = first.reversed ? first : second;
        builder_.UpdateEdge(edge, to_parameter_line(brep_, with), to_parameter_line(brep_, against),
                            face, tolerance_);
    }

    const Brep& brep_;
    double tolerance_;
    BRep_Builder builder_;
    std::vector<TopoDS_Vertex> vertices_;
    std::vector<TopoDS_Edge> edges_;
};

//! One connected set of faces.
struct Part {
    std::vector<Index> faces;
    Box3 box;
    double volume = 0.0;
    TopoDS_Shell shell;
};

std::vector<Part> make_parts(const Brep& brep)
{
    const FaceComponents components = face_components(brep);
    std::vector<Part> parts(components.count);
    FaceBuilder faces(brep);
    const BRep_Builder builder;
    for (Part& part : parts)
        builder.MakeShell(part.shell);
    for (Index f = 0; f < brep.faces.size(); ++f) {
        Part& part = parts[components.of_face[f]];
        part.faces.push_back(f);
        for (const Vec3& c : brep.surfaces[brep.faces[f].surface].control)
            part.box.add(c);
        builder.Add(part.shell, faces.make_face(f));
    }
    for (Part& part : parts) {
        part.shell.Closed(brep.solid);
        if (brep.solid)
            part.volume = signed_volume(brep, part.faces, part.box.center());
    }
    return parts;
}

bool contains(const Box3& a, const Box3& b)
{
    return a.min.x <= b.min.x && a.min.y <= b.min.y && a.min.z <= b.min.z && a.max.x >= b.max.x &&
           a.max.y >= b.max.y && a.max.z >= b.max.z;
}

//! Solids of the outward parts; an inward part is a hollow of the smallest solid around it.
Result<std::vector<TopoDS_Shape>> make_solids(std::vector<Part>& parts)
{
    const BRep_Builder builder;
    std::vector<TopoDS_Solid> solid(parts.size());
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (parts[i].volume > 0.0) {
            builder.MakeSolid(solid[i]);
            builder.Add(solid[i], parts[i].shell);
        }
    }
    for (const Part& hollow : parts) {
        if (hollow.volume > 0.0)
            continue;
        std::size_t around = parts.size();
        for (std::size_t i = 0; i < parts.size(); ++i) {
            if (parts[i].volume > 0.0 && contains(parts[i].box, hollow.box) &&
                (around == parts.size() || parts[i].volume < parts[around].volume))
                around = i;
        }
        if (around == parts.size()) {
            return Error{ErrorCode::brep_failed,
                         "the part with face " + std::to_string(hollow.faces.front()) +
                             " turns inward and no part is around it",
                         hollow.faces.front()};
        }
        builder.Add(solid[around], hollow.shell);
    }
    std::vector<TopoDS_Shape> solids;
    for (const TopoDS_Solid& s : solid) {
        if (!s.IsNull())
            solids.push_back(s);
    }
    return solids;
}

std::mutex& session_mutex()
{
    static std::mutex mutex;
    return mutex;
}

} // namespace

Result<TopoDS_Shape> brep_to_shape(const Brep& brep)
{
    std::vector<Part> parts = make_parts(brep);
    std::vector<TopoDS_Shape> shapes;
    if (brep.solid) {
        Result<std::vector<TopoDS_Shape>> solids = make_solids(parts);
        if (!solids)
            return solids.error();
        shapes = std::move(*solids);
    } else {
        for (const Part& part : parts)
            shapes.push_back(part.shell);
    }
    if (shapes.size() == 1)
        return shapes.front();
    const BRep_Builder builder;
    TopoDS_Compound compound;
    builder.MakeCompound(compound);
    for (const TopoDS_Shape& shape : shapes)
        builder.Add(compound, shape);
    return TopoDS_Shape(compound);
}

OccSession::OccSession() : lock_(session_mutex())
{
    Message_SequenceOfPrinters& active = Message::DefaultMessenger()->ChangePrinters();
    printers_ = active;
    active.Clear();
}

OccSession::~OccSession()
{
    Message::DefaultMessenger()->ChangePrinters() = printers_;
}

} // namespace bot2nurbs
