// SPDX-License-Identifier: MIT
#include "bot2nurbs/read_mesh.h"
#include "convert_fixtures.h"
#include "mesh_fixtures.h"

namespace bot2nurbs::test {
namespace {

namespace fx = bot2nurbs::fixtures;

// OBJ text of the pairs of triangles of a mesh as quads, each position replaced by f(position).
template <class F> std::string quads_text(const ManifoldMesh& pairs, const F& f, Index first = 1)
{
    std::string text;
    for (Vec3 p : pairs.positions()) {
        p = f(p);
        text += fmt::format("v {:.17g} {:.17g} {:.17g}\n", p.x, p.y, p.z);
    }
    for (Index t = 0; t < pairs.face_count(); t += 2) {
        const auto& a = pairs.triangle(t);
        text += fmt::format("f {} {} {} {}\n", first + a[0], first + a[1], first + a[2],
                            first + pairs.triangle(t + 1)[2]);
    }
    return text;
}
const auto as_it_is = [](const Vec3& p) { return p; };
const auto on_ball = [](const Vec3& p) { return normalized(p); };

class QuadsTest : public ConvertTest {
protected:
    ConvertOptions options(const std::string& quads, const std::vector<ManifoldMesh>& meshes) const
    {
        write_file(path("mesh.off"), off_text(meshes));
        write_file(path("quads.obj"), quads);
        ConvertOptions options;
        options.input = path("mesh.off");
        options.quads = path("quads.obj");
        options.outputs = {path("a.3dm")};
        return options;
    }
    ConvertOptions cage(const std::string& quads) const
    {
        write_file(path("cage.obj"), quads);
        ConvertOptions options;
        options.input = path("cage.obj");
        options.cage = true;
        options.outputs = {path("a.3dm"), path("a.step")};
        return options;
    }
};

void expect_error(const ConvertOptions& options, ErrorCode code, const std::string& words)
{
    Context context;
    const Result<ConvertReport> report = convert(options, context);
    ASSERT_FALSE(report) << words;
    EXPECT_EQ(report.error().code, code) << report.error().message;
    EXPECT_NE(report.error().message.find(words), std::string::npos) << report.error().message;
}

TEST_F(QuadsTest, become_the_patches_of_a_solid)
{
    const ConvertOptions o = options(quads_text(fx::cube(3), on_ball), {fx::icosphere(4)});
    Context context;
    const Result<ConvertReport> report = convert(o, context);
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_TRUE(report->solid());
    const ComponentOutcome& c = report->components[0];
    EXPECT_EQ(c.brep_faces, 54u);
    EXPECT_EQ(c.domain.source, "quads");
    EXPECT_LE(c.continuity.max_g1_angle_deg, 1e-8);
    EXPECT_LT(c.deviation.rms(), 2e-4 * c.diagonal);
    ASSERT_TRUE(c.quads);
    // The sphere's facets are at most this far inside it.
    EXPECT_LT(c.quads->largest_move, 0.05);
    // An arc of 37 degrees is 1.02 times its chord; paths are straight in maps, not on the ball.
    EXPECT_GE(c.quads->largest_detour, 1.01);
    EXPECT_LT(c.quads->largest_detour, 1.25);
    EXPECT_FALSE(c.layout);
}

TEST_F(QuadsTest, patches_have_the_order_of_the_quads)
{
    const ManifoldMesh cube = fx::cube(2);
    const ConvertOptions o = options(quads_text(cube, on_ball), {fx::icosphere(3)});
    ConvertOptions with_domain = o;
    with_domain.domain_out = path("domain.json");
    Context context;
    ASSERT_TRUE(convert(with_domain, context));
    const auto domains = domains_from_json(read_file(path("domain.json")), {fx::icosphere(3)});
    ASSERT_TRUE(domains);
    const QuadDomain& d = domains->front();
    for (Index q = 0; q < d.complex.quad_count(); ++q) {
        Vec3 placed, given;
        for (const Index v : d.complex.quad(q))
            placed += 0.25 * d.carrier.mesh.position(d.vertices[v]);
        for (const Index v : {cube.triangle(2 * q)[0], cube.triangle(2 * q)[1],
                              cube.triangle(2 * q)[2], cube.triangle(2 * q + 1)[2]})
            given += 0.25 * normalized(cube.position(v));
        EXPECT_LT(norm(placed - given), 0.1);
    }
}

TEST_F(QuadsTest, pieces_find_their_components_in_any_order)
{
    const auto away = [](const Vec3& p) { return p + Vec3{5, 0, 0}; };
    const ManifoldMesh cube = fx::cube(2);
    const std::string quads =
        quads_text(fx::torus(8, 5), away) + quads_text(cube, on_ball, 1 + 8 * 5);
    const ConvertOptions o = options(quads, {fx::icosphere(3), fx::moved(fx::torus(20, 12), away)});
    Context context;
    const Result<ConvertReport> report = convert(o, context);
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_EQ(report->components[0].brep_faces, 24u);
    EXPECT_EQ(report->components[1].brep_faces, 40u);
    EXPECT_EQ(report->components[1].brep.genus(), 1);
}

TEST_F(QuadsTest, that_do_not_fit_are_refused_with_a_reason)
{
    const ManifoldMesh ball = fx::icosphere(2);
    expect_error(options(quads_text(fx::torus(6, 4), as_it_is), {ball}), ErrorCode::invalid_domain,
                 "genus");
    expect_error(options(quads_text(fx::cube(2), on_ball) + "f 1 2 3\n", {ball}),
                 ErrorCode::invalid_domain, "quads.obj");
    expect_error(
        options(quads_text(fx::cube(2), on_ball), {ball, fx::moved(ball,
                                                                   [](const Vec3& p) {
                                                                       return p + Vec3{4, 0, 0};
                                                                   })}),
        ErrorCode::invalid_domain, "connected piece");
    ConvertOptions missing = options("", {ball});
    missing.quads = path("none.obj");
    expect_error(missing, ErrorCode::cannot_read, "none.obj");
}

TEST_F(QuadsTest, a_long_way_round_is_a_warning_with_the_edge)
{
    // A plate with a slot: the quads' edge across the slot must run around its end.
    std::vector<std::array<int, 3>> cells;
    for (int i = 0; i < 8; ++i)
        for (int j = 0; j < 5; ++j)
            if (j != 2 || i == 0)
                cells.push_back({i, j, 0});
    const ManifoldMesh slotted = fx::split_in_four(fx::polycube(cells));
    const ManifoldMesh block = fx::polycube({{0, 0, 0}});
    ConvertOptions o = options(quads_text(block,
                                          [](const Vec3& p) {
                                              return Vec3{8 * p.x, 2 + p.y, p.z};
                                          }),
                               {slotted});
    o.features = FeatureMode::off;
    o.domain_out = path("domain.json");
    o.outputs.clear();
    Context context;
    const Result<ConvertReport> report = convert(o, context);
    ASSERT_TRUE(report) << report.error().message;
    ASSERT_TRUE(report->components[0].quads);
    EXPECT_GT(report->components[0].quads->largest_detour, 4.0);
    const bool told = std::any_of(report->warnings.begin(), report->warnings.end(),
                                  [](const Warning& w) { return w.code == "layout_detour"; });
    EXPECT_TRUE(told);
}

TEST_F(QuadsTest, a_cage_becomes_its_subdivision_surface)
{
    const ConvertOptions o = cage(quads_text(fx::cube(1), as_it_is));
    Context context;
    const Result<ConvertReport> report = convert(o, context);
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_TRUE(report->solid());
    EXPECT_EQ(report->input_faces, 6u);
    const ComponentOutcome& c = report->components[0];
    EXPECT_EQ(c.brep_faces, 6u);
    EXPECT_EQ(c.domain.source, "cage");
    EXPECT_LE(c.continuity.max_g1_angle_deg, 1e-8);
    // Corners of the limit surface are at (1/2, 1/2, 1/2), middles of faces at 0.75 or less.
    EXPECT_GT(c.brep.volume, 1.0);
    EXPECT_LT(c.brep.volume, 1.5 * 1.5 * 1.5);
    EXPECT_LT(c.deviation.rms(), 3e-4 * c.diagonal);
}

TEST_F(QuadsTest, open_cages_and_several_are_converted_as_they_are)
{
    const ManifoldMesh cylinder = fx::open_cylinder(6, 3);
    const auto away = [](const Vec3& p) { return p + Vec3{5, 0, 0}; };
    const ConvertOptions o = cage(quads_text(cylinder, as_it_is) +
                                  quads_text(fx::genus_two(0), away, 1 + cylinder.vertex_count()));
    Context context;
    const Result<ConvertReport> report = convert(o, context);
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_TRUE(report->valid());
    EXPECT_EQ(report->components[0].boundary_loops, 2u);
    EXPECT_FALSE(report->components[0].brep.solid);
    EXPECT_TRUE(report->components[1].brep.solid);
    EXPECT_EQ(report->components[1].brep.genus(), 2);
    for (const ComponentOutcome& c : report->components)
        EXPECT_LE(c.continuity.max_g1_angle_deg, 1e-8);

    ConvertOptions solid = o;
    solid.closure = Closure::solid;
    expect_error(solid, ErrorCode::open_mesh, "boundary loops");
}

TEST_F(QuadsTest, options_that_contradict_quads_and_cages_are_refused)
{
    const std::string ball = quads_text(fx::cube(2), on_ball);
    ConvertOptions o = options(ball, {fx::icosphere(2)});
    o.patches = 20;
    expect_error(o, ErrorCode::bad_option, "--layout quads");
    o = options(ball, {fx::icosphere(2)});
    o.domain_in = path("d.json");
    expect_error(o, ErrorCode::bad_option, "--domain-in");
    o = options(ball, {fx::icosphere(2)});
    o.domain_out = o.quads;
    expect_error(o, ErrorCode::bad_option, "overwritten");
    o = cage(ball);
    o.domain_out = path("d.json");
    expect_error(o, ErrorCode::bad_option, "--domain-out");
    o = cage(ball);
    o.strict = true;
    expect_error(o, ErrorCode::bad_option, "--strict");
}

TEST_F(QuadsTest, the_ellipsoid_of_a_field_aligned_layout_is_fitted_closely)
{
    const std::string folder = std::string(BOT2NURBS_SHARED) + "/data/meshes/smooth/";
    if (!std::filesystem::exists(folder + "ellipse_quads.obj"))
        GTEST_SKIP() << "no models at " << folder;
    ConvertOptions o;
    o.input = folder + "ellipse.obj";
    o.quads = folder + "ellipse_quads.obj";
    o.outputs = {path("a.3dm")};
    Context context;
    const Result<ConvertReport> report = convert(o, context);
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_TRUE(report->solid());
    EXPECT_EQ(report->components[0].brep_faces, 552u);
    EXPECT_LE(report->components[0].continuity.max_g1_angle_deg, 1e-8);
    EXPECT_LT(report->deviation().rms(), 1e-4 * report->diagonal);
}

TEST_F(QuadsTest, the_quads_that_the_triangles_of_a_model_come_in_run_along_its_edges)
{
    const std::string model = std::string(BOT2NURBS_SHARED) + "/data/meshes/smooth/spot.obj";
    if (!std::filesystem::exists(model))
        GTEST_SKIP() << "no model " << model;
    Context context;
    const Result<TriangleSoup> spot = read_mesh(model, context);
    ASSERT_TRUE(spot);
    std::string quads;
    for (const Vec3& p : spot->positions)
        quads += fmt::format("v {:.17g} {:.17g} {:.17g}\n", p.x, p.y, p.z);
    // Triangles (a, b, c) and (d, c, b).
    for (std::size_t t = 0; t < spot->triangles.size(); t += 2) {
        const auto& [a, b, c] = spot->triangles[t];
        quads += fmt::format("f {} {} {} {}\n", a + 1, b + 1, spot->triangles[t + 1][0] + 1, c + 1);
    }
    write_file(path("quads.obj"), quads);
    ConvertOptions o;
    o.input = model;
    o.quads = path("quads.obj");
    o.features = FeatureMode::off;
    o.domain_out = path("domain.json");
    const Result<ConvertReport> report = convert(o, context);
    ASSERT_TRUE(report) << report.error().message;
    const ComponentOutcome& c = report->components[0];
    EXPECT_EQ(c.domain.faces, 2928u);
    EXPECT_EQ(c.quads->largest_move, 0.0);
    EXPECT_LT(c.quads->largest_detour, 1.0 + 1e-12);
}

} // namespace
} // namespace bot2nurbs::test
