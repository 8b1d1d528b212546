// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/quad_domain.h"

#include <vector>

namespace bot2nurbs {

//! Finds the triangle of a chart at given parameters, through a grid of bins over [0, 1]^2.
class ChartLocator {
public:
    //! A triangle of the chart and weights of its corners: none negative, sum 1.
    struct Hit {
        Index triangle = invalid_index;
        std::array<double, 3> weights{};
    };

    //! Cost linear in the chart where its triangles are of similar size in parameters. \pre the
    //! chart has a triangle; it outlives the locator.
    explicit ChartLocator(const QuadChart& chart);

    //! The triangle in which the point lies deepest (largest least weight; ties to the smallest
    //! index), so that rounding at edges does not lose a point. Every point gets a triangle: one
    //! outside the chart the nearest in that sense.
    Hit locate(const Vec2& uv) const;

private:
    const QuadChart& chart_;
    Index bins_ = 1;                 //!< Per direction.
    std::vector<std::size_t> first_; //!< Per bin: its range in `triangles_`.
    std::vector<Index> triangles_;
};

//! The place on the source of a hit: weights of the corners of the triangle's source face, none
//! negative, sum 1 up to rounding.
SourcePoint source_point(const QuadChart& chart, const ChartLocator::Hit& hit);

} // namespace bot2nurbs
