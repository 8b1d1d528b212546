// SPDX-License-Identifier: MIT
#include "bot2nurbs/domain_constraints.h"

#include "hand_domains.h"
#include "json_schema.h"

#include <functional>
#include <gtest/gtest.h>

namespace bot2nurbs::test {
namespace {

using Json = nlohmann::json;

//! One of each kind, on the sphere.
DomainConstraints sample_constraints(const HandDomain& hand)
{
    DomainConstraints c;
    c.source_signature = signature(hand.mesh);
    c.patches = 24;
    ConstraintSite corner, inside;
    corner.vertex = hand.domain.vertices[0];
    corner.valence = 3;
    inside.point = {7, {0.1, 0.2, 0.7}};
    c.sites = {corner, inside, {hand.domain.vertices[3], {}, {}}};
    const auto along = [&](std::size_t e) {
        const DomainEdge& edge = hand.domain.edges[e];
        std::vector<Index> vertices{hand.domain.vertices[edge.a]};
        for (const PathPoint& p : edge.path)
            vertices.push_back(p.from);
        vertices.push_back(hand.domain.vertices[edge.b]);
        return vertices;
    };
    c.paths = {{along(0)}, {along(1)}};
    c.features = {{FeatureKind::smooth_seam, along(2)},
                  {FeatureKind::crease, along(3)},
                  {FeatureKind::boundary, along(4)},
                  {FeatureKind::corner, {hand.domain.vertices[5]}}};
    c.adjacencies = {{Demand::required, {0, 1}}, {Demand::forbidden, {1, 2}}};
    c.pairings = {{Demand::forbidden, {0, 1}}, {Demand::required, {2, 0}}};
    return c;
}

TEST(DomainConstraints, of_all_six_kinds_come_back_and_write_the_same_bytes)
{
    const HandDomain hand = sphere_cube(0, 6);
    const DomainConstraints c = sample_constraints(hand);
    const std::string text = constraints_to_json(c);
    const auto read = constraints_from_json(text, hand.mesh);
    ASSERT_TRUE(read.ok()) << read.error().message;
    EXPECT_EQ(constraints_to_json(*read), text);
    EXPECT_EQ(read->patches, 24u);
    ASSERT_EQ(read->sites.size(), 3u);
    EXPECT_EQ(read->sites[0].vertex, c.sites[0].vertex);
    EXPECT_EQ(read->sites[0].valence, 3u);
    EXPECT_FALSE(read->sites[1].vertex);
    EXPECT_EQ(read->sites[1].point.bary, c.sites[1].point.bary);
    ASSERT_EQ(read->paths.size(), 2u);
    EXPECT_EQ(read->paths[1].vertices, c.paths[1].vertices);
    ASSERT_EQ(read->features.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(read->features[i].kind, c.features[i].kind);
        EXPECT_EQ(read->features[i].vertices, c.features[i].vertices);
    }
    ASSERT_EQ(read->adjacencies.size(), 2u);
    EXPECT_EQ(read->adjacencies[1].demand, Demand::forbidden);
    EXPECT_EQ(read->adjacencies[1].sites, c.adjacencies[1].sites);
    ASSERT_EQ(read->pairings.size(), 2u);
    EXPECT_EQ(read->pairings[1].demand, Demand::required);
    EXPECT_FALSE(read->empty());
    EXPECT_EQ(JsonSchema::from_docs("constraints.schema.json").check(Json::parse(text)), "");
}

TEST(DomainConstraints, may_leave_every_kind_out)
{
    const HandDomain hand = sphere_cube(0, 2);
    const Json document{{"schema", "bot2nurbs.constraints/1"},
                        {"source_signature", signature(hand.mesh)}};
    EXPECT_EQ(JsonSchema::from_docs("constraints.schema.json").check(document), "");
    const auto read = constraints_from_json(document.dump(), hand.mesh);
    ASSERT_TRUE(read.ok());
    EXPECT_TRUE(read->empty());
}

TEST(DomainConstraints, that_contradict_the_mesh_or_themselves_are_refused_by_pointer)
{
    const HandDomain hand = sphere_cube(0, 6);
    const Json good = Json::parse(constraints_to_json(sample_constraints(hand)));
    struct Case {
        std::function<void(Json&)> spoil;
        const char* pointer;
    };
    const std::vector<Case> cases{
        {[](Json& d) { d["sites"][0]["vertex"] = 100000; }, "/sites/0/vertex"},
        {[](Json& d) {
             d["sites"][0]["point"] = {7, 1, 0, 0};
         },
         "/sites/0"},
        {[](Json& d) { d["sites"][0].erase("vertex"); }, "/sites/0"},
        {[](Json& d) { d["sites"][2]["vertex"] = d["sites"][0]["vertex"]; }, "/sites/2"},
        {[](Json& d) { d["sites"][0]["valence"] = 0; }, "/sites/0/valence"},
        {[](Json& d) { d["sites"][1]["point"][0] = 1u << 20; }, "/sites/1/point/0"},
        {[](Json& d) { d["sites"][1]["point"][1] = 0.5; }, "/sites/1/point"},
        {[](Json& d) { d["paths"][0]["vertices"].erase(2); }, "/paths/0/vertices/2"},
        {[](Json& d) { d["paths"][0]["vertices"][2] = d["paths"][0]["vertices"][0]; },
         "/paths/0/vertices/2"},
        {[](Json& d) { d["paths"][0]["vertices"] = {3}; }, "/paths/0/vertices"},
        {[](Json& d) { d["features"][0]["kind"] = "sharp"; }, "/features/0/kind"},
        {[](Json& d) { d["features"][1]["vertices"] = {3}; }, "/features/1/vertices"},
        {[](Json& d) {
             d["adjacencies"][0]["sites"] = {0, 3};
         },
         "/adjacencies/0/sites/1"},
        {[](Json& d) {
             d["adjacencies"][0]["sites"] = {1, 1};
         },
         "/adjacencies/0/sites"},
        {[](Json& d) {
             d["adjacencies"][1]["sites"] = {1, 0};
         },
         "/adjacencies/1"},
        {[](Json& d) { d["pairings"][0]["demand"] = true; }, "/pairings/0/demand"},
        {[](Json& d) { d["patches"] = 0; }, "/patches"},
        {[](Json& d) { d["patchs"] = 6; }, "/patchs"},
    };
    for (const Case& c : cases) {
        Json document = good;
        c.spoil(document);
        const auto read = constraints_from_json(document.dump(), hand.mesh);
        ASSERT_FALSE(read.ok()) << c.pointer;
        EXPECT_EQ(read.error().code, ErrorCode::invalid_domain);
        const std::string end = std::string(" at ") + c.pointer;
        const std::string& message = read.error().message;
        EXPECT_EQ(message.substr(message.size() - std::min(message.size(), end.size())), end);
    }
}

TEST(DomainConstraints, of_another_mesh_are_stale)
{
    const HandDomain a = sphere_cube(0, 6), b = sphere_cube(0, 4);
    const auto read = constraints_from_json(constraints_to_json(sample_constraints(a)), b.mesh);
    ASSERT_FALSE(read.ok());
    EXPECT_EQ(read.error().code, ErrorCode::stale_domain);
    EXPECT_EQ(constraints_from_json("{}", a.mesh).error().code, ErrorCode::invalid_domain);
    EXPECT_EQ(constraints_from_json("no", a.mesh).error().code, ErrorCode::cannot_read);
    EXPECT_EQ(constraints_from_json("{\"schema\": \"bot2nurbs.domain/1\"}", a.mesh).error().code,
              ErrorCode::cannot_read);
}

} // namespace
} // namespace bot2nurbs::test
