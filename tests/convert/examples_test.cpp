// SPDX-License-Identifier: MIT
#include "bot2nurbs/check_mesh.h"
#include "bot2nurbs/convert.h"
#include "bot2nurbs/read_mesh.h"

#include <gtest/gtest.h>
#include <string>

namespace bot2nurbs {
namespace {

struct Example {
    const char* file;
    int genus;
};

class Examples : public ::testing::TestWithParam<Example> {};

TEST_P(Examples, are_closed_manifold_outward_and_do_not_cross_themselves)
{
    Context context;
    const Result<TriangleSoup> soup =
        read_mesh(std::string(BOT2NURBS_EXAMPLES "/") + GetParam().file, context);
    ASSERT_TRUE(soup) << soup.error().message;
    const MeshReport report = check_mesh(*soup, context);
    for (const MeshDefect& d : report.defects)
        ADD_FAILURE() << d.message;
    EXPECT_TRUE(report.closed && report.manifold && report.oriented);
    EXPECT_EQ(report.sharp_edges, 0u);
    ASSERT_EQ(report.components.size(), 1u);
    EXPECT_EQ(report.components[0].genus, GetParam().genus);
    EXPECT_GT(report.components[0].volume, 0.0);
}

INSTANTIATE_TEST_SUITE_P(, Examples,
                         ::testing::Values(Example{"bracket.ply", 3}, Example{"knot.ply", 1},
                                           Example{"torso.off", 0}, Example{"sphere.obj", 0}),
                         [](const auto& example) {
                             const std::string name = example.param.file;
                             return name.substr(0, name.find('.'));
                         });

TEST(ExamplesWithEdges, are_a_closed_arch_and_an_open_hood)
{
    for (const bool closed : {true, false}) {
        ConvertOptions options;
        options.input = std::string(BOT2NURBS_EXAMPLES "/") + (closed ? "arch.obj" : "hood.obj");
        Context context;
        const Result<InputReport> report = check_input(options, context);
        ASSERT_TRUE(report) << report.error().message;
        EXPECT_FALSE(report->rejection);
        EXPECT_TRUE(report->repairs.empty());
        EXPECT_EQ(report->mesh.closed, closed);
        EXPECT_TRUE(report->mesh.manifold && report->mesh.oriented);
        EXPECT_EQ(report->mesh.self_intersecting_pairs, 0u);
        EXPECT_GT(report->mesh.sharp_edges, 100u);
        EXPECT_EQ(report->mesh.boundary_loops.size(), closed ? 0u : 1u);
    }
}

} // namespace
} // namespace bot2nurbs
