// SPDX-License-Identifier: MIT
#include "convert/component_tolerance.h"
#include "convert_fixtures.h"

#include <chrono>
#include <thread>

namespace bot2nurbs::test {
namespace {

using Names = std::vector<std::string>;

TEST_F(ConvertTest, a_supplied_domain_becomes_a_solid_in_every_format)
{
    ConvertOptions options = options_for({torus_grid()});
    options.outputs = {path("a.3dm"), path("a.step"), path("a.brep")};
    Context context;
    const Result<ConvertReport> report = convert(options, context);
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_TRUE(report->valid());
    EXPECT_TRUE(report->solid());
    ASSERT_EQ(report->components.size(), 1u);
    const ComponentOutcome& c = report->components[0];
    EXPECT_EQ(c.genus, 1);
    EXPECT_EQ(c.brep.genus(), 1);
    EXPECT_EQ(c.brep_faces, 24u);
    EXPECT_EQ(c.domain.extraordinary, 0u);
    EXPECT_EQ(c.continuity.max_gap, 0.0);
    EXPECT_LE(c.continuity.max_g1_angle_deg, 1e-8);
    EXPECT_LT(c.deviation.rms(), 1e-3 * c.diagonal);
    ASSERT_TRUE(c.bound);
    EXPECT_EQ(c.bound->termination, HausdorffTermination::gap_reached);
    EXPECT_EQ(c.bound->patches.size(), 24u);
    EXPECT_LE(c.deviation.max(), c.bound->upper());
    EXPECT_GE(c.deviation.max(), c.bound->lower());
    EXPECT_GE(c.bound->lower(), c.deviation.rms());
    ASSERT_EQ(report->outputs.size(), 3u);
    for (const OutputFile& file : report->outputs)
        EXPECT_EQ(file.bytes, std::filesystem::file_size(file.path));
    EXPECT_EQ(read_file(path("a.3dm")).substr(0, 14), "3D Geometry Fi");
    EXPECT_EQ(read_file(path("a.step")).substr(0, 12), "ISO-10303-21");
}

TEST(ToleranceOptions, edges_that_someone_drew_are_kept)
{
    const auto keeps = [](auto change) {
        ConvertOptions options;
        change(options);
        return tolerance_options(options, 1.0).keep_edges;
    };
    EXPECT_FALSE(keeps([](ConvertOptions&) {}));
    EXPECT_TRUE(keeps([](ConvertOptions& o) { o.domain_in = "domain.json"; }));
    EXPECT_TRUE(keeps([](ConvertOptions& o) { o.quads = "quads.obj"; }));
    EXPECT_TRUE(keeps([](ConvertOptions& o) { o.cage = true; }));
}

TEST_F(ConvertTest, a_tolerance_refines_a_supplied_domain_and_the_report_proves_it)
{
    // In the units of the input, far from the origin.
    ConvertOptions options = options_for({moved(torus_grid(4, 3, 24), 10.0, {500, 0, 0})});
    options.outputs = {path("a.3dm")};
    options.tolerance = Length{0.011, false};
    Context context;
    const Result<ConvertReport> report = convert(options, context);
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_TRUE(report->tolerance_met());
    const ComponentOutcome& c = report->components[0];
    ASSERT_TRUE(c.tolerance);
    EXPECT_EQ(c.tolerance->termination, RefinementEnd::tolerance_met);
    EXPECT_LE(c.tolerance->distance.upper, 0.011);
    EXPECT_GT(c.tolerance->rounds.front().distance.lower, 0.011);
    EXPECT_GT(c.brep_faces, 12u);
    EXPECT_EQ(c.brep_faces, c.tolerance->rounds[c.tolerance->best].patches);
    EXPECT_TRUE(report->solid());
    EXPECT_LE(c.continuity.max_g1_angle_deg, 1e-8);
}

TEST_F(ConvertTest, a_tolerance_that_is_not_met_writes_the_best_surface_and_warns_where)
{
    ConvertOptions options = options_for({torus_grid(4, 3, 12)});
    options.outputs = {path("a.3dm")};
    options.tolerance = Length{1e-6, true};
    options.max_patches = 30;
    Context context;
    const Result<ConvertReport> report = convert(options, context);
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_FALSE(report->tolerance_met());
    EXPECT_EQ(report->outputs.size(), 1u);
    const ComponentOutcome& c = report->components[0];
    EXPECT_EQ(c.tolerance->termination, RefinementEnd::patch_limit);
    EXPECT_LE(c.brep_faces, 30u);
    ASSERT_FALSE(report->warnings.empty());
    EXPECT_EQ(report->warnings.back().code, "tolerance_not_met");
    EXPECT_EQ(report->warnings.back().element, c.tolerance->worst.surface.quad);
    EXPECT_GT(c.tolerance->worst.distance, c.tolerance->tolerance);
}

TEST_F(ConvertTest, a_mesh_of_genus_two_keeps_its_genus)
{
    ConvertOptions options = options_for({genus2_voxels()});
    options.outputs = {path("a.3dm")};
    Context context;
    const Result<ConvertReport> report = convert(options, context);
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_TRUE(report->solid());
    EXPECT_EQ(report->components[0].brep.genus(), 2);
    EXPECT_LE(report->components[0].continuity.max_g1_angle_deg, 1e-8);
}

TEST_F(ConvertTest, a_domain_that_is_written_and_read_gives_the_same_bytes)
{
    const HandDomain hand = with_refined_carrier(sphere_cube(0, 4));
    ConvertOptions options = options_for({hand});
    options.outputs = {path("a.3dm"), path("a.step")};
    options.domain_out = path("out.json");
    Context first;
    ASSERT_TRUE(convert(options, first));
    EXPECT_EQ(read_file(path("out.json")), read_file(path("domain.json")));

    options.outputs = {path("b.3dm")};
    options.domain_in = path("out.json");
    options.domain_out.reset();
    Context second;
    ASSERT_TRUE(convert(options, second));
    EXPECT_EQ(read_file(path("a.3dm")), read_file(path("b.3dm")));
}

TEST_F(ConvertTest, the_bytes_do_not_depend_on_the_number_of_threads)
{
    ConvertOptions options = options_for({sphere_cube(1, 8), moved(torus_grid(), 1, {5, 0, 0})});
    Names bytes;
    for (const unsigned threads : {1u, 2u, 8u}) {
        options.outputs = {path("a.3dm"), path("a.step"), path("a.brep")};
        options.tessellation = path("a.ply");
        Context context;
        context.threads = threads;
        ASSERT_TRUE(convert(options, context));
        bytes.push_back("");
        for (const char* name : {"a.3dm", "a.step", "a.brep", "a.ply"})
            bytes.back() += read_file(path(name));
    }
    EXPECT_EQ(bytes[0], bytes[1]);
    EXPECT_EQ(bytes[0], bytes[2]);
}

TEST_F(ConvertTest, relative_errors_do_not_depend_on_scale_and_place)
{
    std::vector<double> rms;
    for (const double scale : {1.0, 1e-6, 1e6}) {
        ConvertOptions options =
            options_for({moved(sphere_cube(1, 8), scale, scale * Vec3{3, -2, 7})});
        options.outputs = {path("a.3dm")};
        Context context;
        const Result<ConvertReport> report = convert(options, context);
        ASSERT_TRUE(report) << report.error().message;
        EXPECT_TRUE(report->solid());
        EXPECT_LE(report->components[0].continuity.max_g1_angle_deg, 1e-8);
        rms.push_back(report->deviation().rms() / report->diagonal);
    }
    // The coordinates themselves are rounded differently; the fit amplifies that a little.
    EXPECT_NEAR(rms[1], rms[0], 1e-6 * rms[0]);
    EXPECT_NEAR(rms[2], rms[0], 1e-6 * rms[0]);
}

TEST_F(ConvertTest, the_volume_is_that_of_the_mesh_in_place_and_scale)
{
    const HandDomain hand = moved(sphere_cube(1, 16), 250.0, {1000, 2000, -500});
    ConvertOptions options = options_for({hand});
    options.outputs = {path("a.3dm")};
    Context context;
    const Result<ConvertReport> report = convert(options, context);
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_NEAR(report->components[0].brep.volume, hand.mesh.volume(), 2e-3 * hand.mesh.volume());
}

TEST_F(ConvertTest, two_components_become_two_solids_of_one_file)
{
    ConvertOptions options = options_for({sphere_cube(0, 8), moved(torus_grid(), 2, {9, 0, 0})});
    options.outputs = {path("a.brep")};
    Context context;
    const Result<ConvertReport> report = convert(options, context);
    ASSERT_TRUE(report) << report.error().message;
    ASSERT_EQ(report->components.size(), 2u);
    EXPECT_TRUE(report->solid());
    EXPECT_EQ(report->components[0].genus, 0);
    EXPECT_EQ(report->components[1].genus, 1);
    EXPECT_EQ(report->components[0].brep_faces, 6u);
    EXPECT_EQ(report->components[1].brep_faces, 24u);
    EXPECT_EQ(report->outputs.size(), 1u);
}

TEST_F(ConvertTest, a_domain_of_another_mesh_is_refused_and_nothing_is_written)
{
    const HandDomain hand = sphere_cube(0, 8);
    ConvertOptions options = options_for({hand});
    write_file(path("mesh.off"), off_text({moved(hand, 1.0, {1e-9, 0, 0}).mesh}));
    options.outputs = {path("a.3dm")};
    Context context;
    const Result<ConvertReport> report = convert(options, context);
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().code, ErrorCode::stale_domain);
    EXPECT_EQ(files(), (Names{"domain.json", "mesh.off"}));

