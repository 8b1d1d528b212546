// SPDX-License-Identifier: MIT
#include "io/mesh_file.h"
#include "io/text_scanner.h"

#include <algorithm>
#include <cstring>

namespace bot2nurbs {

namespace {

constexpr std::size_t header_bytes = 84; // 80 of text and the count
constexpr std::size_t facet_bytes = 50;  // normal, three corners, two bytes of attribute

//! Numbers positions so that those that agree to the bit share a number (minus zero is zero).
//! Open addressing over a table of twice the size needed; no order depends on the hash.
class VertexMerger {
public:
    explicit VertexMerger(std::size_t corners)
    {
        std::size_t size = 64;
        while (size < 2 * corners)
            size *= 2;
        table_.assign(size, invalid_index);
    }

    Index number(Vec3 p)
    {
        // Adding zero turns -0.0 into 0.0.
        p.x += 0.0, p.y += 0.0, p.z += 0.0;
        if (2 * (positions.size() + 1) > table_.size())
            grow();
        Index& slot = table_[find_slot(p)];
        if (slot == invalid_index) {
            slot = static_cast<Index>(positions.size());
            positions.push_back(p);
        }
        return slot;
    }

    std::vector<Vec3> positions;

private:
    static std::uint64_t hash(const Vec3& p)
    {
        std::uint64_t h = 0;
        for (int k = 0; k < 3; ++k) {
            std::uint64_t bits;
            const double x = p[k];
            std::memcpy(&bits, &x, sizeof bits);
            h = (h ^ bits) * 0x9e3779b97f4a7c15ull; // odd, bits well spread: 2^64 / golden ratio
            h ^= h >> 32;
        }
        return h;
    }
    std::size_t find_slot(const Vec3& p) const
    {
        std::size_t i = hash(p) & (table_.size() - 1);
        while (table_[i] != invalid_index && !(positions[table_[i]] == p))
            i = (i + 1) & (table_.size() - 1);
        return i;
    }
    void grow()
    {
        table_.assign(2 * table_.size(), invalid_index);
        for (std::size_t v = 0; v < positions.size(); ++v)
            table_[find_slot(positions[v])] = static_cast<Index>(v);
    }

