// SPDX-License-Identifier: MIT
#include "convert_fixtures.h"

namespace bot2nurbs::test {
namespace {

//! Meshes of scripts/stress.py that failed once.
class StressTest : public ConvertTest, public testing::WithParamInterface<int> {};

TEST_P(StressTest, a_seed_that_failed_ends_as_a_valid_solid)
{
    ConvertOptions options;
    options.input = BOT2NURBS_TEST_MESHES "/stress_" + std::to_string(GetParam()) + ".off";
    options.outputs = {path("a.3dm")};
    Context context;
    const Result<ConvertReport> report = convert(options, context);
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_TRUE(report->valid());
    EXPECT_TRUE(report->solid());
    ASSERT_EQ(report->components.size(), 1u);
    EXPECT_LE(report->components[0].continuity.max_g1_angle_deg, 1e-8);
}

// 6: two paths that run into one vertex from a bend of the coarse mesh crossed when they were
// lifted.
INSTANTIATE_TEST_SUITE_P(Seeds, StressTest, testing::Values(6));

} // namespace
} // namespace bot2nurbs::test