    const Result<DomainFileReport> checked = check_domain(options, context);
    ASSERT_TRUE(checked);
    ASSERT_TRUE(checked->rejection);
    EXPECT_EQ(checked->rejection->code, ErrorCode::stale_domain);
}

TEST_F(ConvertTest, a_domain_that_breaks_a_rule_is_refused_by_name)
{
    HandDomain hand = sphere_cube(0, 8);
    // The first path loses its inner points: it jumps over faces.
    hand.domain.edges[0].path.clear();
    ConvertOptions options = options_for({hand});
    options.outputs = {path("a.3dm")};
    Context context;
    const Result<ConvertReport> report = convert(options, context);
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().code, ErrorCode::invalid_domain);
    EXPECT_NE(report.error().message.find("domain.json"), std::string::npos);

    const Result<DomainFileReport> checked = check_domain(options, context);
    ASSERT_TRUE(checked);
    ASSERT_TRUE(checked->rejection);
    ASSERT_EQ(checked->components.size(), 1u);
    EXPECT_FALSE(checked->components[0].valid());
}

TEST_F(ConvertTest, check_domain_accepts_what_convert_accepts)
{
    const ConvertOptions options = options_for({genus2_voxels()});
    Context context;
    const Result<DomainFileReport> checked = check_domain(options, context);
    ASSERT_TRUE(checked) << checked.error().message;
    EXPECT_FALSE(checked->rejection);
    EXPECT_EQ(checked->components[0].quads, 50u);
    EXPECT_EQ(checked->components[0].euler_characteristic, -2);
    EXPECT_GT(checked->components[0].charts.min_jacobian, 0.0);
}

