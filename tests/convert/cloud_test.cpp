// SPDX-License-Identifier: MIT
#include "cloud/cloud_fixtures.h"
#include "convert_fixtures.h"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

namespace bot2nurbs::test {
namespace {

using fixtures::SampledSurface;

class ConvertCloud : public ConvertTest {
protected:
    static std::string xyz_text(const std::vector<Vec3>& points,
                                const std::vector<Vec3>& normals = {})
    {
        std::string text;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Vec3& p = points[i];
            text += fmt::format("{:.17g} {:.17g} {:.17g}", p.x, p.y, p.z);
            if (!normals.empty())
                text += fmt::format(" {:.17g} {:.17g} {:.17g}", normals[i].x, normals[i].y,
                                    normals[i].z);
            text += "\n";
        }
        return text;
    }

    ConvertOptions options_for_points(const std::vector<Vec3>& points,
                                      const std::vector<Vec3>& normals = {}) const
    {
        write_file(path("scan.xyz"), xyz_text(points, normals));
        ConvertOptions options;
        options.input = path("scan.xyz");
        options.outputs = {path("a.step")};
        options.patches = 40;
        return options;
    }

    ConvertReport converted(const ConvertOptions& options, unsigned threads = 0) const
    {
        Context context;
        context.threads = threads;
        Result<ConvertReport> report = convert(options, context);
        EXPECT_TRUE(report) << report.error().message;
        return report ? std::move(*report) : ConvertReport{};
    }
};

//! Whether there is a warning of this code whose message has this text.
bool warned(const ConvertReport& report, const std::string& code, const std::string& text = "")
{
    return std::any_of(report.warnings.begin(), report.warnings.end(), [&](const Warning& w) {
        return w.code == code && w.message.find(text) != std::string::npos;
    });
}

std::vector<Vec3> half_sphere(std::size_t n)
{
    std::vector<Vec3> half;
    for (const Vec3& p : fixtures::sphere_points(n).points)
        if (p.z > 0.0)
            half.push_back(p);
    return half;
}

TEST_F(ConvertCloud, points_of_a_torus_become_a_solid_of_genus_one_through_them)
{
    const auto torus = fixtures::torus_points(5000);
    const ConvertReport report = converted(options_for_points(torus.points));
    EXPECT_TRUE(report.solid());
    ASSERT_EQ(report.components.size(), 1u);
    EXPECT_EQ(report.components[0].genus, 1);
    EXPECT_EQ(report.components[0].brep.genus(), 1);
    EXPECT_LE(report.components[0].continuity.max_g1_angle_deg, 1e-8);
    ASSERT_TRUE(report.cloud);
    EXPECT_EQ(report.cloud->points, 5000u);
    EXPECT_EQ(report.cloud->topology, CloudTopology::closed);
    EXPECT_FALSE(report.cloud->normals.given);
    EXPECT_EQ(report.cloud->deviation.points, report.cloud->fitted);
    EXPECT_LT(report.cloud->deviation.rms, 1e-3 * report.diagonal);
    // The mean square distance to the nearest of evenly scattered points is the area of one over
    // pi.
    const SurfaceToPoints& back = report.cloud->surface_to_points;
    EXPECT_EQ(back.samples, 144u * report.components[0].domain.faces);
    EXPECT_GT(back.covered, 0.999 * back.samples);
    EXPECT_LE(back.max, back.reach);
    EXPECT_NEAR(back.rms, std::sqrt(4.0 * fixtures::pi * 0.4 / 5000.0), 0.1 * back.rms);
    EXPECT_EQ(report.deviation().source_to_surface.rms, report.cloud->deviation.rms);
    // The volume of a torus: 2 pi^2 R r^2.
    EXPECT_NEAR(report.components[0].brep.volume, 2.0 * fixtures::pi * fixtures::pi * 1.0 * 0.16,
                0.01);
    EXPECT_GT(std::filesystem::file_size(path("a.step")), 1000u);
}

TEST_F(ConvertCloud, the_surface_is_fitted_to_the_points_and_not_to_the_mesh)
{
    // The mesh rounds off what its cells do not resolve; the surface through the points does not.
    const auto sphere = fixtures::sphere_points(1200);
    const ConvertReport report = converted(options_for_points(sphere.points));
    const double mesh_distance = report.deviation().surface_to_source.rms;
    EXPECT_LT(report.cloud->deviation.rms, 0.3 * mesh_distance);
}

TEST_F(ConvertCloud, noise_is_reported_and_not_followed)
{
    const auto torus = fixtures::torus_points(8000);
    const double noise = 0.02;
    const ConvertReport report =
        converted(options_for_points(fixtures::with_noise(torus.points, noise)));
    EXPECT_TRUE(report.solid());
    EXPECT_EQ(report.components[0].genus, 1);
    EXPECT_NEAR(report.cloud->noise, noise, 0.2 * noise);
    EXPECT_NEAR(report.cloud->deviation.rms, noise, 0.25 * noise);
}

TEST_F(ConvertCloud, a_tolerance_is_met_by_the_points)
{
    ConvertOptions options = options_for_points(fixtures::torus_points(5000).points);
    options.patches.reset();
    options.tolerance = Length{1e-3, true};
    const ConvertReport report = converted(options);
    EXPECT_TRUE(report.tolerance_met());
    EXPECT_TRUE(report.solid());
    EXPECT_EQ(report.components[0].fit.termination, "tolerance_met");
    EXPECT_LE(report.cloud->deviation.max, 1e-3 * report.diagonal);
    EXPECT_EQ(report.cloud->within[0].share, 1.0);
}

TEST_F(ConvertCloud, a_tolerance_below_the_noise_is_warned_of_and_not_met_with_waves)
{
    ConvertOptions options =
        options_for_points(fixtures::with_noise(fixtures::torus_points(8000).points, 0.02));
    options.patches.reset();
    options.tolerance = Length{1e-3, true};
    const ConvertReport report = converted(options);
    EXPECT_FALSE(report.tolerance_met());
    EXPECT_TRUE(report.solid());
    EXPECT_EQ(report.components[0].fit.termination, "noise_limit");
    EXPECT_LT(report.components[0].domain.faces, 200u);
    EXPECT_NEAR(report.cloud->deviation.rms, 0.02, 0.25 * 0.02);
    EXPECT_TRUE(warned(report, "tolerance_below_noise"));
    EXPECT_TRUE(warned(report, "tolerance_not_met"));
    // The share within the tolerance is among those listed.
    const auto& within = report.cloud->within;
    ASSERT_EQ(within.size(), 4u);
    EXPECT_TRUE(std::any_of(within.begin(), within.end(), [&](const ShareWithin& w) {
        return w.distance == 1e-3 * report.diagonal && w.share < 0.5;
    }));
}

TEST_F(ConvertCloud, copies_and_points_that_are_not_finite_are_counted_and_do_no_harm)
{
    auto points = fixtures::sphere_points(2000).points;
    points.insert(points.end(), points.begin(), points.begin() + 300);
    points.push_back({std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0});
    const ConvertReport report = converted(options_for_points(points));
    EXPECT_TRUE(report.solid());
    EXPECT_EQ(report.cloud->duplicates, 300u);
    EXPECT_EQ(report.cloud->not_finite, 1u);
    ASSERT_GE(report.repairs.size(), 2u);
    EXPECT_EQ(report.repairs[0].code, "not_finite_points");
    EXPECT_EQ(report.repairs[1].code, "duplicate_points");
}

TEST_F(ConvertCloud, half_a_sphere_is_an_open_surface_and_no_solid)
{
    ConvertOptions options = options_for_points(half_sphere(5000));
    const ConvertReport report = converted(options);
    EXPECT_TRUE(report.valid());
    EXPECT_FALSE(report.solid());
    EXPECT_EQ(report.cloud->topology, CloudTopology::open);
    EXPECT_EQ(report.components[0].boundary_loops, 1u);
    EXPECT_TRUE(warned(report, "holes_left_open", "1 place without points is left open"));

    std::filesystem::remove(path("a.step"));
    options.closure = Closure::solid;
    Context context;
    const auto refused = convert(options, context);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::open_mesh);
    EXPECT_NE(refused.error().message.find("the largest hole"), std::string::npos)
        << refused.error().message;
    EXPECT_EQ(files(), (std::vector<std::string>{"scan.xyz"}));
}

