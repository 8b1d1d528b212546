// SPDX-License-Identifier: MIT
#include "io/ply_header.h"
#include "io/ply_values.h"
#include "io/point_table.h"

namespace bot2nurbs {

namespace {

//! Reads the vertices of one file; Values says how numbers are stored.
template <class Values> class PlyPointReader {
public:
    PlyPointReader(const MeshFile& file, const PlyHeader& header, Context& context)
        : file_(file), header_(header), values_(file, header), context_(context)
    {
    }

    Result<PointCloud> read()
    {
        for (const PlyElement& element : header_.elements) {
            if (Status bad = read_element(element))
                return *bad;
            if (element.name == "vertex")
                break;
        }
        return table_to_cloud(file_, std::move(table_));
    }

private:
    Status read_element(const PlyElement& element)
    {
        const std::size_t least = element.least_bytes(header_.format);
        // The last number of a text file needs no separator behind it.
        if (least > 0 && element.count > (values_.bytes_left() + 1) / least)
            return values_.error("the file is too short for the " + std::to_string(element.count) +
                                     " elements " + quoted(element.name) + " it promises",
                                 invalid_index);
        std::vector<std::vector<double>*> columns(element.properties.size(), nullptr);
        if (element.name == "vertex")
            if (Status bad = choose_columns(element, columns))
                return bad;
        if (least == 0)
            return std::nullopt; // an element without properties has no bytes
        for (std::uint64_t e = 0; e < element.count; ++e) {
            if (e % elements_per_poll == 0 && context_.cancelled())
                return Context::cancelled_error("read");
            const auto fail = [&](const std::string& what) {
                return values_.error(element.name + " " + std::to_string(e) + " of " +
                                         std::to_string(element.count) + ": " + what,
                                     static_cast<Index>(e));
            };
            for (std::size_t i = 0; i < columns.size(); ++i) {
                const PlyProperty& property = element.properties[i];
                if (property.is_list) {
                    std::uint64_t entries = 0;
                    if (Status bad = read_ply_count(values_, property, entries, fail))
                        return bad;
                    if (!values_.skip(property.type, entries))
                        return fail(values_.failure());
                } else if (columns[i] == nullptr) {
                    if (!values_.skip(property.type))
                        return fail(values_.failure());
                } else {
                    double value = 0.0;
                    if (!values_.read(property.type, value))
                        return fail(values_.failure());
                    columns[i]->push_back(value);
                }
            }
        }
        return std::nullopt;
    }

    //! The column of the table that each property fills; null for those passed over.
    Status choose_columns(const PlyElement& element, std::vector<std::vector<double>*>& columns)
    {
        std::array<bool, point_fields> used{};
        for (std::size_t i = 0; i < columns.size(); ++i) {
            const PlyProperty& property = element.properties[i];
            const std::optional<PointField> field =
                property.is_list ? std::nullopt : point_field(property.name);
            if (!field || used[static_cast<std::size_t>(*field)])
                continue;
            used[static_cast<std::size_t>(*field)] = true;
            columns[i] = &table_[*field];
            columns[i]->reserve(columns[i]->size() + element.count);
            if (*field == PointField::red) {
                table_.real_colors = property.type >= PlyType::float32;
                table_.full_color = property.type == PlyType::uint16 ? 65535.0 : 255.0;
            }
        }
        for (const PointField f : {PointField::x, PointField::y, PointField::z})
            if (!used[static_cast<std::size_t>(f)])
                return values_.error("vertices have no x, y and z", invalid_index);
        return std::nullopt;
    }

    const MeshFile& file_;
    const PlyHeader& header_;
    Values values_;
    Context& context_;
    PointTable table_;
};

} // namespace

Result<PointCloud> read_ply_points(const MeshFile& file, Context& context)
{
    const Result<PlyHeader> header = read_ply_header(file);
    if (!header)
        return header.error();
    switch (header->format) {
    case PlyFormat::text: return PlyPointReader<PlyTextValues>(file, *header, context).read();
    case PlyFormat::little_endian:
        return PlyPointReader<PlyBinaryValues<false>>(file, *header, context).read();
    case PlyFormat::big_endian:
        return PlyPointReader<PlyBinaryValues<true>>(file, *header, context).read();
    }
    return Error{ErrorCode::internal, "unknown PLY format", invalid_index};
}

} // namespace bot2nurbs
