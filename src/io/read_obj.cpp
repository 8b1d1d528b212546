// SPDX-License-Identifier: MIT
#include "io/mesh_file.h"
#include "io/text_scanner.h"

namespace bot2nurbs {

namespace {

//! A face corner that named a vertex the file had not listed yet.
struct ForwardReference {
    std::size_t line = 0;
    std::uint64_t vertex = 0;
    Index face = 0;
};

//! The text with each backslash at the end of a line, and that end, turned into blanks: a
//! statement may go on in the next line. Keeps the length; line numbers then lag by the joined
//! lines, so it is done only for files that need it.
std::string joined_lines(std::string_view bytes)
{
    std::string text(bytes);
    for (std::size_t i = text.find('\\'); i != std::string::npos; i = text.find('\\', i + 1)) {
        std::size_t end = i + 1;
        if (end < text.size() && text[end] == '\r')
            ++end;
        if (end < text.size() && text[end] == '\n')
            ++end;
        if (end > i + 1)
            text.replace(i, end - i, end - i, ' ');
    }
    return text;
}

class ObjReader {
public:
    ObjReader(const MeshFile& file, std::string_view bytes, Context& context)
        : file_(file), text_(bytes, '#'), context_(context)
    {
    }

    Result<PolygonMesh> read()
    {
        for (std::size_t statement = 0; !text_.at_end(); ++statement) {
            if (statement % elements_per_poll == 0 && context_.cancelled())
                return Context::cancelled_error("read");
            const std::string_view keyword = text_.word_in_line();
            Status bad;
            if (keyword == "v")
                bad = read_vertex();
            else if (keyword == "f" || keyword == "fo")
                bad = read_face();
            if (bad)
                return *bad;
            text_.skip_line();
        }
        if (positions_.empty() && polygons_.size() == 0)
            return Error{ErrorCode::cannot_read,
                         file_.name + ": no vertices and no faces; it is not an OBJ file",
                         invalid_index};
        for (const ForwardReference& r : forward_)
            if (r.vertex > positions_.size())
                return out_of_range(r.line, r.face, std::to_string(r.vertex));
        return PolygonMesh{std::move(positions_), std::move(polygons_)};
    }

private:
    Status read_vertex()
    {
        Vec3 p;
        if (!text_.number_in_line(p.x) || !text_.number_in_line(p.y) || !text_.number_in_line(p.z))
            return error_at_line(file_, text_.line(),
                                 "vertex " + std::to_string(positions_.size() + 1) + ": " +
                                     expected_number(text_.bad_word()),
                                 static_cast<Index>(positions_.size()));
        positions_.push_back(p); // a weight or a colour may follow
        return std::nullopt;
    }

    Status read_face()
    {
        const Index face = static_cast<Index>(polygons_.size());
        while (!text_.at_line_end()) {
            const std::string_view word = text_.word_in_line();
            std::int64_t v = 0;
            // vertex, vertex/texture, vertex//normal, vertex/texture/normal
            const std::string_view index = word.substr(0, word.find('/'));
            const auto [after, error] =
                std::from_chars(index.data(), index.data() + index.size(), v);
            if (error != std::errc() || after != index.data() + index.size())
                return error_at_line(file_, text_.line(),
                                     "face " + std::to_string(face + 1) +
                                         ": expected a vertex number, found " + quoted(word),
                                     face);
            // Negative numbers count back from the vertices so far.
            const std::int64_t so_far = static_cast<std::int64_t>(positions_.size());
            const std::int64_t vertex = v < 0 ? so_far + v : v - 1;
            if (vertex < 0 || vertex >= static_cast<std::int64_t>(invalid_index))
                return out_of_range(text_.line(), face, std::to_string(v));
            if (vertex >= so_far)
                forward_.push_back({text_.line(), static_cast<std::uint64_t>(v), face});
            polygons_.corners.push_back(static_cast<Index>(vertex));
        }
        polygons_.close();
        return std::nullopt;
    }

    Error out_of_range(std::size_t line, Index face, const std::string& vertex) const
    {
        return error_at_line(file_, line,
                             "face " + std::to_string(face + 1) + ": vertex " + vertex +
                                 " is out of range (the file has " +
                                 std::to_string(positions_.size()) + ")",
                             face);
    }

    const MeshFile& file_;
    TextScanner text_;
    Context& context_;
    std::vector<Vec3> positions_;
    PolygonList polygons_;
    std::vector<ForwardReference> forward_;
};

} // namespace

Result<PolygonMesh> read_obj(const MeshFile& file, Context& context)
{
    if (file.bytes.find('\0') != std::string_view::npos)
        return error_at_byte(file, file.bytes.find('\0'), "not text, so not an OBJ file");
    if (file.bytes.find('\\') == std::string_view::npos)
        return ObjReader(file, file.bytes, context).read();
    const std::string text = joined_lines(file.bytes);
    return ObjReader(file, text, context).read();
}

} // namespace bot2nurbs