TEST_F(ConvertTest, an_open_mesh_becomes_an_open_surface_with_a_warning_unless_it_was_expected)
{
    for (const Closure closure : {Closure::as_input, Closure::open}) {
        ConvertOptions options = options_for({open_cylinder()});
        options.domain_in.reset();
        options.outputs = {path("a.3dm"), path("a.step")};
        options.closure = closure;
        Context context;
        const Result<ConvertReport> report = convert(options, context);
        ASSERT_TRUE(report) << report.error().message;
        EXPECT_TRUE(report->valid());
        EXPECT_FALSE(report->solid());
        EXPECT_GE(report->components[0].brep.boundary_edges, 8u);
        const bool warned = std::any_of(report->warnings.begin(), report->warnings.end(),
                                        [](const Warning& w) { return w.code == "open"; });
        EXPECT_EQ(warned, closure == Closure::as_input);
    }
}

TEST_F(ConvertTest, two_patches_at_a_reflex_corner_lie_as_the_source_has_them)
{
    // With and without refinement: the angles of corners go to the fit on two ways.
    for (const bool refine : {false, true}) {
        ConvertOptions options = options_for({plane_l()});
        options.outputs = {path("a.3dm")};
        options.closure = Closure::open;
        if (refine)
            options.tolerance = Length{1e-3, true};
        Context context;
        const Result<ConvertReport> report = convert(options, context);
        ASSERT_TRUE(report) << report.error().message;
        EXPECT_LT(report->deviation().max(), 1e-3 * report->diagonal);
        EXPECT_EQ(report->components[0].brep_faces, 2u); // No need to cut them.
    }
}

