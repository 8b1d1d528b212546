// SPDX-License-Identifier: MIT
#include "bot2nurbs/convert.h"

#include <cmath>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace bot2nurbs {
namespace {

using nlohmann::json;

//! Two components with numbers that tell which is which.
ConvertReport example_report()
{
    ConvertReport report;
    report.input_vertices = 10;
    report.input_faces = 16;
    report.units = "mm";
    report.diagonal = 4.0;
    for (const Index i : {0u, 1u}) {
        ComponentOutcome c;
        c.genus = static_cast<int>(i);
        c.diagonal = 2.0;
        c.domain = {"eck", "0123456789abcdef", 6, 12, 8, 8, 3 + i, {0, 0, 0, 8}};
        c.features.detected_edges = 7;
        c.features.kept_edges = 5 + i;
        c.features.smoothed = {{i, i + 1}};
        c.fit.rounds.resize(5 + i);
        c.fit.unknowns = 100;
        c.fit.condition = 10.0 + i;
        c.fit.termination = i == 0 ? "stalled" : "round_limit";
        c.deviation.source_to_surface = {0.1 + 0.1 * i, 0.03, 100, {}};
        c.deviation.surface_to_source = {0.05, 0.01 + 0.03 * i, 300, {}};
        c.continuity = {0.0, 1e-12 * (1.0 + i), 0, 0};
        c.brep.valid = c.brep.solid = true;
        c.brep_faces = 6;
        c.brep_edges = 12;
        c.brep_vertices = 8;
        report.components.push_back(c);
    }
    report.outputs = {{"out.step", "step", 1234}};
    report.warnings = {{"sharp_edges", "3 edges", invalid_index}};
    report.stages = {{"read", 0.5, 12.0, 0.75}};
    return report;
}

TEST(Report, has_the_fixed_names_and_sums_over_components)
{
    const json j = json::parse(report_to_json({}, example_report()));
    EXPECT_EQ(j["schema"], "bot2nurbs.report/1");
    EXPECT_EQ(j["input"]["vertices"], 10);
    EXPECT_EQ(j["input"]["components"][1]["genus"], 1);
    EXPECT_EQ(j["domain"]["faces"], 12);
    EXPECT_EQ(j["domain"]["max_valence"], 4);
    EXPECT_EQ(j["domain"]["valences"]["3"], 16);
    EXPECT_EQ(j["fit"]["rounds"], 6);
    EXPECT_EQ(j["fit"]["unknowns"], 200);
    EXPECT_EQ(j["fit"]["condition"], 11.0);
    EXPECT_EQ(j["fit"]["termination"], "round_limit");
    EXPECT_EQ(j["brep"]["faces"], 12);
    EXPECT_EQ(j["brep"]["valid"], true);
    EXPECT_EQ(j["brep"]["solid"], true);
    EXPECT_EQ(j["continuity"]["max_g1_angle_deg"], 2e-12);
    EXPECT_EQ(j["features"]["detected_edges"], 14);
    EXPECT_EQ(j["features"]["kept_edges"], 11);
    EXPECT_EQ(j["features"]["smoothed_edges"], 2);
    EXPECT_EQ(j["features"]["smoothed"], json::parse("[[0,1],[1,2]]"));
    EXPECT_EQ(j["outputs"][0]["bytes"], 1234);
    EXPECT_EQ(j["stages"][0]["peak_rss_mib"], 12.0);
    EXPECT_EQ(j["stages"][0]["cpu_seconds"], 0.75);
    EXPECT_TRUE(j["warnings"][0]["element"].is_null());
    EXPECT_EQ(j["components"].size(), 2u);
}

TEST(Report, pools_deviations_by_samples_and_takes_the_worse_side)
{
    const json d = json::parse(report_to_json({}, example_report()))["deviation"];
    const double surface_rms = std::sqrt((0.01 * 0.01 + 0.04 * 0.04) / 2.0);
    EXPECT_DOUBLE_EQ(d["max"], 0.2);
    EXPECT_DOUBLE_EQ(d["source_to_surface"]["rms"], 0.03);
    EXPECT_DOUBLE_EQ(d["surface_to_source"]["rms"], surface_rms);
    EXPECT_DOUBLE_EQ(d["rms"], std::fmax(0.03, surface_rms));
    EXPECT_DOUBLE_EQ(d["max_relative"], 0.05);
    EXPECT_EQ(d["kind"], "sampled");
}

TEST(Report, has_an_upper_bound_when_there_is_one_for_every_component)
{
    ConvertReport report = example_report();
    HausdorffBound bound;
    bound.surface_to_source.lower = 0.19;
    bound.surface_to_source.upper = 0.21;
    bound.source_to_surface.upper = 0.22;
    bound.surface_to_source.worst.surface = {7, 0.25, 1.0};
    bound.cells = 5;
    report.components[1].bound = bound;
    const json without = json::parse(report_to_json({}, report));
    EXPECT_FALSE(without["deviation"].contains("upper_bound"));
    EXPECT_EQ(without["components"][1]["deviation"]["upper_bound"], 0.22);
    bound.source_to_surface.lower = bound.source_to_surface.upper = 0.3;
    report.components[0].bound = bound;
    const json j = json::parse(report_to_json({}, report));
    EXPECT_EQ(j["deviation"]["kind"], "proven");
    EXPECT_EQ(j["deviation"]["lower_bound"], 0.3);
    EXPECT_EQ(j["deviation"]["upper_bound"], 0.3);
    EXPECT_DOUBLE_EQ(j["deviation"]["upper_bound_relative"], 0.3 / report.diagonal);
    const json second = j["components"][1]["deviation"];
    EXPECT_EQ(second["worst"]["side"], "surface");
    EXPECT_EQ(second["worst"]["patch"], 7);
    EXPECT_EQ(second["worst"]["u"], 0.25);
    EXPECT_EQ(second["bound"]["termination"], "gap_reached");
    EXPECT_EQ(second["bound"]["cells"], 5);
    EXPECT_EQ(j["components"][0]["deviation"]["worst"]["side"], "source");
}

TEST(Report, claims_no_solid_when_one_component_is_none)
{
    ConvertReport report = example_report();
    report.components[1].brep.solid = false;
    const json j = json::parse(report_to_json({}, report));
    EXPECT_EQ(j["brep"]["valid"], true);
    EXPECT_EQ(j["brep"]["solid"], false);
    EXPECT_FALSE(ConvertReport().solid());
}

TEST(Report, survives_paths_that_are_no_text_and_numbers_that_are_none)
{
    ConvertReport report = example_report();
    ConvertOptions options;
    options.input = "\xff\xfe.off";
    report.components[0].fit.condition = INFINITY;
    const json j = json::parse(report_to_json(options, report));
    EXPECT_TRUE(j["fit"]["condition"].is_null());
}

TEST(Report, of_a_failure_says_what_and_where)
{
    const json j = json::parse(
        failure_to_json({}, {ErrorCode::open_mesh, "2 boundary loops", 17}, {{"read", 0.1, 1.0}}));
    EXPECT_EQ(j["error"]["code"], "open_mesh");
    EXPECT_EQ(j["error"]["element"], 17);
    EXPECT_EQ(j["error"]["exit_code"], 5);
    EXPECT_EQ(j["stages"].size(), 1u);
}

} // namespace
} // namespace bot2nurbs
