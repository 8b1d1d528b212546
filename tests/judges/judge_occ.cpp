// SPDX-License-Identifier: MIT
// Judges a STEP or .brep file with Open CASCADE and prints what it found as JSON.
//
//   judge_occ FILE [--solids N] [--closed] [--volume V --volume-share S] [--tolerance-share S]
//
// Lengths and volumes are in millimetres. --closed: every edge of two faces, shells closed, solids
// outward. --volume: of all solids together, within the share S (default 0.005). --tolerance-share:
// the largest tolerance is at most this share of the diagonal of the box.
// Exit code: 0 all that was asked for holds (always: BRepCheck finds the shape valid), 1 it does
// not (the JSON lists what in "failed"), 2 usage, 3 not readable.
#include <BRepBndLib.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepGProp.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Precision.hxx>
#include <STEPControl_Controller.hxx>
#include <STEPControl_Reader.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <TopoDS_Vertex.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace {

struct Options {
    std::string file;
    std::optional<int> solids;
    bool closed = false;
    std::optional<double> volume;
    double volume_share = 0.005;
    std::optional<double> tolerance_share;
};

std::optional<Options> parse(int argc, char** argv)
{
    Options o;
    for (int i = 1; i < argc; ++i) {
        const std::string a = argv[i];
        const bool more = i + 1 < argc;
        if (a == "--solids" && more)
            o.solids = std::stoi(argv[++i]);
        else if (a == "--closed")
            o.closed = true;
        else if (a == "--volume" && more)
            o.volume = std::stod(argv[++i]);
        else if (a == "--volume-share" && more)
            o.volume_share = std::stod(argv[++i]);
        else if (a == "--tolerance-share" && more)
            o.tolerance_share = std::stod(argv[++i]);
        else if (o.file.empty() && a.rfind("--", 0) != 0)
            o.file = a;
        else
            return {};
    }
    return o.file.empty() ? std::nullopt : std::optional(o);
}

bool ends_with(const std::string& s, const std::string& end)
{
    return s.size() >= end.size() && s.compare(s.size() - end.size(), end.size(), end) == 0;
}

//! Reads a file; the names of a STEP file's products and its unit go into the report.
TopoDS_Shape read(const std::string& file, nlohmann::json& report)
{
    TopoDS_Shape shape;
    if (ends_with(file, ".brep")) {
        const BRep_Builder builder;
        BRepTools::Read(shape, file.c_str(), builder);
        report["format"] = "brep";
        return shape;
    }
    report["format"] = "step";
    STEPControl_Reader reader;
    if (reader.ReadFile(file.c_str()) != IFSelect_RetDone)
        return shape;
    TColStd_SequenceOfAsciiString length, angle, solid_angle;
    reader.FileUnits(length, angle, solid_angle);
    report["units"] = nlohmann::json::array();
    for (int i = 1; i <= length.Length(); ++i)
        report["units"].push_back(length(i).ToCString());
    reader.TransferRoots();
    return reader.OneShape();
}

template <class Use> void for_each(const TopoDS_Shape& shape, TopAbs_ShapeEnum type, Use use)
{
    TopTools_IndexedMapOfShape map;
    TopExp::MapShapes(shape, type, map);
    for (int i = 1; i <= map.Extent(); ++i)
        use(map(i));
}

int count(const TopoDS_Shape& shape, TopAbs_ShapeEnum type)
{
    int n = 0;
    for_each(shape, type, [&](const TopoDS_Shape&) { ++n; });
    return n;
}

double largest_tolerance(const TopoDS_Shape& shape)
{
    double t = 0.0;
    for_each(shape, TopAbs_VERTEX, [&](const TopoDS_Shape& s) {
        t = std::max(t, BRep_Tool::Tolerance(TopoDS::Vertex(s)));
    });
    for_each(shape, TopAbs_EDGE, [&](const TopoDS_Shape& s) {
        t = std::max(t, BRep_Tool::Tolerance(TopoDS::Edge(s)));
    });
    for_each(shape, TopAbs_FACE, [&](const TopoDS_Shape& s) {
        t = std::max(t, BRep_Tool::Tolerance(TopoDS::Face(s)));
    });
    return t;
}

