// SPDX-License-Identifier: MIT
#include "spline/fans.h"

#include "network_fixtures.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace bot2nurbs {
namespace {

TEST(CornerFanAngle, leads_the_edges_between_through_the_surface_in_order)
{
    // In the tangent plane of a corner that spans `spread`, the end tangents have any lengths. The
    // tangents between them, t_i = t_0 cos(i phi) + v sin(i phi), must turn from one to the other.
    for (Index k = 2; k <= 8; ++k)
        for (double spread = 0.3; spread < 6.2; spread += 0.1)
            for (const double ratio : {0.1, 1.0, 10.0}) {
                const double alpha = corner_fan_angle(k, spread), phi = alpha / k;
                const Vec2 first{1.0, 0.0},
                    last{ratio * std::cos(spread), ratio * std::sin(spread)};
                const Vec2 v = (1.0 / std::sin(alpha)) * (last - std::cos(alpha) * first);
                Vec2 before = first;
                double turned = 0.0;
                for (Index i = 1; i <= k; ++i) {
                    const Vec2 t = std::cos(i * phi) * first + std::sin(i * phi) * v;
                    const double angle = std::atan2(cross(before, t), dot(before, t));
                    EXPECT_GT(angle, 0.0) << k << " " << spread << " " << i;
                    turned += angle;
                    before = t;
                }
                EXPECT_NEAR(turned, spread, 1e-9) << k << " " << spread;
            }
}

TEST(CornerFanAngle, is_one_for_which_masks_exist)
{
    for (Index k = 2; k <= 8; ++k)
        for (double spread = 0.0; spread < 13.0; spread += 0.05) {
            const double alpha = corner_fan_angle(k, spread);
            EXPECT_GE(std::abs(std::sin(alpha)), 0.499) << k << " " << spread;
            EXPECT_LE(alpha / k, 2.0 * M_PI / 3.0 + 1e-12) << k << " " << spread;
            EXPECT_GE(alpha, M_PI / 6.0);
            EXPECT_LT(alpha, 2.0 * M_PI);
        }
}

TEST(FindFans, takes_the_angle_of_a_corner_from_the_sum_of_its_quads)
{
    // Two quads at a reflex corner of 270 degrees, which is made of halves that are not equal.
    const auto complex = QuadComplex::build(6, {{0, 1, 2, 3}, {0, 3, 4, 5}}, {}, {0});
    ASSERT_TRUE(complex.ok());
    std::vector<double> angles(complex->halfedge_count(), 0.5 * M_PI);
    angles[0] = 0.4 * M_PI;
    angles[4] = 0.8 * M_PI;
    const auto fans = find_fans(*complex, angles);
    ASSERT_TRUE(fans.ok());
    bool seen = false;
    for (const Fan& fan : *fans) {
        if (fan.vertex != 0)
            continue;
        seen = true;
        EXPECT_EQ(fan.kind, FanKind::corner);
        EXPECT_EQ(fan.sector_count(), 2u);
        EXPECT_DOUBLE_EQ(fan.alpha, 1.2 * M_PI);
    }
    EXPECT_TRUE(seen);
    const auto without = find_fans(*complex, {});
    ASSERT_TRUE(without.ok());
    const auto at_corner = std::find_if(without->begin(), without->end(),
                                        [](const Fan& fan) { return fan.vertex == 0; });
    EXPECT_DOUBLE_EQ(at_corner->alpha, corner_fan_angle(2));
}

TEST(FindFans, a_network_refuses_another_number_of_angles_than_corners)
{
    const fixtures::Domain cube = fixtures::cube();
    const auto network =
        build_spline_network(cube.complex, SplineScheme::peters, std::vector<double>(5, 1.0));
    ASSERT_FALSE(network.ok());
    EXPECT_EQ(network.error().code, ErrorCode::bad_option);
}

} // namespace
} // namespace bot2nurbs