TEST_F(ConvertTest, an_open_mesh_is_refused_as_a_solid_with_its_loops)
{
    ConvertOptions options = options_for({open_cylinder()});
    options.outputs = {path("a.3dm")};
    options.closure = Closure::solid;
    Context context;
    const Result<ConvertReport> report = convert(options, context);
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().code, ErrorCode::open_mesh);
    EXPECT_NE(report.error().message.find("2 boundary loops"), std::string::npos)
        << report.error().message;
    EXPECT_NE(report.error().element, invalid_index);
    EXPECT_EQ(files(), (Names{"domain.json", "mesh.off"}));
}

TEST_F(ConvertTest, crossing_components_are_a_warning_and_with_strict_an_error)
{
    ConvertOptions options =
        options_for({sphere_cube(0, 8), moved(sphere_cube(0, 8), 1.0, {0.31, 0.17, 0.53})});
    options.outputs = {path("a.3dm")};
    Context context;
    const Result<ConvertReport> report = convert(options, context);
    ASSERT_TRUE(report) << report.error().message;
    ASSERT_FALSE(report->warnings.empty());
    EXPECT_EQ(report->warnings[0].code, "self_intersection");

    options.strict = true;
    Context strict_context;
    const Result<ConvertReport> strict = convert(options, strict_context);
    ASSERT_FALSE(strict);
    EXPECT_EQ(strict.error().code, ErrorCode::self_intersecting);
}

TEST_F(ConvertTest, without_repair_an_input_that_needs_some_is_refused)
{
    // A sphere with one face turned over.
    const ManifoldMesh sphere = sphere_cube(0, 4).mesh;
    std::string text = off_text({sphere});
    const auto& t = sphere.triangles().back();
    const std::string last = fmt::format("3 {} {} {}\n", t[0], t[1], t[2]);
    ASSERT_EQ(text.substr(text.size() - last.size()), last);
    text.replace(text.size() - last.size(), last.size(),
                 fmt::format("3 {} {} {}\n", t[0], t[2], t[1]));
    write_file(path("mesh.off"), text);
    ConvertOptions options;
    options.input = path("mesh.off");
    Context context;
    const Result<InputReport> mended = check_input(options, context);
    ASSERT_TRUE(mended);
    EXPECT_FALSE(mended->rejection);
    EXPECT_FALSE(mended->repairs.empty());
    options.repair = false;
    const Result<InputReport> refused = check_input(options, context);
    ASSERT_TRUE(refused);
    ASSERT_TRUE(refused->rejection);
    EXPECT_EQ(refused->rejection->code, ErrorCode::bad_geometry);
}