void judge(const TopoDS_Shape& shape, const Options& o, nlohmann::json& report)
{
    std::vector<std::string> failed;
    const bool valid = BRepCheck_Analyzer(shape, true).IsValid();
    if (!valid)
        failed.push_back("valid");

    int free_edges = 0, shared_by_more = 0;
    TopTools_IndexedDataMapOfShapeListOfShape faces_of_edge;
    TopExp::MapShapesAndAncestors(shape, TopAbs_EDGE, TopAbs_FACE, faces_of_edge);
    for (int i = 1; i <= faces_of_edge.Extent(); ++i) {
        const int uses = faces_of_edge(i).Extent();
        free_edges += uses < 2;
        shared_by_more += uses > 2;
    }
    bool all_closed = true;
    for_each(shape, TopAbs_SHELL,
             [&](const TopoDS_Shape& s) { all_closed = all_closed && BRep_Tool::IsClosed(s); });
    const int solids = count(shape, TopAbs_SOLID);
    if (o.solids && solids != *o.solids)
        failed.push_back("solids");
    if (o.closed && (!all_closed || free_edges > 0 || shared_by_more > 0))
        failed.push_back("closed");

    // The volume of each solid by itself, so that an inside-out one does not hide behind another.
    std::vector<double> volumes;
    double volume = 0.0;
    for (TopExp_Explorer e(shape, TopAbs_SOLID); e.More(); e.Next()) {
        GProp_GProps properties;
        BRepGProp::VolumeProperties(e.Current(), properties, 1e-9);
        volumes.push_back(properties.Mass());
        volume += properties.Mass();
    }
    if (o.closed && std::any_of(volumes.begin(), volumes.end(), [](double v) { return !(v > 0); }))
        failed.push_back("outward");
    if (o.volume && !(std::fabs(volume - *o.volume) <= o.volume_share * std::fabs(*o.volume)))
        failed.push_back("volume");

    Bnd_Box box;
    BRepBndLib::Add(shape, box, false);
    const double diagonal = std::sqrt(box.SquareExtent());
    const double tolerance = largest_tolerance(shape);
    // Open CASCADE knows no tolerance below its confusion distance.
    if (o.tolerance_share &&
        !(tolerance <= std::max(*o.tolerance_share * diagonal, Precision::Confusion())))
        failed.push_back("tolerance");

    report["valid"] = valid;
    report["solids"] = solids;
    report["shells"] = count(shape, TopAbs_SHELL);
    report["faces"] = count(shape, TopAbs_FACE);
    report["edges"] = count(shape, TopAbs_EDGE);
    report["vertices"] = count(shape, TopAbs_VERTEX);
    report["free_edges"] = free_edges;
    report["nonmanifold_edges"] = shared_by_more;
    report["closed"] = all_closed && free_edges == 0;
    report["volume"] = volume;
    report["volumes"] = volumes;
    report["max_tolerance"] = tolerance;
    report["diagonal"] = diagonal;
    report["failed"] = failed;
}

} // namespace

int main(int argc, char** argv)
{
    const std::optional<Options> options = parse(argc, argv);
    if (!options) {
        std::cerr << "usage: judge_occ FILE [--solids N] [--closed] [--volume V] "
                     "[--volume-share S] [--tolerance-share S]\n";
        return 2;
    }
    Message::DefaultMessenger()->ChangePrinters().Clear();
    nlohmann::json report;
    // The readers of Open CASCADE print complaints to the output that is to be JSON.
    std::ostringstream complaints;
    std::streambuf* const output = std::cout.rdbuf(complaints.rdbuf());
    try {
        const TopoDS_Shape shape = read(options->file, report);
        report["readable"] = !shape.IsNull();
        if (!shape.IsNull())
            judge(shape, *options, report);
    } catch (const Standard_Failure& failure) {
        report["readable"] = false;
        report["exception"] = failure.GetMessageString();
    }
    std::cout.rdbuf(output);
    std::cout << report.dump(1) << "\n";
    if (!report["readable"].get<bool>())
        return 3;
    return report["failed"].empty() ? 0 : 1;
}
