// SPDX-License-Identifier: MIT
#include "bot2nurbs/domain_samples.h"
#include "hand_domains.h"
#include "json_schema.h"

#include <cstring>
#include <functional>
#include <gtest/gtest.h>

namespace bot2nurbs::test {
namespace {

using Json = nlohmann::json;

struct Fixture {
    HandDomain hand = sphere_cube(0, 4);
    SurfaceSampleSet set;
    Fixture()
    {
        Context context;
        auto made = make_samples(hand.mesh, hand.charts, {}, context);
        EXPECT_TRUE(made.ok());
        set = *made;
    }
};

template <class T> bool same_bytes(const std::vector<T>& a, const std::vector<T>& b)
{
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

TEST(SampleFile, comes_back_to_the_bit_and_writes_the_same_bytes)
{
    Fixture f;
    f.set.positions[0] = {-0.0, 5e-324, -1.7976931348623157e308};
    const std::string text = samples_to_json(f.set, signature(f.hand.mesh));
    const auto read = samples_from_json(text, f.hand.mesh);
    ASSERT_TRUE(read.ok()) << read.error().message;
    EXPECT_TRUE(same_bytes(read->positions, f.set.positions));
    EXPECT_TRUE(same_bytes(read->normals, f.set.normals));
    EXPECT_TRUE(same_bytes(read->weights, f.set.weights));
    ASSERT_EQ(read->source.size(), f.set.size());
    ASSERT_EQ(read->domain.size(), f.set.size());
    for (std::size_t i = 0; i < f.set.size(); ++i) {
        EXPECT_EQ(read->source[i].face, f.set.source[i].face);
        EXPECT_EQ(read->source[i].bary, f.set.source[i].bary);
        EXPECT_EQ(read->domain[i].quad, f.set.domain[i].quad);
        EXPECT_EQ(read->domain[i].u, f.set.domain[i].u);
        EXPECT_EQ(read->domain[i].v, f.set.domain[i].v);
    }
    EXPECT_EQ(samples_to_json(*read, signature(f.hand.mesh)), text);
    EXPECT_EQ(JsonSchema::from_docs("samples.schema.json").check(Json::parse(text)), "");
}

TEST(SampleFile, may_hold_positions_alone)
{
    Fixture f;
    SurfaceSampleSet bare;
    bare.positions = f.set.positions;
    const auto read = samples_from_json(samples_to_json(bare, signature(f.hand.mesh)), f.hand.mesh);
    ASSERT_TRUE(read.ok()) << read.error().message;
    EXPECT_TRUE(read->normals.empty() && read->weights.empty() && read->source.empty() &&
                read->domain.empty());
    EXPECT_EQ(read->positions, bare.positions);
}

TEST(SampleFile, names_the_spoilt_element)
{
    Fixture f;
    const Json good = Json::parse(samples_to_json(f.set, signature(f.hand.mesh)));
    struct Case {
        std::function<void(Json&)> spoil;
        const char* pointer;
    };
    const std::vector<Case> cases{
        {[](Json& d) {
             d["positions"][3] = {1, 2};
         },
         "/positions/3"},
        {[](Json& d) { d["positions"][3][1] = nullptr; }, "/positions/3/1"},
        {[](Json& d) { d["normals"].erase(0); }, "/normals"},
        {[](Json& d) { d["weights"][9] = 0; }, "/weights/9"},
        {[](Json& d) { d["source"][9][0] = 1u << 20; }, "/source/9/0"},
        {[](Json& d) { d["domain"][9][0] = -1; }, "/domain/9/0"},
        {[](Json& d) { d["domain"][9][2] = 1.25; }, "/domain/9/2"},
    };
    for (const Case& c : cases) {
        Json document = good;
        c.spoil(document);
        const auto read = samples_from_json(document.dump(), f.hand.mesh);
        ASSERT_FALSE(read.ok()) << c.pointer;
        EXPECT_EQ(read.error().code, ErrorCode::invalid_domain);
        EXPECT_NE(read.error().message.find(std::string(" at ") + c.pointer), std::string::npos)
            << read.error().message;
    }
}

TEST(SampleFile, of_another_mesh_is_stale)
{
    Fixture f;
    const auto read =
        samples_from_json(samples_to_json(f.set, signature(f.hand.mesh)), sphere_cube(0, 6).mesh);
    ASSERT_FALSE(read.ok());
    EXPECT_EQ(read.error().code, ErrorCode::stale_domain);
}

} // namespace
} // namespace bot2nurbs::test
