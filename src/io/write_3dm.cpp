// SPDX-License-Identifier: MIT
#include "bot2nurbs/write_brep.h"

#include "io/archive_3dm.h"
#include "io/atomic_file.h"
#include "io/write_checks.h"

#include <limits>

namespace bot2nurbs {

namespace {

namespace code {
constexpr std::uint32_t comment = 0x00000001, end_of_file = 0x00007FFF, end_of_table = 0xFFFFFFFF;
constexpr std::uint32_t properties = 0x10000014, writer_stamp = 0xA0000026,
                        application = 0x20008024;
constexpr std::uint32_t settings = 0x10000015, units = 0x20008031, current_layer = 0xA0000038;
constexpr std::uint32_t bitmaps = 0x10000016, texture_mappings = 0x10000025, materials = 0x10000010,
                        linetypes = 0x10000023, layers = 0x10000011, groups = 0x10000018,
                        fonts = 0x10000019, dimstyles = 0x10000020, lights = 0x10000012,
                        hatches = 0x10000022, instances = 0x10000021, objects = 0x10000013,
                        history = 0x10000026;
constexpr std::uint32_t layer_record = 0x20008050, object_record = 0x20008070,
                        object_type = 0x82000071, object_attributes = 0x02008072,
                        object_end = 0x8200007F;
constexpr std::uint32_t class_begin = 0x00027FFA, class_uuid = 0x0002FFFB, class_data = 0x0002FFFC,
                        class_end = 0x80027FFF;
constexpr std::uint32_t anonymous = 0x40008000;
} // namespace code

constexpr const char* layer_class = "95809813-E985-11D3-BFE5-0010830122F0";
constexpr const char* brep_class = "60B5DBC5-E660-11D3-BFE4-0010830122F0";
constexpr const char* surface_class = "4ED7D4DE-E947-11D3-BFE5-0010830122F0";
constexpr const char* curve_class = "4ED7D4DD-E947-11D3-BFE5-0010830122F0";
constexpr const char* line_class = "4ED7D4DB-E947-11D3-BFE5-0010830122F0";
// Of the one layer all objects are on; any fixed number will do.
constexpr const char* layer_id = "6F2D1F64-8E0B-4C31-9C53-0B07B2A5D1E7";

// The writer stamp is the date of the openNURBS whose layout is written: readers choose by it how
// to read. The two kinds are for archives up to 50 and above.
constexpr std::int64_t stamp_by_date = 201210245, stamp_by_version = 2419101192;

// What openNURBS stores where it has no number.
constexpr double unset_real = -1.23432101234321e+308;

// Version of a class's data: major in the high half of a byte, minor in the low.
constexpr int chunk_version(int major, int minor)
{
    return major * 16 + minor;
}

constexpr int object_is_brep = 16, outer_loop = 1, solid_outward = 1, solid_unknown = 0;

//! openNURBS' number of a length unit and its length in metres.
struct ArchiveUnit {
    int number;
    double metres;
};

ArchiveUnit archive_unit(const std::string& name)
{
    if (name == "um")
        return {1, 1e-6};
    if (name == "cm")
        return {3, 1e-2};
    if (name == "m")
        return {4, 1.0};
    if (name == "km")
        return {5, 1e3};
    if (name == "in")
        return {8, 0.0254};
    if (name == "ft")
        return {9, 0.3048};
    if (name == "mi")
        return {10, 1609.344};
    return {2, 1e-3};
}

//! An id that depends on the bytes and a number alone.
Uuid content_id(std::string_view bytes, std::uint64_t salt)
{
    // Two FNV-1a sums with different starts, mixed so that every bit counts.
    std::array<std::uint64_t, 2> sum{0xcbf29ce484222325u, 0x9ae16a3b2f90404fu};
    for (std::uint64_t& s : sum) {
        s ^= salt * 0x9e3779b97f4a7c15u;
        for (char c : bytes)
            s = (s ^ static_cast<std::uint8_t>(c)) * 0x100000001b3u;
        s = (s ^ (s >> 30)) * 0xbf58476d1ce4e5b9u;
        s = (s ^ (s >> 27)) * 0x94d049bb133111ebu;
        s ^= s >> 31;
    }
    Uuid id{};
    for (int i = 0; i < 16; ++i)
        id[i] = static_cast<std::uint8_t>(sum[i / 8] >> (8 * (i % 8)));
    id[7] = static_cast<std::uint8_t>((id[7] & 0x0F) | 0x80); // version 8: made by the application
    id[8] = static_cast<std::uint8_t>((id[8] & 0x3F) | 0x80); // variant of RFC 9562
    return id;
}

template <class Body> void chunk(ArchiveWriter& out, std::uint32_t typecode, Body body)
{
    out.begin(typecode);
    body();
    out.end();
}

template <class Body> void table(ArchiveWriter& out, std::uint32_t typecode, Body body)
{
    chunk(out, typecode, [&] {
        body();
        out.short_chunk(code::end_of_table, 0);
    });
}

//! Wraps an object's data with the id of its class.
template <class Body> void object(ArchiveWriter& out, const char* class_id, Body body)
{
    chunk(out, code::class_begin, [&] {
        chunk(out, code::class_uuid, [&] { out.uuid(uuid_from_text(class_id)); });
        chunk(out, code::class_data, body);
        out.short_chunk(code::class_end, 0);
    });
}

//! An array inside a B-Rep: version, count, elements.
template <class List, class Element>
void array(ArchiveWriter& out, int version, const List& list, Element element)
{
    chunk(out, code::anonymous, [&] {
        out.byte(version);
        out.int32(static_cast<std::int64_t>(list.size()));
        for (Index i = 0; i < list.size(); ++i)
            element(i);
    });
}

void write_line(ArchiveWriter& out, const BrepCurve2& line)
{
    object(out, line_class, [&] {
        out.byte(chunk_version(1, 0));
        out.point(Vec3{line.a.x, line.a.y, 0.0});
        out.point(Vec3{line.b.x, line.b.y, 0.0});
        out.interval(line.t0, line.t1);
        out.int32(2);
    });
}

void write_curve(ArchiveWriter& out, const BrepCurve3& curve)
{
    object(out, curve_class, [&] {
        out.byte(chunk_version(1, 0));
        out.int32(3);
        out.int32(0); // not rational
        out.int32(curve.order);
        out.int32(static_cast<std::int64_t>(curve.control.size()));
        out.zeros(8);
        out.box({});
        out.int32(static_cast<std::int64_t>(curve.knots.size()));
        out.reals(curve.knots);
        out.int32(static_cast<std::int64_t>(curve.control.size()));
        for (const Vec3& p : curve.control)
            out.point(p);
    });
}

void write_surface(ArchiveWriter& out, const BsplinePatch& patch)
{
    constexpr int order = 4;
    object(out, surface_class, [&] {
        out.byte(chunk_version(1, 0));
        out.int32(3);
        out.int32(0); // not rational
        out.int32(order);
        out.int32(order);
        out.int32(patch.size);
        out.int32(patch.size);
        out.zeros(8);
        out.box({});
        for (int direction = 0; direction < 2; ++direction) {
            out.int32(static_cast<std::int64_t>(patch.knots.size()));
            out.reals(patch.knots);
        }
        out.int32(static_cast<std::int64_t>(patch.control.size()));
        for (const Vec3& p : patch.control)
            out.point(p);
    });
}

template <class List, class Write>
void object_array(ArchiveWriter& out, const List& list, Write write)
{
    array(out, chunk_version(1, 0), list, [&](Index i) {
        out.int32(1); // the element is there
        write(out, list[i]);
    });
}

void write_edge(ArchiveWriter& out, const BrepEdge& edge)
{
    out.int32(edge.curve);
    out.int32(0); // the edge runs along its curve
    out.interval(edge.t0, edge.t1);
    out.int32(edge.vertex[0]);
    out.int32(edge.vertex[1]);
    out.index_list(edge.trims);
    out.real(0.0); // tolerance: the edge is the faces' side
    out.interval(edge.t0, edge.t1);
}

void write_trim(ArchiveWriter& out, const BrepTrim& trim)
{
    out.int32(trim.curve);
    out.interval(trim.t0, trim.t1);
    out.int32(trim.type == TrimType::singular ? -1 : static_cast<std::int64_t>(trim.edge));
    out.int32(trim.vertex[0]);
    out.int32(trim.vertex[1]);
    out.int32(trim.reversed ? 1 : 0);
    out.int32(static_cast<int>(trim.type));
    out.int32(static_cast<int>(trim.iso));
    out.int32(trim.loop);
    out.real(0.0); // tolerances in u and v
    out.real(0.0);
    out.interval(trim.t0, trim.t1);
    out.zeros(8 + 24);
    out.real(unset_real); // tolerances of old releases, in the plane and in space
    out.real(unset_real);
}

void write_brep(ArchiveWriter& out, const Brep& brep)
{
    const bool with_regions = out.version() >= 60;
    const bool with_colors = out.version() >= 70;
    const int plain = chunk_version(1, 0);
    out.byte(chunk_version(3, with_regions ? 3 : 2));
    object_array(out, brep.curves2, write_line);
    object_array(out, brep.curves3, write_curve);
    object_array(out, brep.surfaces, write_surface);
    array(out, plain, brep.vertices, [&](Index i) {
        out.int32(i);
        out.point(brep.vertices[i].point);
        out.index_list(brep.vertices[i].edges);
        out.real(0.0);
    });
    array(out, plain, brep.edges, [&](Index i) {
        out.int32(i);
        write_edge(out, brep.edges[i]);
    });
    array(out, plain, brep.trims, [&](Index i) {
        out.int32(i);
        write_trim(out, brep.trims[i]);
    });
    array(out, plain, brep.loops, [&](Index i) {
        out.int32(i);
        out.index_list(brep.loops[i].trims);
        out.int32(outer_loop);
        out.int32(brep.loops[i].face);
    });
    chunk(out, code::anonymous, [&] {
        out.byte(chunk_version(1, with_colors ? 2 : 1));
        out.int32(static_cast<std::int64_t>(brep.faces.size()));
        for (Index i = 0; i < brep.faces.size(); ++i) {
            out.int32(i);
            out.index_list(brep.faces[i].loops);
            out.int32(brep.faces[i].surface);
            out.int32(brep.faces[i].reversed ? 1 : 0);
            out.int32(0); // material channel
        }
        for (std::size_t i = 0; i < brep.faces.size(); ++i)
            out.zeros(16); // face id
        if (with_colors)
            out.byte(0); // no face has a colour of its own
    });
    Box3 box;
    for (const BsplinePatch& s : brep.surfaces) {
        for (const Vec3& p : s.control)
            box.add(p);
    }
    out.box(box);
    const int faces = static_cast<int>(brep.faces.size());
    chunk(out, code::anonymous, [&] { out.zeros(faces); }); // no render meshes
    chunk(out, code::anonymous, [&] { out.zeros(faces); }); // no analysis meshes
    out.int32(brep.solid ? solid_outward : solid_unknown);
    if (with_regions) {
        chunk(out, code::anonymous, [&] { // no region topology
            out.int32(1);
            out.int32(1);
            out.byte(0);
        });
    }
}

void write_attributes(ArchiveWriter& out, const Uuid& id, const std::string& name)
{
    if (out.version() >= 50) {
        out.byte(chunk_version(2, 0));
        out.uuid(id);
        out.int32(0); // layer
        if (!name.empty()) {
            out.byte(1); // the next item is the name
            out.wide_string(name);
        }
        out.byte(0); // no more items
        return;
    }
    out.byte(chunk_version(1, 0));
    out.uuid(id);
    out.int32(0);  // layer
    out.int32(-1); // material
    out.zeros(4);  // color
    out.zeros(4);  // line style
    out.real(0.0);
    out.real(1.0);
    out.int32(1); // wires
    out.zeros(4); // mode; color, linetype and material are the layer's
    out.wide_string(name);
    out.wide_string("");
}

void write_layer(ArchiveWriter& out)
{
    chunk(out, code::layer_record, [&] {
        object(out, layer_class, [&] {
            out.byte(chunk_version(1, 5));
            out.int32(0);  // mode: normal
            out.int32(0);  // index
            out.int32(-1); // IGES level
            out.int32(-1); // material
            out.int32(0);
            out.zeros(4); // color: black
            out.int16(0);
            out.int16(0);
            out.real(0.0);
            out.real(1.0);
            out.wide_string("Default");
            out.byte(1);   // visible
            out.int32(-1); // linetype
            out.zeros(4);  // plot color
            out.real(0.0); // plot weight
            out.byte(0);   // not locked
            out.uuid(uuid_from_text(layer_id));
        });
    });
}

void write_properties(ArchiveWriter& out)
{
    table(out, code::properties, [&] {
        out.short_chunk(code::writer_stamp, out.version() <= 50 ? stamp_by_date : stamp_by_version);
        chunk(out, code::application, [&] {
            out.byte(chunk_version(1, 0));
            out.wide_string("bot2nurbs");
            out.wide_string("");
            out.wide_string("");
        });
    });
}

void write_settings(ArchiveWriter& out, const ArchiveUnit& unit)
{
    // Rhino's own defaults for new models.
    constexpr double absolute_tolerance = 0.001, angle_tolerance = 0.017453292519943295,
                     relative_tolerance = 0.01;
    table(out, code::settings, [&] {
        chunk(out, code::units, [&] {
            out.int32(102);
            out.int32(unit.number);
            out.real(absolute_tolerance);
            out.real(angle_tolerance);
            out.real(relative_tolerance);
            out.int32(0); // show decimals
            out.int32(3); // of this number
            out.real(unit.metres);
            out.wide_string("");
        });
        out.short_chunk(code::current_layer, 0);
    });
}

} // namespace

Result<std::string> brep_to_3dm(const std::vector<Brep>& breps, const WriteOptions& options)
{
    if (Status error = check_writable(breps, options))
        return *error;
    ArchiveWriter out(options.archive_version);
    std::string version = std::to_string(options.archive_version);
    version.insert(0, 8 - version.size(), ' ');
    out.text("3D Geometry File Format " + version);
    chunk(out, code::comment, [&] { out.text(std::string_view("bot2nurbs\x1A\0", 11)); });
    write_properties(out);
    write_settings(out, archive_unit(options.units));
    const auto empty = [] {};
    for (std::uint32_t t :
         {code::bitmaps, code::texture_mappings, code::materials, code::linetypes})
        table(out, t, empty);
    table(out, code::layers, [&] { write_layer(out); });
    for (std::uint32_t t :
         {code::groups, code::fonts, code::dimstyles, code::lights, code::hatches, code::instances})
        table(out, t, empty);
    table(out, code::objects, [&] {
        for (std::size_t i = 0; i < breps.size(); ++i) {
            chunk(out, code::object_record, [&] {
                out.short_chunk(code::object_type, object_is_brep);
                const std::size_t start = out.bytes().size();
                object(out, brep_class, [&] { write_brep(out, breps[i]); });
                const Uuid id = content_id(std::string_view(out.bytes()).substr(start), i);
                chunk(out, code::object_attributes,
                      [&] { write_attributes(out, id, breps[i].name); });
                out.short_chunk(code::object_end, 0);
            });
        }
    });
    table(out, code::history, empty);
    // The end mark holds the size of the file with the end mark itself.
    const std::size_t width = options.archive_version >= 50 ? 8 : 4;
    const std::uint64_t size = out.bytes().size() + 4 + 2 * width;
    if (width == 4 && size > std::numeric_limits<std::uint32_t>::max()) {
        return Error{ErrorCode::bad_option,
                     "archive version 4 holds at most 4 GiB; choose 50 or later", invalid_index};
    }
    chunk(out, code::end_of_file, [&] {
        out.int32(static_cast<std::int64_t>(size & 0xFFFFFFFFu));
        if (width == 8)
            out.int32(static_cast<std::int64_t>(size >> 32));
    });
    return out.take();
}

Status write_3dm(const std::vector<Brep>& breps, const std::string& path,
                 const WriteOptions& options)
{
    const Result<std::string> bytes = brep_to_3dm(breps, options);
    return bytes ? write_whole_file(path, *bytes) : Status(bytes.error());
}

} // namespace bot2nurbs
