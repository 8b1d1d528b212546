// SPDX-License-Identifier: MIT
#include "bot2nurbs/domain_samples.h"

#include "domain/json_node.h"
#include "domain/json_text.h"

namespace bot2nurbs {

namespace {

const char* const schema_name = "bot2nurbs.samples";

Vec3 read_vector(const JsonNode& node)
{
    node.expect_size(3);
    return {node.at(std::size_t{0}).number(), node.at(1).number(), node.at(2).number()};
}

DomainPoint read_domain_point(const JsonNode& node)
{
    node.expect_size(3);
    DomainPoint point;
    point.quad = node.at(std::size_t{0}).index(invalid_index, "quad");
    point.u = node.at(1).number();
    point.v = node.at(2).number();
    for (std::size_t k = 1; k < 3; ++k)
        if (node.at(k).number() < 0.0 || node.at(k).number() > 1.0)
            node.at(k).fail("expected a parameter in [0, 1]");
    return point;
}

//! Reads the array `key`, one entry a sample; absent is empty.
template <class T, class Read> void read_column(const JsonNode& root, const char* key,
                                                std::size_t count, std::vector<T>& column,
                                                const Read& read)
{
    if (!root.has(key))
        return;
    const JsonNode node = root.at(key);
    node.expect_size(count);
    column.reserve(count);
    for (std::size_t i = 0; i < count; ++i)
        column.push_back(read(node.at(i)));
}

void write_vectors(JsonText& json, const char* key, const std::vector<Vec3>& vectors)
{
    json.line().key(key).open('[');
    for (const Vec3& p : vectors)
        json.line().open('[').value(p.x).value(p.y).value(p.z).close(']');
    json.close(']');
}

} // namespace

std::string samples_to_json(const SurfaceSampleSet& samples, const std::string& source_signature)
{
    JsonText json;
    json.open('{');
    json.line().key("schema").value(std::string(schema_name) + "/1");
    json.line().key("source_signature").value(source_signature);
    write_vectors(json, "positions", samples.positions);
    if (!samples.normals.empty())
        write_vectors(json, "normals", samples.normals);
    if (!samples.weights.empty()) {
        json.line().key("weights").open('[');
        for (const double w : samples.weights)
            json.line().value(w);
        json.close(']');
    }
    if (!samples.source.empty()) {
        json.line().key("source").open('[');
        for (const SourcePoint& p : samples.source)
            json.line().value(p);
        json.close(']');
    }
    if (!samples.domain.empty()) {
        json.line().key("domain").open('[');
        for (const DomainPoint& p : samples.domain)
            json.line().open('[').value(p.quad).value(p.u).value(p.v).close(']');
        json.close(']');
    }
    json.line().close('}');
    return json.text() + '\n';
}

Result<SurfaceSampleSet> samples_from_json(const std::string& text, const ManifoldMesh& source)
{
    return read_json<SurfaceSampleSet>(text, [&](const JsonNode& root) {
        expect_schema(root, schema_name);
        root.allow_only(
            {"schema", "source_signature", "positions", "normals", "weights", "source", "domain"});
        expect_signature(root.at("source_signature"), signature(source));
        SurfaceSampleSet set;
        const std::size_t count = root.at("positions").size();
        read_column(root, "positions", count, set.positions, read_vector);
        read_column(root, "normals", count, set.normals, read_vector);
        read_column(root, "weights", count, set.weights, [](const JsonNode& node) {
            const double w = node.number();
            if (!(w > 0.0))
                node.fail("expected a positive weight");
            return w;
        });
        read_column(root, "source", count, set.source,
                    [&](const JsonNode& node) { return read_source_point(node, source); });
        read_column(root, "domain", count, set.domain, read_domain_point);
        return set;
    });
}

} // namespace bot2nurbs