    std::vector<Index> table_;
};

float read_float(const char* p)
{
    std::uint32_t bits = 0;
    for (int i = 3; i >= 0; --i)
        bits = bits << 8 | static_cast<unsigned char>(p[i]);
    float value;
    std::memcpy(&value, &bits, sizeof value);
    return value;
}

std::uint32_t facet_count(std::string_view bytes)
{
    std::uint32_t count = 0;
    for (int i = 3; i >= 0; --i)
        count = count << 8 | static_cast<unsigned char>(bytes[80 + i]);
    return count;
}

Error not_finite(const MeshFile& file, std::size_t facet, const std::string& where)
{
    return {ErrorCode::bad_geometry,
            file.name + ", " + where + ": facet " + std::to_string(facet) +
                " has a coordinate that is not finite",
            static_cast<Index>(facet)};
}

Result<PolygonMesh> read_binary(const MeshFile& file, Context& context)
{
    const std::string_view bytes = file.bytes;
    if (bytes.size() < header_bytes)
        return Error{ErrorCode::cannot_read,
                     file.name + ": not an STL file (" + std::to_string(bytes.size()) + " bytes)",
                     invalid_index};
    const std::size_t count = facet_count(bytes);
    const std::size_t complete = (bytes.size() - header_bytes) / facet_bytes;
    if (count > complete)
        return error_at_byte(file, 80,
                             "the file promises " + std::to_string(count) + " facets, but has " +
                                 std::to_string(complete) +
                                 " (truncated, or not an STL file at all)");
    if (bytes.size() > header_bytes + count * facet_bytes)
        context.log(LogLevel::warning,
                    file.name + ": ignored " +
                        std::to_string(bytes.size() - header_bytes - count * facet_bytes) +
                        " bytes behind the last facet");
    VertexMerger merger(3 * count);
    PolygonList polygons;
    polygons.corners.reserve(3 * count);
    polygons.first.reserve(count + 1);
    for (std::size_t f = 0; f < count; ++f) {
        if (f % elements_per_poll == 0 && context.cancelled())
            return Context::cancelled_error("read");
        const std::size_t start = header_bytes + f * facet_bytes;
        for (std::size_t k = 1; k <= 3; ++k) {
            const char* p = bytes.data() + start + 12 * k;
            const Vec3 corner{read_float(p), read_float(p + 4), read_float(p + 8)};
            if (!is_finite(corner))
                return not_finite(file, f, "byte " + std::to_string(start + 12 * k));
            polygons.corners.push_back(merger.number(corner));
        }
        polygons.close();
    }
    return PolygonMesh{std::move(merger.positions), std::move(polygons)};
}

//! The word in lower case: some writers use capitals.
std::string lower(std::string_view word)
{
    std::string text(word.substr(0, 16)); // longer than any keyword
    for (char& c : text)
        if (c >= 'A' && c <= 'Z')
            c = static_cast<char>(c - 'A' + 'a');
    return text;
}

Result<PolygonMesh> read_text(const MeshFile& file, Context& context)
{
    TextScanner text(file.bytes, 0);
    VertexMerger merger(3 * (file.bytes.size() / 200)); // a facet takes about 200 characters
    PolygonList polygons;
    bool in_facet = false, in_loop = false, in_solid = false;
    std::size_t corners = 0;
    const auto fail = [&](const std::string& what) {
        return error_at_line(file, text.line(),
                             "facet " + std::to_string(polygons.size()) + ": " + what,
                             static_cast<Index>(polygons.size()));
    };
    while (!text.at_end()) {
        const std::string_view raw = text.word_in_line();
        // "vertex" is by far the most frequent word.
        const std::string word = raw == "vertex" ? "vertex" : lower(raw);
        if (word == "vertex") {
            Vec3 p;
            if (!in_loop)
                return fail("a vertex outside of a loop");
            if (++corners > 3)
                return fail("a loop with more than three vertices");
            if (!text.number_in_line(p.x) || !text.number_in_line(p.y) || !text.number_in_line(p.z))
                return fail("vertex: " + expected_number(text.bad_word()));
            if (!is_finite(p))
                return not_finite(file, polygons.size(), "line " + std::to_string(text.line()));
            polygons.corners.push_back(merger.number(p));
        } else if (word == "facet") {
            if (in_facet)
                return fail("a facet starts before the one before it has ended");
            in_facet = true;
            text.skip_line(); // the normal, which the corners give better
        } else if (word == "outer") {
            if (!in_facet || in_loop || lower(text.word_in_line()) != "loop")
                return fail("\"outer loop\" is out of place");
            in_loop = true;
            corners = 0;
        } else if (word == "endloop") {
            if (!in_loop || corners != 3)
                return fail("a loop with " + std::to_string(corners) + " vertices");
            in_loop = false;
        } else if (word == "endfacet") {
            if (!in_facet || in_loop || corners != 3)
                return fail("a facet without a complete loop");
            in_facet = false;
            corners = 0;
            polygons.close();
            if (polygons.size() % elements_per_poll == 0 && context.cancelled())
                return Context::cancelled_error("read");
        } else if (word == "solid" || word == "endsolid") {
            if (in_facet)
                return fail(quoted(word) + " inside of a facet");
            in_solid = word == "solid";
            text.skip_line(); // the name
        } else {
            return fail("expected a keyword of text STL, found " + quoted(raw));
        }
    }
    if (in_facet)
        return fail("the file ends inside of a facet");
    if (in_solid)
        context.log(LogLevel::warning,
                    file.name + ": no \"endsolid\" at the end; the file may be cut off");
    return PolygonMesh{std::move(merger.positions), std::move(polygons)};
}

} // namespace

Result<PolygonMesh> read_stl(const MeshFile& file, Context& context)
{
    const std::string_view bytes = file.bytes;
    // Binary files may start with "solid", so their size decides first: no text can fit, as four
    // printable characters make a count of 5e8 and more.
    if (bytes.size() >= header_bytes &&
        bytes.size() == header_bytes + std::size_t{facet_count(bytes)} * facet_bytes)
        return read_binary(file, context);
    TextScanner text(bytes, 0);
    const bool binary = bytes.substr(0, 1024).find('\0') != std::string_view::npos;
    if (!binary && lower(text.word()) == "solid")
        return read_text(file, context);
    return read_binary(file, context);
}

} // namespace bot2nurbs
