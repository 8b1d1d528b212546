// SPDX-License-Identifier: MIT
// Open CASCADE reads our STEP and .brep files and finds in them what we put there.
#include "bot2nurbs/write_brep.h"

#include "brep/brep_fixtures.h"
#include "judges/run_judge.h"

namespace bot2nurbs {
namespace {

using namespace fixtures;
using judges::judge_occ;
using judges::ScratchFolder;
using judges::Verdict;

enum class Format { step, brep };

// Volumes are exact on our side; Open CASCADE integrates to 1e-9.
constexpr double volume_share = 1e-7;
// Millimetres in a unit, because Open CASCADE measures STEP files in millimetres.
constexpr double millimetres_per_metre = 1e3;

std::string write(const ScratchFolder& folder, const std::vector<Brep>& breps, Format format,
                  const WriteOptions& options = {})
{
    const std::string file = folder.file(format == Format::step ? "out.step" : "out.brep");
    const Status error = format == Format::step ? write_step(breps, file, options)
                                                : write_occ_brep(breps, file, options);
    EXPECT_FALSE(error) << error->message;
    return file;
}

std::string number(double x)
{
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.17g", x);
    return text.data();
}

void expect_solid(const Verdict& verdict, const Brep& brep)
{
    EXPECT_EQ(verdict.exit_code, 0) << verdict.json;
    EXPECT_EQ(verdict.json["valid"], true);
    EXPECT_EQ(verdict.json["closed"], true);
    EXPECT_EQ(verdict.json["faces"], brep.faces.size());
    EXPECT_EQ(verdict.json["edges"], brep.edges.size());
    EXPECT_EQ(verdict.json["vertices"], brep.vertices.size());
    EXPECT_EQ(verdict.json["free_edges"], 0);
}

std::string wanted(const Brep& brep, double scale = 1.0)
{
    const double volume = check_brep(brep).volume * scale * scale * scale;
    return "--solids 1 --closed --tolerance-share 1e-6 --volume " + number(volume) +
           " --volume-share " + number(volume_share);
}

TEST(OpenCascade, finds_spheres_valid_closed_solids_in_both_knot_forms_schemas_and_formats)
{
    for (KnotForm form : {KnotForm::paper, KnotForm::c1}) {
        const Brep sphere = sphere_brep(1, form);
        const ScratchFolder folder;
        for (StepSchema schema : {StepSchema::ap242, StepSchema::ap214}) {
            WriteOptions options;
            options.step_schema = schema;
            const std::string file = write(folder, {sphere}, Format::step, options);
            expect_solid(judge_occ(file, wanted(sphere)), sphere);
        }
        const std::string file = write(folder, {sphere}, Format::brep);
        expect_solid(judge_occ(file, wanted(sphere)), sphere);
    }
}

TEST(OpenCascade, finds_higher_genus_and_extraordinary_vertices_valid)
{
    for (const Domain& d : {torus_grid(5, 4), genus2(), split_bipyramid(6), split_bipyramid(5)}) {
        const Brep brep = brep_of(d, KnotForm::c1);
        const ScratchFolder folder;
        for (Format format : {Format::step, Format::brep}) {
            SCOPED_TRACE(d.name);
            expect_solid(judge_occ(write(folder, {brep}, format), wanted(brep)), brep);
        }
    }
}

TEST(OpenCascade, finds_turned_faces_valid_and_outward)
{
    const Domain d = sphere_cube(1);
    Quads quads = d.complex.quads();
    for (auto& q : quads)
        std::reverse(q.begin(), q.end());
    const Brep brep =
        brep_of(make_domain("turned", d.positions, quads), KnotForm::c1, to_unit_sphere);
    ASSERT_TRUE(brep.faces[0].reversed);
    const ScratchFolder folder;
    for (Format format : {Format::step, Format::brep})
        expect_solid(judge_occ(write(folder, {brep}, format), wanted(brep)), brep);
}

TEST(OpenCascade, finds_models_of_a_micrometre_and_of_a_kilometre_valid)
{
    for (double scale : {1e-3, 1.0, 1e6}) {
        Brep brep = sphere_brep(1, KnotForm::c1);
        transform(brep, scale, {scale, -3 * scale, 0});
        const ScratchFolder folder;
        for (Format format : {Format::step, Format::brep}) {
            SCOPED_TRACE(scale);
            expect_solid(judge_occ(write(folder, {brep}, format), wanted(brep)), brep);
        }
    }
}

TEST(OpenCascade, finds_coordinates_unscaled_in_the_unit_of_the_file)
{
    const Brep sphere = sphere_brep(0, KnotForm::c1);
    const ScratchFolder folder;
    WriteOptions options;
    options.units = "m";
    const Verdict metres = judge_occ(write(folder, {sphere}, Format::step, options),
                                     wanted(sphere, millimetres_per_metre));
    expect_solid(metres, sphere);
    EXPECT_EQ(metres.json["units"], nlohmann::json::array({"metre"}));
    options.units = "in";
    const Verdict inches =
        judge_occ(write(folder, {sphere}, Format::step, options), wanted(sphere, 25.4));
    expect_solid(inches, sphere);
    EXPECT_EQ(inches.json["units"], nlohmann::json::array({"INCH"}));
}

TEST(OpenCascade, finds_two_solids_in_one_file)
{
    Brep first = sphere_brep(1, KnotForm::c1), second = brep_of(torus_grid(4, 4), KnotForm::c1);
    transform(second, 0.5, {5, 0, 0});
    const double volume = check_brep(first).volume + check_brep(second).volume;
    const ScratchFolder folder;
    for (Format format : {Format::step, Format::brep}) {
        const Verdict verdict =
            judge_occ(write(folder, {first, second}, format),
                      "--solids 2 --closed --tolerance-share 1e-6 --volume " + number(volume) +
                          " --volume-share " + number(volume_share));
        EXPECT_EQ(verdict.exit_code, 0) << verdict.json;
        EXPECT_EQ(verdict.json["shells"], 2);
        EXPECT_EQ(verdict.json["faces"], first.faces.size() + second.faces.size());
    }
}

TEST(OpenCascade, finds_separate_parts_of_one_brep_as_solids_and_inward_ones_as_hollows)
{
    Brep brep = sphere_brep(1, KnotForm::c1), hollow = brep, beside = brep;
    transform(hollow, 0.5, {0.1, 0, 0});
    for (BrepFace& f : hollow.faces)
        f.reversed = true;
    transform(beside, 0.25, {3, 0, 0});
    append(brep, hollow);
    append(brep, beside);
    const BrepReport report = check_brep(brep);
    ASSERT_TRUE(report.solid);
    const ScratchFolder folder;
    for (Format format : {Format::step, Format::brep}) {
        const Verdict verdict =
            judge_occ(write(folder, {brep}, format),
                      "--solids 2 --closed --tolerance-share 1e-6 --volume " +
                          number(report.volume) + " --volume-share " + number(volume_share));
        EXPECT_EQ(verdict.exit_code, 0) << verdict.json;
        EXPECT_EQ(verdict.json["shells"], 3);
    }
}

TEST(OpenCascade, finds_an_open_disk_a_valid_shell_with_free_edges)
{
    const Brep disk = brep_of(disk_grid(3, 2), KnotForm::c1);
    const ScratchFolder folder;
    for (Format format : {Format::step, Format::brep}) {
        const Verdict verdict =
            judge_occ(write(folder, {disk}, format), "--solids 0 --tolerance-share 1e-6");
        EXPECT_EQ(verdict.exit_code, 0) << verdict.json;
        EXPECT_EQ(verdict.json["shells"], 1);
        EXPECT_EQ(verdict.json["free_edges"], check_brep(disk).boundary_edges);
        EXPECT_EQ(verdict.json["closed"], false);
    }
}

TEST(OpenCascade, finds_a_face_with_a_seam_valid)
{
    const Brep tube = seam_tube();
    const ScratchFolder folder;
    for (Format format : {Format::step, Format::brep}) {
        const Verdict verdict =
            judge_occ(write(folder, {tube}, format), "--solids 0 --tolerance-share 1e-6");
        EXPECT_EQ(verdict.exit_code, 0) << verdict.json;
        EXPECT_EQ(verdict.json["faces"], 1);
        EXPECT_EQ(verdict.json["edges"], 3);
    }
}

// That the judge can say no.

TEST(OpenCascade, refuses_what_is_flipped_open_of_another_volume_or_loose)
{
    const Brep good = sphere_brep(0, KnotForm::c1);
    const ScratchFolder folder;
    const auto failures = [&](const Brep& brep, const std::string& arguments) {
        const Verdict verdict = judge_occ(write(folder, {brep}, Format::brep), arguments);
        EXPECT_EQ(verdict.exit_code, 1);
        return verdict.json["failed"];
    };
    Brep flipped = good;
    flipped.faces[2].reversed = true;
    EXPECT_EQ(failures(flipped, "")[0], "valid");

    Brep disk = brep_of(disk_grid(1, 1), KnotForm::c1);
    EXPECT_EQ(failures(disk, "--closed")[0], "closed");
    EXPECT_EQ(failures(disk, "--solids 1")[0], "solids");
    EXPECT_EQ(failures(good, "--volume 4.5 --volume-share 0.005")[0], "volume");

    // An edge a hundredth away from its faces: the STEP reader allows for it with its tolerance.
    Brep loose = good;
    loose.curves3[5].control[4].x += 0.01;
    const Verdict verdict =
        judge_occ(write(folder, {loose}, Format::step), "--tolerance-share 1e-6");
    EXPECT_EQ(verdict.exit_code, 1);
    EXPECT_EQ(verdict.json["failed"], nlohmann::json::array({"tolerance"})) << verdict.json;
}

TEST(OpenCascade, refuses_a_file_that_is_not_one)
{
    const ScratchFolder folder;
    std::ofstream(folder.file("bad.step")) << "ISO-10303-21;\nnothing\n";
    std::ofstream(folder.file("bad.brep")) << "nothing\n";
    EXPECT_EQ(judge_occ(folder.file("bad.step")).exit_code, 3);
    EXPECT_EQ(judge_occ(folder.file("bad.brep")).exit_code, 3);
    EXPECT_EQ(judge_occ(folder.file("missing.step")).exit_code, 3);
}

} // namespace
} // namespace bot2nurbs