TEST_F(ConvertTest, triangles_that_do_not_meet_are_refused_by_name_and_welded_on_request)
{
    // Every face of a sphere with corners of its own, each moved by up to 1e-6.
    const ManifoldMesh sphere = sphere_cube(0, 8).mesh;
    std::string text = fmt::format("OFF\n{} {} 0\n", 3 * sphere.face_count(), sphere.face_count());
    for (Index f = 0; f < sphere.face_count(); ++f)
        for (Index k = 0; k < 3; ++k) {
            const Vec3& p = sphere.position(sphere.triangle(f)[k]);
            const double shift = 1e-6 * ((7 * f + 3 * k) % 11) / 11.0;
            text += fmt::format("{:.17g} {:.17g} {:.17g}\n", p.x + shift, p.y - shift, p.z);
        }
    for (Index f = 0; f < sphere.face_count(); ++f)
        text += fmt::format("3 {} {} {}\n", 3 * f, 3 * f + 1, 3 * f + 2);
    write_file(path("mesh.off"), text);
    ConvertOptions options;
    options.input = path("mesh.off");
    Context context;
    const Result<InputReport> loose = check_input(options, context);
    ASSERT_TRUE(loose && loose->rejection);
    EXPECT_EQ(loose->rejection->code, ErrorCode::bad_geometry);
    EXPECT_NE(loose->rejection->message.find("--weld"), std::string::npos);
    for (const Length weld : {Length{1e-5, false}, Length{3e-6, true}}) {
        options.weld = weld;
        const Result<InputReport> welded = check_input(options, context);
        ASSERT_TRUE(welded);
        EXPECT_FALSE(welded->rejection) << welded->rejection->message;
        EXPECT_FALSE(welded->repairs.empty());
    }
    options.weld = Length{0.2, true};
    const Result<InputReport> all = check_input(options, context);
    ASSERT_TRUE(all && all->rejection); // Nothing would be left.
    EXPECT_EQ(all->rejection->code, ErrorCode::bad_option);
}

TEST_F(ConvertTest, a_flat_mesh_that_is_closed_by_filling_is_refused)
{
    write_file(path("mesh.off"), "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    ConvertOptions options;
    options.input = path("mesh.off");
    options.fill_holes = Length{1.0, true};
    Context context;
    const Result<InputReport> report = check_input(options, context);
    ASSERT_TRUE(report && report->rejection);
    EXPECT_EQ(report->rejection->code, ErrorCode::bad_geometry);
    EXPECT_NE(report->rejection->message.find("no volume"), std::string::npos);
}

TEST_F(ConvertTest, a_cancelled_conversion_writes_nothing_whenever_it_is_cancelled)
{
    ConvertOptions options = options_for({sphere_cube(1, 16)});
    options.outputs = {path("a.3dm"), path("a.step")};
    for (const char* stage : {"read", "check", "repair", "domain", "layout", "charts", "samples",
                              "fit", "measure", "bound", "brep", "write"}) {
        Context context;
        bool reached = false;
        context.on_progress = [&](const std::string& name, double) {
            if (name == stage) {
                reached = true;
                context.cancel();
            }
        };
        const Result<ConvertReport> report = convert(options, context);
        EXPECT_TRUE(reached) << stage;
        ASSERT_FALSE(report) << stage;
        EXPECT_EQ(report.error().code, ErrorCode::cancelled) << stage;
        EXPECT_EQ(files(), (Names{"domain.json", "mesh.off"})) << stage;
    }
}

TEST_F(ConvertTest, options_that_cannot_work_are_refused_before_anything_is_read)
{
    const auto code_of = [&](const std::function<void(ConvertOptions&)>& change) {
        ConvertOptions options;
        options.input = path("absent.off");
        options.outputs = {path("a.3dm")};
        change(options);
        const std::optional<Error> error = options.check();
        return error ? std::string(name(error->code)) : std::string("accepted");
    };
    EXPECT_EQ(code_of([](ConvertOptions&) {}), "accepted");
    EXPECT_EQ(code_of([](ConvertOptions& o) { o.input.clear(); }), "bad_option");
    EXPECT_EQ(code_of([](ConvertOptions& o) { o.outputs.clear(); }), "bad_option");
    EXPECT_EQ(code_of([&](ConvertOptions& o) { o.outputs = {path("a.xyz")}; }), "bad_option");
    EXPECT_EQ(code_of([&](ConvertOptions& o) {
                  o.outputs = {path("a.3dm"), path("a.3dm")};
              }),
              "bad_option");
    EXPECT_EQ(code_of([](ConvertOptions& o) { o.patches = 5; }), "bad_option");
    EXPECT_EQ(code_of([](ConvertOptions& o) { o.tolerance = Length{0.0, true}; }), "bad_option");
    EXPECT_EQ(code_of([](ConvertOptions& o) { o.max_patches = 100; }), "bad_option");
    EXPECT_EQ(code_of([](ConvertOptions& o) { o.fit.max_rounds = 0; }), "bad_option");
    EXPECT_EQ(code_of([](ConvertOptions& o) { o.write.units = "furlong"; }), "bad_option");
    EXPECT_EQ(code_of([](ConvertOptions& o) { o.write.archive_version = 71; }), "bad_option");
    EXPECT_EQ(code_of([](ConvertOptions& o) {
                  o.spline = SplineScheme::eck_hoppe;
                  o.knots = KnotForm::c1;
              }),
              "bad_option");
    EXPECT_EQ(code_of([&](ConvertOptions& o) { o.outputs = {path("no/folder/a.3dm")}; }),
              "cannot_write");
    EXPECT_EQ(code_of([&](ConvertOptions& o) {
                  std::filesystem::create_directory(path("d.3dm"));
                  o.outputs = {path("d.3dm")};
              }),
              "cannot_write");
}

TEST_F(ConvertTest, the_output_never_replaces_the_input)
{
    ConvertOptions options = options_for({sphere_cube(0, 4)});
    options.outputs = {path("a.3dm")};
    options.domain_out = path("mesh.off");
    const std::optional<Error> error = options.check();
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code, ErrorCode::bad_option);
}

