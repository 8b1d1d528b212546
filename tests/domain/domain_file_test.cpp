// SPDX-License-Identifier: MIT
#include "bot2nurbs/domain_file.h"

#include "hand_domains.h"
#include "json_schema.h"

#include <functional>
#include <gtest/gtest.h>
#include <random>

namespace bot2nurbs::test {
namespace {

using Json = nlohmann::json;

std::vector<HandDomain> all_domains()
{
    return {sphere_cube(0, 2),
            sphere_cube(1, 8),
            torus_grid(),
            torus_askew(2, 2),
            genus2_voxels(),
            open_cylinder(),
            with_refined_carrier(sphere_cube(0, 4)),
            with_refined_carrier(torus_askew(3, 1))};
}

void expect_same(const QuadDomain& a, const QuadDomain& b)
{
    EXPECT_EQ(a.source_signature, b.source_signature);
    EXPECT_EQ(a.origin, b.origin);
    EXPECT_EQ(a.vertices, b.vertices);
    EXPECT_EQ(a.carrier.refined, b.carrier.refined);
    EXPECT_EQ(a.carrier.mesh.positions(), b.carrier.mesh.positions());
    EXPECT_EQ(a.carrier.mesh.triangles(), b.carrier.mesh.triangles());
    EXPECT_EQ(a.carrier.face_source, b.carrier.face_source);
    ASSERT_EQ(a.carrier.vertex_source.size(), b.carrier.vertex_source.size());
    for (std::size_t v = 0; v < a.carrier.vertex_source.size(); ++v) {
        EXPECT_EQ(a.carrier.vertex_source[v].face, b.carrier.vertex_source[v].face);
        EXPECT_EQ(a.carrier.vertex_source[v].bary, b.carrier.vertex_source[v].bary);
    }
    EXPECT_EQ(a.complex.quads(), b.complex.quads());
    ASSERT_EQ(a.edges.size(), b.edges.size());
    for (std::size_t e = 0; e < a.edges.size(); ++e) {
        EXPECT_EQ(a.edges[e].a, b.edges[e].a);
        EXPECT_EQ(a.edges[e].b, b.edges[e].b);
        EXPECT_EQ(a.edges[e].crease, b.edges[e].crease);
        EXPECT_EQ(a.complex.is_crease(Index(e)), b.complex.is_crease(Index(e)));
        ASSERT_EQ(a.edges[e].path.size(), b.edges[e].path.size());
        for (std::size_t i = 0; i < a.edges[e].path.size(); ++i) {
            EXPECT_EQ(a.edges[e].path[i].from, b.edges[e].path[i].from);
            EXPECT_EQ(a.edges[e].path[i].to, b.edges[e].path[i].to);
            EXPECT_EQ(a.edges[e].path[i].t, b.edges[e].path[i].t);
        }
    }
}

TEST(DomainFile, reads_back_what_was_written_and_writes_the_same_bytes)
{
    for (const HandDomain& hand : all_domains()) {
        const std::string text = domain_to_json(hand.domain);
        const auto read = domain_from_json(text, hand.mesh);
        ASSERT_TRUE(read.ok()) << read.error().message;
        expect_same(hand.domain, *read);
        EXPECT_EQ(domain_to_json(*read), text);
    }
}

TEST(DomainFile, follows_its_schema)
{
    const JsonSchema schema = JsonSchema::from_docs("domain.schema.json");
    for (const HandDomain& hand : all_domains()) {
        Json document = Json::parse(domain_to_json(hand.domain));
        EXPECT_EQ(schema.check(document), "");
        document["components"][0]["quads"][0].push_back(1);
        EXPECT_NE(schema.check(document), "");
    }
}

TEST(DomainFile, keeps_awkward_doubles_to_the_bit)
{
    HandDomain hand = torus_askew(2, 2);
    const double awkward[] = {5e-324, 0x1p-1022, 0.1, 1.0 / 3.0, 1 - 0x1p-53, 0x1.fffffffffffffp-2};
    std::size_t next = 0;
    for (DomainEdge& edge : hand.domain.edges)
        for (PathPoint& p : edge.path)
            if (!p.is_vertex())
                p.t = awkward[next++ % 6];
    const auto read = domain_from_json(domain_to_json(hand.domain), hand.mesh);
    ASSERT_TRUE(read.ok()) << read.error().message;
    expect_same(hand.domain, *read);
}

TEST(DomainFile, keeps_creases_corners_and_odd_names)
{
    HandDomain hand = open_cylinder();
    QuadDomain& domain = hand.domain;
    domain.edges[2].crease = true;
    domain.origin = "made \"by hand\"\n\xc3\xa9";
    auto complex =
        QuadComplex::build(domain.complex.vertex_count(), domain.complex.quads(),
                           {{domain.edges[2].a, domain.edges[2].b}}, {domain.edges[2].a});
    ASSERT_TRUE(complex.ok());
    domain.complex = *complex;
    const auto read = domain_from_json(domain_to_json(domain), hand.mesh);
    ASSERT_TRUE(read.ok()) << read.error().message;
    expect_same(domain, *read);
    EXPECT_TRUE(read->complex.is_corner(domain.edges[2].a));
    domain.origin = "no UTF-8: \xff";
    EXPECT_TRUE(domain_from_json(domain_to_json(domain), hand.mesh).ok());
}

TEST(DomainFile, of_another_mesh_is_stale_and_the_message_has_both_signatures)
{
    const HandDomain sphere = sphere_cube(0, 4);
    std::vector<Vec3> moved = sphere.mesh.positions();
    moved[5].x = std::nextafter(moved[5].x, 2.0);
    const auto other = ManifoldMesh::build(moved, sphere.mesh.triangles());
    ASSERT_TRUE(other.ok());
    const auto read = domain_from_json(domain_to_json(sphere.domain), *other);
    ASSERT_FALSE(read.ok());
    EXPECT_EQ(read.error().code, ErrorCode::stale_domain);
    EXPECT_NE(read.error().message.find(signature(sphere.mesh)), std::string::npos);
    EXPECT_NE(read.error().message.find(signature(*other)), std::string::npos);
}

TEST(DomainFile, of_several_components_gives_each_mesh_its_own)
{
    const HandDomain a = sphere_cube(0, 4), b = torus_grid(), c = genus2_voxels();
    const std::string text = domains_to_json({a.domain, b.domain});
    auto read = domains_from_json(text, {b.mesh, a.mesh});
    ASSERT_TRUE(read.ok()) << read.error().message;
    expect_same((*read)[0], b.domain);
    expect_same((*read)[1], a.domain);
    EXPECT_TRUE(domain_from_json(text, b.mesh).ok());
    read = domains_from_json(text, {a.mesh});
    ASSERT_FALSE(read.ok());
    EXPECT_EQ(read.error().code, ErrorCode::stale_domain);
    EXPECT_NE(read.error().message.find("/components/1"), std::string::npos);
    EXPECT_EQ(domains_from_json(text, {a.mesh, b.mesh, c.mesh}).error().code,
              ErrorCode::stale_domain);
    EXPECT_EQ(domains_from_json(text, {a.mesh, a.mesh}).error().code, ErrorCode::stale_domain);
}

//! A way to spoil a document, and what the message must say.
struct Spoilt {
    const char* name;
    std::function<void(Json&)> spoil;
    ErrorCode code;
    std::string message;
};

TEST(DomainFile, names_the_spoilt_element)
{
    const HandDomain hand = with_refined_carrier(torus_askew(2, 2));
    const Json good = Json::parse(domain_to_json(hand.domain));
    const auto component = [](Json& d) -> Json& { return d["components"][0]; };
    const ErrorCode invalid = ErrorCode::invalid_domain;
    const std::vector<Spoilt> cases{
        {"no schema", [](Json& d) { d.erase("schema"); }, invalid, "\"schema\""},
        {"version", [](Json& d) { d["schema"] = "bot2nurbs.domain/2"; }, ErrorCode::cannot_read,
         "/schema"},
        {"no object", [](Json& d) { d = Json::array(); }, ErrorCode::cannot_read, "object"},
        {"no components", [](Json& d) { d["components"].clear(); }, invalid, "/components"},
        {"unknown member", [&](Json& d) { component(d)["vertexes"] = 1; }, invalid,
         "/components/0/vertexes"},
        {"missing", [&](Json& d) { component(d).erase("quads"); }, invalid, "\"quads\""},
        {"type", [&](Json& d) { component(d)["vertices"][3] = "7"; }, invalid,
         "/components/0/vertices/3"},
        {"negative", [&](Json& d) { component(d)["vertices"][3] = -1; }, invalid,
         "/components/0/vertices/3"},
        {"fraction", [&](Json& d) { component(d)["vertices"][3] = 1.5; }, invalid,
         "/components/0/vertices/3"},
        {"absurd index", [&](Json& d) { component(d)["vertices"][3] = 18446744073709551615u; },
         invalid, "/components/0/vertices/3"},
        {"quad range", [&](Json& d) { component(d)["quads"][2][1] = 20; }, invalid,
         "/components/0/quads/2/1"},
        {"quad size", [&](Json& d) { component(d)["quads"][2].push_back(1); }, invalid,
         "/components/0/quads/2"},
        {"quad turned",
         [&](Json& d) { std::swap(component(d)["quads"][2][1], component(d)["quads"][2][3]); },
         invalid, "/components/0/quads"},
        {"edge lost", [&](Json& d) { component(d)["edges"].erase(4); }, invalid,
         "/components/0/edges"},
        {"path type", [&](Json& d) { component(d)["edges"][4]["path"] = 3; }, invalid,
         "/components/0/edges/4/path"},
        {"crossing size",
         [&](Json& d) {
             component(d)["edges"][4]["path"][0] = {1, 2};
         },
         invalid, "/components/0/edges/4/path/0"},
        {"crossing of a vertex",
         [&](Json& d) {
             component(d)["edges"][4]["path"][0] = {1, 1, 0.5};
         },
         invalid, "/components/0/edges/4/path/0"},
        {"parameter",
         [&](Json& d) {
             component(d)["edges"][4]["path"][0] = {1, 2, "x"};
         },
         invalid, "/components/0/edges/4/path/0/2"},
        {"crease", [&](Json& d) { component(d)["edges"][4]["crease"] = 1; }, invalid,
         "/components/0/edges/4/crease"},
        {"corner", [&](Json& d) { component(d)["corners"] = {99}; }, invalid,
         "/components/0/corners/0"},
        {"weight", [&](Json& d) { component(d)["carrier"]["vertices"][1][2] = -0.25; }, invalid,
         "/components/0/carrier/vertices/1/2"},
        {"weights", [&](Json& d) { component(d)["carrier"]["vertices"][1][2] = 0.26; }, invalid,
         "/components/0/carrier/vertices/1"},
        {"own vertex",
         [&](Json& d) {
             component(d)["carrier"]["vertices"][1] = {0, 1, 0, 0};
         },
         invalid, "/components/0/carrier/vertices/1"},
        {"carrier face", [&](Json& d) { component(d)["carrier"]["faces"].erase(7); }, invalid,
         "/components/0/carrier"},
        {"carrier range", [&](Json& d) { component(d)["carrier"]["faces"][7][0] = 1000000; },
         invalid, "/components/0/carrier/faces/7/0"},
        {"source face", [&](Json& d) { component(d)["carrier"]["faces"][7][3] = 1000000; }, invalid,
         "/components/0/carrier/faces/7/3"},
    };
    for (const Spoilt& c : cases) {
        Json document = good;
        c.spoil(document);
        const auto read = domain_from_json(document.dump(), hand.mesh);
        // Losing a carrier face opens the carrier, which alone is a manifold mesh still.
        if (c.name == std::string("carrier face")) {
            EXPECT_TRUE(read.ok()) << c.name;
            continue;
        }
        ASSERT_FALSE(read.ok()) << c.name;
        EXPECT_EQ(read.error().code, c.code) << c.name << ": " << read.error().message;
        EXPECT_NE(read.error().message.find(c.message), std::string::npos)
            << c.name << ": " << read.error().message;
    }
}

TEST(DomainFile, that_is_no_json_is_refused_with_line_and_column)
{
    const HandDomain hand = sphere_cube(0, 2);
    for (const std::string& text :
         {std::string(), std::string("{"), std::string("{\n \"a\": nan}"), std::string("\0\0\0", 3),
          std::string(200000, '['), std::string("{\"a\": 1e999}")}) {
        const auto read = domain_from_json(text, hand.mesh);
        ASSERT_FALSE(read.ok());
        EXPECT_EQ(read.error().code, ErrorCode::cannot_read);
    }
    const auto read = domain_from_json("{\n \"a\": nan}", hand.mesh);
    EXPECT_NE(read.error().message.find("line 2, column"), std::string::npos)
        << read.error().message;
    // Deep but well-formed.
    const std::string deep = std::string(100000, '[') + std::string(100000, ']');
    EXPECT_FALSE(domain_from_json(deep, hand.mesh).ok());
    EXPECT_FALSE(
        domain_from_json("{\"schema\": \"bot2nurbs.domain/1\", \"components\": " + deep + "}",
                         hand.mesh)
            .ok());
}

TEST(DomainFile, survives_random_damage)
{
    const HandDomain hand = with_refined_carrier(torus_askew(2, 1));
    const std::string good = domain_to_json(hand.domain);
    std::mt19937_64 random(20240229);
    const std::string alphabet = "0123456789-.e[]{},:\" \n\xff";
    int accepted = 0;
    for (int round = 0; round < 1500; ++round) {
        std::string text = good;
        for (int k = 0; k < 1 + round % 3; ++k) {
            const std::size_t at = random() % text.size();
            switch (random() % 3) {
            case 0: text[at] = alphabet[random() % alphabet.size()]; break;
            case 1: text.erase(at, 1 + random() % 8); break;
            default: text.insert(at, 1, alphabet[random() % alphabet.size()]);
            }
        }
        const auto read = domain_from_json(text, hand.mesh);
        if (read.ok()) { // Then it must be a value that can be written and read again.
            ++accepted;
            const std::string again = domain_to_json(*read);
            const auto reread = domain_from_json(again, hand.mesh);
            ASSERT_TRUE(reread.ok()) << reread.error().message;
            EXPECT_EQ(domain_to_json(*reread), again);
        }
    }
    EXPECT_GT(accepted, 0);
    EXPECT_LT(accepted, 1500);
}

} // namespace
} // namespace bot2nurbs::test
