// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/point_cloud.h"
#include "io/mesh_file.h"

#include <array>
#include <string_view>
#include <vector>

namespace bot2nurbs {

//! What a column of numbers can be.
enum class PointField { x, y, z, nx, ny, nz, red, green, blue, intensity, confidence };
inline constexpr std::size_t point_fields = 11;

//! The field that a name in a header stands for, in any case ("nx", "normal_x", "Red", ...).
std::optional<PointField> point_field(std::string_view name);

//! The columns of a file of points; those that it does not have are empty.
class PointTable {
public:
    std::vector<double>& operator[](PointField f) { return columns_[static_cast<std::size_t>(f)]; }
    const std::vector<double>& operator[](PointField f) const
    {
        return columns_[static_cast<std::size_t>(f)];
    }
    //! Whether all three columns that start with `first` are there.
    bool has_triple(PointField first) const;

    //! Value of a full colour component. Colours that are real numbers are of 0 to 1 when none
    //! exceeds 1, else of 0 to 255.
    double full_color = 255.0;
    bool real_colors = false;
    std::optional<Vec3> viewpoint;

private:
    std::array<std::vector<double>, point_fields> columns_;
};

//! The table as a cloud. Errors: empty_input, and cannot_read where the points are more than an
//! Index can number.
Result<PointCloud> table_to_cloud(const MeshFile& file, PointTable table);

// One reader a format; read_points chooses. Errors as read_points.
Result<PointCloud> read_ply_points(const MeshFile& file, Context& context);
Result<PointCloud> read_obj_points(const MeshFile& file, Context& context);
Result<PointCloud> read_off_points(const MeshFile& file, Context& context);
Result<PointCloud> read_pcd(const MeshFile& file, Context& context);
Result<PointCloud> read_las(const MeshFile& file, Context& context);
Result<PointCloud> read_point_text(const MeshFile& file, Context& context);

} // namespace bot2nurbs
