// SPDX-License-Identifier: MIT
#include "io/pcd_header.h"

#include "io/text_scanner.h"

namespace bot2nurbs {

namespace {

//! Far above what any file has; keeps sizes of records from overflowing.
constexpr std::size_t most_values = 1u << 16;

class PcdHeaderReader {
public:
    explicit PcdHeaderReader(const MeshFile& file) : file_(file), text_(file.bytes, '#') {}

    Result<PcdHeader> read()
    {
        while (!text_.at_end()) {
            const std::string_view keyword = text_.word_in_line();
            if (keyword == "DATA")
                return finish();
            if (Status bad = read_line(keyword))
                return *bad;
            text_.skip_line();
        }
        return fail("no line DATA");
    }

private:
    Error fail(const std::string& what) const
    {
        return error_at_line(file_, text_.line(), "PCD header: " + what);
    }

    Status read_line(std::string_view keyword)
    {
        if (keyword == "VERSION")
            return std::nullopt;
        if (keyword == "FIELDS" || keyword == "COLUMNS") {
            while (!text_.at_line_end()) {
                header_.fields.emplace_back();
                header_.fields.back().name = text_.word_in_line();
            }
            return std::nullopt;
        }
        if (keyword == "SIZE")
            return read_each([](PcdField& f, std::size_t value) {
                f.size = value;
                return value == 1 || value == 2 || value == 4 || value == 8;
            });
        if (keyword == "COUNT")
            return read_each([](PcdField& f, std::size_t value) {
                f.count = value;
                return value > 0 && value <= most_values;
            });
        if (keyword == "TYPE") {
            for (PcdField& f : header_.fields) {
                const std::string_view type = text_.word_in_line();
                if (type != "F" && type != "I" && type != "U")
                    return fail("the type of field " + quoted(f.name) + " is " + quoted(type) +
                                ", not F, I or U");
                f.type = type[0];
            }
            return std::nullopt;
        }
        if (keyword == "WIDTH")
            return read_number(width_);
        if (keyword == "HEIGHT")
            return read_number(height_);
        if (keyword == "POINTS") {
            has_points_ = true;
            return read_number(header_.points);
        }
        if (keyword == "VIEWPOINT") {
            Vec3 p; // a quaternion follows
            for (int k = 0; k < 3; ++k)
                if (!text_.number_in_line(p[k]))
                    return fail("VIEWPOINT: " + expected_number(text_.bad_word()));
            if (is_finite(p) && p != Vec3{})
                header_.viewpoint = p;
            return std::nullopt;
        }
        return fail("unknown keyword " + quoted(keyword));
    }

    Status read_number(std::uint64_t& value)
    {
        if (text_.number_in_line(value))
            return std::nullopt;
        return fail(expected_number(text_.bad_word()));
    }

    //! One number a field.
    template <class Set> Status read_each(const Set& set)
    {
        for (PcdField& f : header_.fields) {
            std::size_t value = 0;
            if (!text_.number_in_line(value))
                return fail("field " + quoted(f.name) + ": " + expected_number(text_.bad_word()));
            if (!set(f, value))
                return fail("field " + quoted(f.name) + ": " + std::to_string(value) +
                            " is out of range");
        }
        return std::nullopt;
    }

    Result<PcdHeader> finish()
    {
        const std::string_view data = text_.word_in_line();
        if (data == "ascii")
            header_.data = PcdData::text;
        else if (data == "binary")
            header_.data = PcdData::binary;
        else if (data == "binary_compressed")
            header_.data = PcdData::compressed;
        else
            return fail("unknown kind of DATA " + quoted(data));
        if (header_.fields.empty())
            return fail("no line FIELDS");
        for (PcdField& f : header_.fields) {
            if (f.type == 'F' && f.size < 4)
                return fail("field " + quoted(f.name) + ": a real number has 4 or 8 bytes");
            f.offset = header_.record;
            header_.record += f.size * f.count;
        }
        if (!has_points_) {
            if (width_ > file_.bytes.size() || height_ > file_.bytes.size())
                return fail("the file is too short for its WIDTH and HEIGHT");
            header_.points = width_ * height_;
        }
        // Binary data start right behind this line's end.
        text_.rest_of_line();
        std::size_t at = static_cast<std::size_t>(text_.position() - file_.bytes.data());
        if (at < file_.bytes.size() && file_.bytes[at] == '\r')
            ++at;
        if (at < file_.bytes.size() && file_.bytes[at] == '\n')
            ++at;
        header_.bytes = at;
        header_.lines = text_.line();
        return std::move(header_);
    }

    const MeshFile& file_;
    TextScanner text_;
    PcdHeader header_;
    std::uint64_t width_ = 0, height_ = 1;
    bool has_points_ = false;
};

} // namespace

Result<PcdHeader> read_pcd_header(const MeshFile& file)
{
    return PcdHeaderReader(file).read();
}

} // namespace bot2nurbs