TEST_F(ConvertCloud, a_hole_of_the_size_allowed_is_closed_with_a_warning)
{
    std::vector<Vec3> pierced;
    for (const Vec3& p : fixtures::sphere_points(5000).points)
        if (p.z < 0.97)
            pierced.push_back(p);
    ConvertOptions options = options_for_points(pierced);
    options.fill_holes = Length{0.2, true};
    options.closure = Closure::solid;
    const ConvertReport report = converted(options);
    EXPECT_TRUE(report.solid());
    EXPECT_EQ(report.cloud->topology, CloudTopology::holes_filled);
    EXPECT_GT(report.cloud->anchors, 0u);
    EXPECT_LT(report.cloud->surface_to_points.covered, report.cloud->surface_to_points.samples);

    options.tolerance = Length{1e-2, true};
    const ConvertReport near = converted(options);
    EXPECT_TRUE(near.tolerance_met());
    EXPECT_TRUE(near.solid());
    EXPECT_GT(near.cloud->anchors, 0u);
    EXPECT_TRUE(warned(report, "holes_filled"));
}

TEST_F(ConvertCloud, balls_lead_to_a_solid_too)
{
    ConvertOptions options = options_for_points(fixtures::torus_points(5000).points);
    options.cloud.reconstruct.method = ReconstructionMethod::ball_pivoting;
    const ConvertReport report = converted(options);
    EXPECT_TRUE(report.solid());
    EXPECT_EQ(report.components[0].genus, 1);
    EXPECT_LT(report.cloud->deviation.rms, 1e-3 * report.diagonal);
    EXPECT_LT(report.cloud->evidence.unused_points, 0.02);
    EXPECT_EQ(report.cloud->evidence.depth, 0);
}

