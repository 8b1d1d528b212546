// SPDX-License-Identifier: MIT
#include "io/point_table.h"
#include "io/text_scanner.h"

namespace bot2nurbs {

// A vertex may carry a colour behind its coordinates (x y z r g b). Normals are numbered apart from
// vertices; without faces to pair them, as many normals as vertices are those of the vertices.
Result<PointCloud> read_obj_points(const MeshFile& file, Context& context)
{
    TextScanner text(file.bytes, '#');
    PointTable table;
    table.real_colors = true;
    const auto read_triple = [&](PointField first, const char* what) -> Status {
        const std::size_t number = table[first].size() + 1;
        for (int k = 0; k < 3; ++k) {
            double value = 0.0;
            if (!text.number_in_line(value))
                return error_at_line(file, text.line(),
                                     what + std::to_string(number) + ": " +
                                         expected_number(text.bad_word()),
                                     static_cast<Index>(number - 1));
            table[static_cast<PointField>(static_cast<int>(first) + k)].push_back(value);
        }
        return std::nullopt;
    };
    bool colored = true;
    for (std::size_t statement = 0; !text.at_end(); ++statement) {
        if (statement % elements_per_poll == 0 && context.cancelled())
            return Context::cancelled_error("read");
        const std::string_view keyword = text.word_in_line();
        Status bad;
        if (keyword == "v") {
            bad = read_triple(PointField::x, "vertex ");
            // Of four numbers the last is a weight.
            double rest[3] = {};
            int found = 0;
            while (colored && found < 3 && text.number_in_line(rest[found]))
                ++found;
            colored = colored && found == 3;
            for (int k = 0; colored && k < 3; ++k)
                table[static_cast<PointField>(static_cast<int>(PointField::red) + k)].push_back(
                    rest[k]);
        } else if (keyword == "vn") {
            bad = read_triple(PointField::nx, "normal ");
        }
        if (bad)
            return *bad;
        text.skip_line();
    }
    if (table[PointField::x].empty())
        return Error{ErrorCode::empty_input, file.name + ": no vertices", invalid_index};
    if (table[PointField::nx].size() != table[PointField::x].size()) {
        if (!table[PointField::nx].empty())
            context.log(LogLevel::warning,
                        file.name + ": " + std::to_string(table[PointField::nx].size()) +
                            " normals for " + std::to_string(table[PointField::x].size()) +
                            " vertices were left out");
        table[PointField::nx].clear();
    }
    if (!colored)
        table[PointField::red].clear();
    return table_to_cloud(file, std::move(table));
}

} // namespace bot2nurbs
