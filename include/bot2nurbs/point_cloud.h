// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/vec.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace bot2nurbs {

//! Points as a reader found them: one entry of every array per point; an array is empty where the
//! file does not have it. Nothing is promised of the numbers.
struct PointCloud {
    std::vector<Vec3> positions; //!< Not finite where an organised scan saw nothing.
    std::vector<Vec3> normals;   //!< As in the file: of any length.
    std::vector<std::array<std::uint8_t, 3>> colors; //!< Red, green, blue.
    std::vector<double> confidence;                  //!< Larger is better; as in the file.
    std::vector<double> intensity;                   //!< Of the returned light; as in the file.
    std::optional<Vec3> viewpoint;                   //!< Where the scanner stood.

    std::size_t size() const { return positions.size(); }
};

} // namespace bot2nurbs
