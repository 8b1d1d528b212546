// SPDX-License-Identifier: MIT
// openNURBS reads our .3dm files and finds in them what we put there.
#include "bot2nurbs/write_brep.h"

#include "brep/brep_fixtures.h"
#include "brep/bspline.h"
#include "judges/run_judge.h"

#include <cstring>
#include <set>

namespace bot2nurbs {
namespace {

using namespace fixtures;
using judges::judge_3dm;
using judges::ScratchFolder;
using judges::Verdict;

// Evaluating a bicubic patch in another program rounds differently; per unit of the model's size.
constexpr double evaluation_rounding = 1e-13;

//! A grid of places on every face with the positions we find there.
nlohmann::json places(const Brep& brep)
{
    nlohmann::json points = nlohmann::json::array();
    for (Index f = 0; f < brep.faces.size(); ++f) {
        const BsplinePatch& patch = brep.surfaces[brep.faces[f].surface];
        for (double u : {0.0, 0.4, 1.0, 1.7, 2.9, 4.0}) {
            for (double v : {0.0, 0.6, 2.0, 3.3, 4.0}) {
                const Vec3 p = evaluate_patch(patch, u, v).position;
                points.push_back({{"face", f}, {"u", u}, {"v", v}, {"position", {p.x, p.y, p.z}}});
            }
        }
    }
    return {{"points", points}};
}

Verdict write_and_judge(const std::vector<Brep>& breps, const WriteOptions& options)
{
    const ScratchFolder folder;
    const std::string file = folder.file("brep.3dm"), points = folder.file("points.json");
    const Status error = write_3dm(breps, file, options);
    EXPECT_FALSE(error) << error->message;
    nlohmann::json expected;
    for (const Brep& brep : breps)
        expected["objects"].push_back(places(brep));
    std::ofstream(points) << expected;
    return judge_3dm(file, "--points '" + points + "'");
}

void expect_good(const Verdict& verdict, const std::vector<Brep>& breps)
{
    EXPECT_EQ(verdict.exit_code, 0);
    ASSERT_EQ(verdict.json["objects"].size(), breps.size());
    EXPECT_EQ(verdict.json["layers"], nlohmann::json::array({"Default"}));
    for (std::size_t i = 0; i < breps.size(); ++i) {
        const Brep& brep = breps[i];
        const nlohmann::json& seen = verdict.json["objects"][i];
        EXPECT_EQ(seen["name"], brep.name);
        EXPECT_EQ(seen["isValid"], true) << seen["log"];
        EXPECT_EQ(seen["isManifold"], true);
        EXPECT_EQ(seen["isSolid"], brep.solid);
        EXPECT_EQ(seen["faces"], brep.faces.size());
        EXPECT_EQ(seen["edges"], brep.edges.size());
        EXPECT_EQ(seen["vertices"], brep.vertices.size());
        EXPECT_EQ(seen["trims"], brep.trims.size());
        EXPECT_EQ(seen["outerLoops"], brep.loops.size());
        EXPECT_EQ(seen["boundaryEdges"], check_brep(brep).boundary_edges);
        EXPECT_EQ(seen["nonmanifoldEdges"], 0);
        EXPECT_EQ(seen["inconsistentEdges"], 0);
        EXPECT_LE(seen["maxEndOffVertex"].get<double>(), evaluation_rounding);
        EXPECT_EQ(seen["comparedPoints"], 30 * brep.faces.size());
        EXPECT_LE(seen["maxPointError"].get<double>(), 10 * evaluation_rounding);
        EXPECT_EQ(seen["surface"]["order"], nlohmann::json::array({4, 4}));
        EXPECT_EQ(seen["surface"]["rational"], false);
        EXPECT_EQ(seen["surface"]["knots"], nlohmann::json(brep.surfaces[0].knots));
        const Index n = brep.surfaces[0].size;
        EXPECT_EQ(seen["surface"]["count"], nlohmann::json::array({n, n}));
    }
}

TEST(Rhino3dm, finds_spheres_valid_and_solid_in_every_archive_version_and_knot_form)
{
    for (KnotForm form : {KnotForm::paper, KnotForm::c1}) {
        const Brep sphere = sphere_brep(1, form);
        for (int version : {4, 50, 60, 70, 80}) {
            WriteOptions options;
            options.archive_version = version;
            const Verdict verdict = write_and_judge({sphere}, options);
            EXPECT_EQ(verdict.json["archiveVersion"], version);
            expect_good(verdict, {sphere});
        }
    }
}

TEST(Rhino3dm, finds_genus_one_and_two_valid_and_solid)
{
    for (const Domain& d : {torus_grid(5, 4), genus2()}) {
        for (KnotForm form : {KnotForm::paper, KnotForm::c1}) {
            const Brep brep = brep_of(d, form);
            expect_good(write_and_judge({brep}, {}), {brep});
        }
    }
}

TEST(Rhino3dm, finds_extraordinary_vertices_and_turned_faces_valid)
{
    const Domain d = split_bipyramid(7);
    Quads quads = d.complex.quads();
    for (auto& q : quads)
        std::reverse(q.begin(), q.end());
    const Brep turned = brep_of(make_domain("turned", d.positions, quads), KnotForm::c1);
    ASSERT_TRUE(turned.faces[0].reversed);
    expect_good(write_and_judge({turned}, {}), {turned});
}

TEST(Rhino3dm, finds_two_solids_in_one_file_with_their_names_and_different_ids)
{
    Brep first = sphere_brep(1, KnotForm::paper), second = first;
    first.name = "Erste \xC3\xA4\xE2\x82\xAC\xF0\x9F\x90\xB0";
    transform(second, 0.5, {5, 0, 0});
    second.name = "second";
    for (int version : {4, 50, 70}) {
        WriteOptions options;
        options.archive_version = version;
        const Verdict verdict = write_and_judge({first, second, first}, options);
        expect_good(verdict, {first, second, first});
        std::set<std::string> ids;
        for (const auto& object : verdict.json["objects"])
            ids.insert(object["id"]);
        EXPECT_EQ(ids.size(), 3u);
    }
}

TEST(Rhino3dm, finds_an_open_disk_valid_but_not_solid)
{
    for (int version : {4, 50, 60, 80}) {
        const Brep disk = brep_of(disk_grid(3, 2), KnotForm::c1);
        WriteOptions options;
        options.archive_version = version;
        expect_good(write_and_judge({disk}, options), {disk});
    }
}

TEST(Rhino3dm, finds_a_face_with_a_seam_valid)
{
    const Brep tube = seam_tube();
    expect_good(write_and_judge({tube}, {}), {tube});
}

TEST(Rhino3dm, finds_the_unit)
{
    const Brep sphere = sphere_brep(0, KnotForm::c1);
    const std::vector<std::pair<std::string, std::string>> units{
        {"", "Millimeters"},   {"um", "Microns"}, {"mm", "Millimeters"},
        {"cm", "Centimeters"}, {"m", "Meters"},   {"km", "Kilometers"},
        {"in", "Inches"},      {"ft", "Feet"},    {"mi", "Miles"}};
    for (const auto& [unit, name] : units) {
        WriteOptions options;
        options.units = unit;
        EXPECT_EQ(write_and_judge({sphere}, options).json["units"], name);
    }
}

// That the judge can say no.

TEST(Rhino3dm, refuses_a_file_with_one_wrong_bit)
{
    const Brep brep = sphere_brep(0, KnotForm::c1);
    for (int version : {4, 50}) {
        WriteOptions options;
        options.archive_version = version;
        const Result<std::string> good = brep_to_3dm({brep}, options);
        ASSERT_TRUE(good.ok());
        std::string number(sizeof(double), '\0');
        std::memcpy(number.data(), &brep.surfaces[2].control[37].x, number.size());
        const std::size_t at = good->find(number);
        ASSERT_NE(at, std::string::npos);
        std::string bad = *good;
        bad[at] = static_cast<char>(bad[at] ^ 0x10);
        const ScratchFolder folder;
        std::ofstream(folder.file("bad.3dm"), std::ios::binary) << bad;
        const Verdict verdict = judge_3dm(folder.file("bad.3dm"));
        EXPECT_EQ(verdict.exit_code, 3);
        EXPECT_EQ(verdict.json["readable"], false);
    }
}

TEST(Rhino3dm, finds_a_wrong_iso_flag_a_flipped_face_and_a_moved_vertex)
{
    const Brep good = sphere_brep(0, KnotForm::c1);
    Brep iso = good, flipped = good, moved = good;
    iso.trims[0].iso = TrimIso::north;
    flipped.faces[2].reversed = true;
    moved.vertices[3].point.x += 1e-3;
    const auto judged = [](const Brep& brep) {
        return write_and_judge({brep}, {}).json["objects"][0];
    };
    EXPECT_EQ(judged(iso)["isValid"], false);
    EXPECT_EQ(judged(flipped)["inconsistentEdges"], 4);
    EXPECT_NEAR(judged(moved)["maxEndOffVertex"].get<double>(), 1e-3, 1e-12);
}

} // namespace
} // namespace bot2nurbs
