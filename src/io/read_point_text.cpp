// SPDX-License-Identifier: MIT
#include "io/point_columns.h"
#include "io/text_scanner.h"

#include <algorithm>
#include <cmath>

namespace bot2nurbs {

namespace {

bool separates(char c)
{
    return c == ',' || c == ';';
}

//! The first line that is neither empty nor a comment.
std::string_view first_line(std::string_view bytes)
{
    TextScanner text(bytes, '#');
    return text.at_end() ? std::string_view() : text.rest_of_line();
}

//! Whether commas stand inside words that blanks or semicolons separate, as in "1,5 2,5": then they
//! are decimal commas, and reading them as separators would give numbers that are not in the file.
bool has_decimal_commas(std::string_view line)
{
    std::size_t words = 0;
    bool inside = false;
    for (std::size_t i = 0; i < line.size();) {
        const std::size_t start = line.find_first_not_of(" \t;", i);
        if (start == std::string_view::npos)
            break;
        const std::size_t end = std::min(line.find_first_of(" \t;", start), line.size());
        const std::string_view word = line.substr(start, end - start);
        const std::size_t comma = word.find(',');
        inside = inside || (comma != std::string_view::npos && comma + 1 < word.size());
        ++words;
        i = end;
    }
    return inside && words > 1;
}

//! The fields that a heading names; empty when it does not name x, y and z.
std::vector<std::optional<PointField>> read_heading(std::string_view line)
{
    std::vector<std::optional<PointField>> columns;
    TextScanner words(line, 0);
    while (!words.at_line_end())
        columns.push_back(point_field(words.word_in_line()));
    for (const PointField f : {PointField::x, PointField::y, PointField::z})
        if (std::find(columns.begin(), columns.end(), f) == columns.end())
            return {};
    return columns;
}

class PointTextReader {
public:
    PointTextReader(const MeshFile& file, std::string_view bytes, Context& context)
        : file_(file), text_(bytes, '#'), context_(context)
    {
    }

    Result<PointCloud> read()
    {
        while (!text_.at_end()) {
            if (rows_.size() % elements_per_poll == 0 && context_.cancelled())
                return Context::cancelled_error("read");
            if (Status bad = read_line())
                return *bad;
        }
        if (promised_ > 0)
            return fail("the file ends " + std::to_string(promised_) + " points too early");
        if (rows_.size() == 0)
            return Error{ErrorCode::empty_input, file_.name + ": no points", invalid_index};
        return make_cloud();
    }

private:
    Error fail(const std::string& what) const
    {
        return error_at_line(file_, text_.line(), what, static_cast<Index>(rows_.size()));
    }

    //! Whether the word that comes next can be a number; "nan" is one.
    bool starts_number() const
    {
        const std::string_view rest(text_.position(), text_.bytes_left());
        return std::string_view("0123456789+-.").find(rest[0]) != std::string_view::npos ||
               rest.substr(0, 3) == "nan" || rest.substr(0, 3) == "NaN";
    }

    Status read_line()
    {
        if (rows_.size() == 0 && !counted_ && !starts_number())
            return read_names();
        row_.clear();
        double value = 0.0;
        while (!text_.at_line_end()) {
            if (!text_.number_in_line(value)) {
                if (rows_.size() == 0 && !counted_ && row_.empty())
                    return fail("expected a point or the names of columns, found " +
                                quoted(text_.bad_word()));
                return fail("point " + std::to_string(rows_.size() + 1) + ": " +
                            expected_number(text_.bad_word()));
            }
            row_.push_back(value);
        }
        return row_.size() == 1 ? read_count() : add_row();
    }

    //! A heading, maybe behind "//".
    Status read_names()
    {
        const std::string_view line = text_.rest_of_line();
        const bool comment = line.substr(0, 2) == "//";
        std::vector<std::optional<PointField>> columns =
            read_heading(comment ? line.substr(2) : line);
        if (!columns.empty())
            names_ = std::move(columns);
        else if (!comment)
            return fail("expected a point or the names of columns, found " + quoted(line));
        return std::nullopt;
    }

    //! A number of points stands before them, once or before each part of the file.
    Status read_count()
    {
        if (promised_ > 0 || (rows_.size() > 0 && !counted_) || row_[0] != std::floor(row_[0]) ||
            row_[0] < 0.0 || row_[0] > static_cast<double>(file_.bytes.size()))
            return fail("point " + std::to_string(rows_.size() + 1) + " has a single number");
        counted_ = true;
        promised_ = static_cast<std::uint64_t>(row_[0]);
        return std::nullopt;
    }

    Status add_row()
    {
        if (counted_ && promised_ == 0)
            return fail("more points than the file promises");
        if (counted_)
            --promised_;
        if (rows_.size() == 0) {
            if (row_.size() < 3)
                return fail("a point has " + std::to_string(row_.size()) +
                            " numbers; it needs three coordinates");
            rows_.columns = row_.size();
        }
        if (row_.size() != rows_.columns)
            return fail("point " + std::to_string(rows_.size() + 1) + " has " +
                        std::to_string(row_.size()) + " numbers, the points before it " +
                        std::to_string(rows_.columns));
        rows_.values.insert(rows_.values.end(), row_.begin(), row_.end());
        return std::nullopt;
    }

    Result<PointCloud> make_cloud()
    {
        if (!names_.empty() && names_.size() != rows_.columns)
            return Error{ErrorCode::cannot_read,
                         file_.name + ": the heading names " + std::to_string(names_.size()) +
                             " columns, but points have " + std::to_string(rows_.columns) +
                             " numbers",
                         invalid_index};
        const auto columns = names_.empty() ? guess_columns(rows_) : names_;
        PointTable table;
        table.real_colors = true;
        std::string unknown;
        for (std::size_t c = 0; c < columns.size(); ++c) {
            if (!columns[c]) {
                unknown += (unknown.empty() ? "" : ", ") + std::to_string(c + 1);
                continue;
            }
            std::vector<double>& column = table[*columns[c]];
            if (!column.empty())
                continue; // named twice: the first counts
            column.resize(rows_.size());
            for (std::size_t r = 0; r < rows_.size(); ++r)
                column[r] = rows_.at(r, c);
        }
        if (!unknown.empty())
            context_.log(LogLevel::info,
                         file_.name + ": left out columns of unknown meaning: " + unknown);
        return table_to_cloud(file_, std::move(table));
    }

    const MeshFile& file_;
    TextScanner text_;
    Context& context_;
    std::vector<std::optional<PointField>> names_;
    NumberRows rows_;
    std::vector<double> row_;
    bool counted_ = false;
    std::uint64_t promised_ = 0; //!< Points still to come.
};

} // namespace

Result<PointCloud> read_point_text(const MeshFile& file, Context& context)
{
    if (const std::size_t zero = file.bytes.find('\0'); zero != std::string_view::npos)
        return error_at_byte(file, zero, "not text, so not a file of columns");
    const std::string_view line = first_line(file.bytes);
    if (has_decimal_commas(line))
        return Error{ErrorCode::cannot_read,
                     file.name + ": numbers with decimal commas (" + quoted(line) +
                         ") are not read; save them with decimal points",
                     invalid_index};
    if (std::none_of(line.begin(), line.end(), separates))
        return PointTextReader(file, file.bytes, context).read();
    std::string text(file.bytes);
    std::replace_if(text.begin(), text.end(), separates, ' ');
    return PointTextReader(file, text, context).read();
}

} // namespace bot2nurbs