TEST_F(ConvertCloud, two_bodies_become_two_solids)
{
    const auto s = fixtures::joined(fixtures::sphere_points(2000),
                                    fixtures::sphere_points(1500, 0.8, {3.0, 0.0, 0.0}));
    const ConvertReport report = converted(options_for_points(s.points));
    EXPECT_TRUE(report.solid());
    ASSERT_EQ(report.components.size(), 2u);
    EXPECT_EQ(report.cloud->deviation.points, 3500u);
    ConvertOptions options = options_for_points(s.points);
    options.components = ComponentMode::largest;
    const ConvertReport largest = converted(options);
    EXPECT_EQ(largest.components.size(), 1u);
    EXPECT_EQ(largest.cloud->off_mesh, 1500u);
    EXPECT_LT(largest.cloud->deviation.rms, 1e-3);
}

TEST_F(ConvertCloud, faces_are_passed_over_when_points_are_asked_for)
{
    ConvertOptions options = options_for({sphere_cube(2, 16)});
    options.domain_in.reset();
    options.outputs = {path("a.step")};
    options.patches = 24;
    options.cloud.points = true;
    const ConvertReport report = converted(options);
    ASSERT_TRUE(report.cloud);
    EXPECT_TRUE(report.solid());
}

TEST_F(ConvertCloud, the_same_bytes_for_any_thread_count)
{
    ConvertOptions options = options_for_points(fixtures::torus_points(2000).points);
    options.outputs = {path("a.brep")};
    converted(options, 1);
    const std::string one = read_file(path("a.brep"));
    converted(options, 3);
    EXPECT_EQ(one, read_file(path("a.brep")));
}

TEST_F(ConvertCloud, points_that_show_no_surface_are_refused_by_name)
{
    Context context;
    const auto few = convert(options_for_points(fixtures::sphere_points(20).points), context);
    ASSERT_FALSE(few);
    EXPECT_EQ(few.error().code, ErrorCode::bad_geometry);
    std::vector<Vec3> line;
    for (int i = 0; i < 200; ++i)
        line.push_back({0.5 * i, -0.25 * i, 1.0});
    const auto flat = convert(options_for_points(line), context);
    ASSERT_FALSE(flat);
    EXPECT_EQ(flat.error().code, ErrorCode::bad_geometry);
    EXPECT_NE(flat.error().message.find("line"), std::string::npos);
    ConvertOptions options = options_for_points(fixtures::sphere_points(500).points);
    options.cloud.normals = NormalMode::given;
    const auto bare = convert(options, context);
    ASSERT_FALSE(bare);
    EXPECT_NE(bare.error().message.find("no normal"), std::string::npos);
    EXPECT_EQ(files(), (std::vector<std::string>{"scan.xyz"}));
}

TEST_F(ConvertCloud, the_report_has_what_was_found)
{
    auto s = fixtures::torus_points(3000);
    for (std::size_t i = 0; i < s.normals.size(); i += 3)
        s.normals[i] = -s.normals[i];
    const ConvertOptions options = options_for_points(s.points, s.normals);
    const auto j = nlohmann::json::parse(report_to_json(options, converted(options)));
    EXPECT_EQ(j["input"]["points"], 3000);
    EXPECT_EQ(j["cloud"]["topology"], "closed");
    EXPECT_EQ(j["cloud"]["normals"]["source"], "estimated");
    EXPECT_NEAR(j["cloud"]["normals"]["given_flipped"].get<double>(), 1.0 / 3.0, 0.001);
    EXPECT_EQ(j["cloud"]["deviation"]["within"].size(), 3u);
    EXPECT_EQ(j["options"]["cloud"]["normals"], "auto");
    EXPECT_EQ(j["warnings"][0]["code"], "normals_estimated");
}

} // namespace
} // namespace bot2nurbs::test
