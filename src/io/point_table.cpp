// SPDX-License-Identifier: MIT
#include "io/point_table.h"

#include <algorithm>
#include <cmath>

namespace bot2nurbs {

namespace {

std::vector<Vec3> triples(const PointTable& table, PointField first)
{
    const auto field = [first](int k) {
        return static_cast<PointField>(static_cast<int>(first) + k);
    };
    const std::vector<double>&x = table[first], &y = table[field(1)], &z = table[field(2)];
    std::vector<Vec3> result(x.size());
    for (std::size_t i = 0; i < x.size(); ++i)
        result[i] = {x[i], y[i], z[i]};
    return result;
}

double full_color(const PointTable& table, const std::vector<Vec3>& colors)
{
    if (!table.real_colors)
        return table.full_color;
    const bool shares = std::all_of(colors.begin(), colors.end(), [](const Vec3& c) {
        return !(c.x > 1.0) && !(c.y > 1.0) && !(c.z > 1.0);
    });
    return shares ? 1.0 : 255.0;
}

std::uint8_t color_byte(double value, double full)
{
    // Not a number becomes zero.
    const double scaled = 255.0 * value / full;
    return scaled > 0.0 ? static_cast<std::uint8_t>(std::lround(std::min(scaled, 255.0))) : 0;
}

} // namespace

std::optional<PointField> point_field(std::string_view name)
{
    static const struct {
        std::string_view name;
        PointField field;
    } names[] = {
        {"x", PointField::x},
        {"y", PointField::y},
        {"z", PointField::z},
        {"nx", PointField::nx},
        {"ny", PointField::ny},
        {"nz", PointField::nz},
        {"normal_x", PointField::nx},
        {"normal_y", PointField::ny},
        {"normal_z", PointField::nz},
        {"normalx", PointField::nx},
        {"normaly", PointField::ny},
        {"normalz", PointField::nz},
        {"red", PointField::red},
        {"green", PointField::green},
        {"blue", PointField::blue},
        {"r", PointField::red},
        {"g", PointField::green},
        {"b", PointField::blue},
        {"diffuse_red", PointField::red},
        {"diffuse_green", PointField::green},
        {"diffuse_blue", PointField::blue},
        {"intensity", PointField::intensity},
        {"scalar_intensity", PointField::intensity},
        {"i", PointField::intensity},
        {"reflectance", PointField::intensity},
        {"confidence", PointField::confidence},
        {"quality", PointField::confidence},
    };
    std::string lower(name);
    for (char& c : lower)
        if (c >= 'A' && c <= 'Z')
            c = static_cast<char>(c - 'A' + 'a');
    for (const auto& n : names)
        if (lower == n.name)
            return n.field;
    return std::nullopt;
}

bool PointTable::has_triple(PointField first) const
{
    for (int k = 0; k < 3; ++k)
        if (columns_[static_cast<std::size_t>(first) + static_cast<std::size_t>(k)].empty())
            return false;
    return true;
}

Result<PointCloud> table_to_cloud(const MeshFile& file, PointTable table)
{
    const std::size_t count = table[PointField::x].size();
    if (count == 0)
        return Error{ErrorCode::empty_input, file.name + ": no points", invalid_index};
    if (count >= invalid_index)
        return Error{ErrorCode::cannot_read, file.name + ": too many points for 32-bit indices",
                     invalid_index};
    PointCloud cloud;
    cloud.positions = triples(table, PointField::x);
    if (table.has_triple(PointField::nx))
        cloud.normals = triples(table, PointField::nx);
    if (table.has_triple(PointField::red)) {
        const std::vector<Vec3> colors = triples(table, PointField::red);
        const double full = full_color(table, colors);
        cloud.colors.reserve(count);
        for (const Vec3& c : colors)
            cloud.colors.push_back(
                {color_byte(c.x, full), color_byte(c.y, full), color_byte(c.z, full)});
    }
    cloud.intensity = std::move(table[PointField::intensity]);
    cloud.confidence = std::move(table[PointField::confidence]);
    cloud.viewpoint = table.viewpoint;
    return cloud;
}

} // namespace bot2nurbs
