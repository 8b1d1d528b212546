// SPDX-License-Identifier: MIT
#include "io/off_header.h"
#include "io/point_table.h"

namespace bot2nurbs {

Result<PointCloud> read_off_points(const MeshFile& file, Context& context)
{
    TextScanner text(file.bytes, '#');
    const Result<OffHeader> header = read_off_header(file, text);
    if (!header)
        return header.error();
    std::vector<PointField> fields{PointField::x, PointField::y, PointField::z};
    if (header->normals)
        fields.insert(fields.end(), {PointField::nx, PointField::ny, PointField::nz});
    if (header->colors)
        fields.insert(fields.end(), {PointField::red, PointField::green, PointField::blue});
    PointTable table;
    table.real_colors = true;
    for (const PointField f : fields)
        table[f].reserve(header->vertices);
    for (std::size_t v = 0; v < header->vertices; ++v) {
        if (v % elements_per_poll == 0 && context.cancelled())
            return Context::cancelled_error("read");
        if (text.at_end())
            return error_at_line(file, text.line(),
                                 "the file ends before vertex " + std::to_string(v) + " of " +
                                     std::to_string(header->vertices),
                                 static_cast<Index>(v));
        for (const PointField f : fields) {
            double value = 0.0;
            if (!text.number_in_line(value))
                return error_at_line(file, text.line(),
                                     "vertex " + std::to_string(v) + " of " +
                                         std::to_string(header->vertices) + ": " +
                                         expected_number(text.bad_word()),
                                     static_cast<Index>(v));
            table[f].push_back(value);
        }
        text.skip_line(); // opacity, texture coordinates
    }
    return table_to_cloud(file, std::move(table));
}

} // namespace bot2nurbs