TEST_F(ConvertTest, both_splines_convert_a_supplied_domain)
{
    ConvertOptions options = options_for({sphere_cube(1, 8)});
    options.spline = SplineScheme::eck_hoppe;
    options.outputs = {path("a.3dm"), path("a.step")};
    Context context;
    const Result<ConvertReport> report = convert(options, context);
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_TRUE(report->solid());
    EXPECT_LE(report->components[0].continuity.max_g1_angle_deg, 1e-8);
}

TEST_F(ConvertTest, the_tessellation_lies_on_the_surface_and_knows_its_valences)
{
    ConvertOptions options = options_for({sphere_cube(0, 16)});
    options.tessellation = path("a.ply");
    Context context;
    const Result<ConvertReport> report = convert(options, context);
    ASSERT_TRUE(report) << report.error().message;
    const std::string text = read_file(path("a.ply"));
    const std::size_t data = text.find("end_header\n") + 11;
    ASSERT_NE(text.find("element vertex 1014\n"), std::string::npos); // 6 patches of 13 x 13.
    ASSERT_NE(text.find("element face 1728\n"), std::string::npos);   // 6 of 2 x 12 x 12.
    constexpr std::size_t vertex = 56, face = 13;
    ASSERT_EQ(text.size(), data + 1014 * vertex + 1728 * face);
    int corners = 0;
    for (std::size_t i = 0; i < 1014; ++i) {
        double p[3];
        float f[6];
        std::int32_t n[2];
        std::memcpy(p, &text[data + i * vertex], sizeof p);
        std::memcpy(f, &text[data + i * vertex + 24], sizeof f);
        std::memcpy(n, &text[data + i * vertex + 48], sizeof n);
        const Vec3 position{p[0], p[1], p[2]}, normal{f[0], f[1], f[2]};
        // Six patches are within 0.3 % of the diameter of the sphere (docs/algorithms/spline.md).
        EXPECT_NEAR(norm(position), 1.0, 0.006);
        EXPECT_GT(dot(normal, position), 0.98);
        EXPECT_LT(std::fabs(f[5]), 0.012);
        EXPECT_EQ(static_cast<std::size_t>(n[0]), i / 169);
        corners += n[1] == 3;
        EXPECT_TRUE(n[1] == 0 || n[1] == 3);
    }
    EXPECT_EQ(corners, 24);
}

} // namespace
} // namespace bot2nurbs::test
