// SPDX-License-Identifier: MIT
#include "bot2nurbs/domain_constraints.h"

#include "domain/json_node.h"
#include "domain/json_text.h"

#include <algorithm>
#include <set>
#include <utility>

namespace bot2nurbs {

namespace {

const char* const schema_name = "bot2nurbs.constraints";
//! More quads than indices of halfedges can name.
constexpr std::size_t patch_limit = std::size_t{1} << 30;
//! A hint beyond this would be a typing error: the masks of a vertex of valence 16 are already
//! forty times as large as those of a regular one.
constexpr std::size_t valence_limit = 17;

constexpr std::array<const char*, 4> kind_names{"smooth_seam", "crease", "boundary", "corner"};
constexpr std::array<const char*, 2> demand_names{"required", "forbidden"};

//! The place of a text in a list of names.
template <std::size_t N>
std::size_t read_name(const JsonNode& node, const std::array<const char*, N>& names)
{
    const std::string text = node.text();
    std::string list;
    for (std::size_t i = 0; i < N; ++i) {
        if (text == names[i])
            return i;
        list += (i ? ", " : "") + std::string(names[i]);
    }
    node.fail('"' + text + "\" is none of " + list);
}

void write_vertices(JsonText& json, const std::vector<Index>& vertices)
{
    json.key("vertices").open('[');
    for (const Index v : vertices)
        json.value(v);
    json.close(']');
}

template <class Constraint>
void write_pairs(JsonText& json, const char* key, const std::vector<Constraint>& constraints)
{
    json.line().key(key).open('[');
    for (const Constraint& c : constraints) {
        json.line().open('{').key("demand");
        json.value(std::string(demand_names[static_cast<std::size_t>(c.demand)]));
        json.key("sites").open('[').value(c.sites[0]).value(c.sites[1]).close(']').close('}');
    }
    json.close(']');
}

std::vector<Index> read_path(const JsonNode& node, const ManifoldMesh& source, std::size_t least)
{
    std::vector<Index> vertices;
    if (node.size() < least)
        node.fail("expected at least " + std::to_string(least) + " vertices");
    std::set<Index> seen;
    for (std::size_t i = 0; i < node.size(); ++i) {
        const Index v = node.at(i).index(source.vertex_count(), "source vertex");
        const bool closes = i > 0 && i + 1 == node.size() && v == vertices.front();
        if (!seen.insert(v).second && !closes)
            node.at(i).fail("the path meets vertex " + std::to_string(v) + " twice");
        if (i > 0 && source.find_halfedge(vertices.back(), v) == invalid_index &&
            source.find_halfedge(v, vertices.back()) == invalid_index)
            node.at(i).fail("no mesh edge from vertex " + std::to_string(vertices.back()) +
                            " to vertex " + std::to_string(v));
        vertices.push_back(v);
    }
    return vertices;
}

ConstraintSite read_site(const JsonNode& node, const ManifoldMesh& source)
{
    node.allow_only({"vertex", "point", "valence"});
    ConstraintSite site;
    if (node.has("vertex") == node.has("point"))
        node.fail("a site has either a vertex or a point");
    if (node.has("vertex"))
        site.vertex = node.at("vertex").index(source.vertex_count(), "source vertex");
    else
        site.point = read_source_point(node.at("point"), source);
    if (node.has("valence")) {
        site.valence = node.at("valence").index(valence_limit, "valence");
        if (*site.valence < 1)
            node.at("valence").fail("expected a valence of at least 1");
    }
    return site;
}

//! What says that two sites are the same: the source vertex, or the face and weights.
using SiteKey = std::pair<Index, std::array<double, 3>>;

SiteKey site_key(const ConstraintSite& site, const ManifoldMesh& source)
{
    if (site.vertex)
        return {*site.vertex, {-1, -1, -1}};
    for (std::size_t k = 0; k < 3; ++k)
        if (site.point.bary[k] == 1.0)
            return {source.triangle(site.point.face)[k], {-1, -1, -1}};
    return {site.point.face, site.point.bary};
}

template <class Constraint>
std::vector<Constraint> read_pairs(const JsonNode& node, std::size_t site_count)
{
    std::vector<Constraint> constraints;
    std::set<std::pair<Index, Index>> seen;
    for (std::size_t i = 0; i < node.size(); ++i) {
        const JsonNode item = node.at(i);
        item.allow_only({"demand", "sites"});
        Constraint c;
        c.demand = static_cast<Demand>(read_name(item.at("demand"), demand_names));
        const JsonNode sites = item.at("sites");
        sites.expect_size(2);
        for (std::size_t k = 0; k < 2; ++k)
            c.sites[k] = sites.at(k).index(site_count, "site");
        if (c.sites[0] == c.sites[1])
            sites.fail("expected two different sites");
        if (!seen.insert(std::minmax(c.sites[0], c.sites[1])).second)
            item.fail("this pair of sites is named twice");
        constraints.push_back(c);
    }
    return constraints;
}

void write_constraints(JsonText& json, const DomainConstraints& constraints)
{
    json.open('{');
    json.line().key("schema").value(std::string(schema_name) + "/1");
    json.line().key("source_signature").value(constraints.source_signature);
    if (constraints.patches)
        json.line().key("patches").value(*constraints.patches);
    json.line().key("sites").open('[');
    for (const ConstraintSite& site : constraints.sites) {
        json.line().open('{');
        if (site.vertex)
            json.key("vertex").value(*site.vertex);
        else
            json.key("point").value(site.point);
        if (site.valence)
            json.key("valence").value(*site.valence);
        json.close('}');
    }
    json.close(']');
    json.line().key("paths").open('[');
    for (const RequiredPath& path : constraints.paths) {
        json.line().open('{');
        write_vertices(json, path.vertices);
        json.close('}');
    }
    json.close(']');
    json.line().key("features").open('[');
    for (const FeaturePath& path : constraints.features) {
        json.line().open('{').key("kind");
        json.value(std::string(kind_names[static_cast<std::size_t>(path.kind)]));
        write_vertices(json, path.vertices);
        json.close('}');
    }
    json.close(']');
    write_pairs(json, "adjacencies", constraints.adjacencies);
    write_pairs(json, "pairings", constraints.pairings);
    json.line().close('}');
}

DomainConstraints read_constraints(const JsonNode& root, const ManifoldMesh& source)
{
    expect_schema(root, schema_name);
    root.allow_only({"schema", "source_signature", "patches", "sites", "paths", "features",
                     "adjacencies", "pairings"});
    DomainConstraints constraints;
    constraints.source_signature = root.at("source_signature").text();
    expect_signature(root.at("source_signature"), signature(source));
    if (root.has("patches")) {
        constraints.patches = root.at("patches").index(patch_limit, "patch");
        if (*constraints.patches < 1)
            root.at("patches").fail("expected at least one patch");
    }
    if (root.has("sites")) {
        const JsonNode sites = root.at("sites");
        std::set<SiteKey> seen;
        for (std::size_t i = 0; i < sites.size(); ++i) {
            constraints.sites.push_back(read_site(sites.at(i), source));
            if (!seen.insert(site_key(constraints.sites.back(), source)).second)
                sites.at(i).fail("this site is named twice");
        }
    }
    if (root.has("paths")) {
        const JsonNode paths = root.at("paths");
        for (std::size_t i = 0; i < paths.size(); ++i) {
            paths.at(i).allow_only({"vertices"});
            constraints.paths.push_back({read_path(paths.at(i).at("vertices"), source, 2)});
        }
    }
    if (root.has("features")) {
        const JsonNode features = root.at("features");
        for (std::size_t i = 0; i < features.size(); ++i) {
            features.at(i).allow_only({"kind", "vertices"});
            FeaturePath path;
            path.kind = static_cast<FeatureKind>(read_name(features.at(i).at("kind"), kind_names));
            path.vertices = read_path(features.at(i).at("vertices"), source,
                                      path.kind == FeatureKind::corner ? 1 : 2);
            constraints.features.push_back(std::move(path));
        }
    }
    const std::size_t sites = constraints.sites.size();
    if (root.has("adjacencies"))
        constraints.adjacencies = read_pairs<AdjacencyConstraint>(root.at("adjacencies"), sites);
    if (root.has("pairings"))
        constraints.pairings = read_pairs<PairingConstraint>(root.at("pairings"), sites);
    return constraints;
}

} // namespace

std::string constraints_to_json(const DomainConstraints& constraints)
{
    JsonText json;
    write_constraints(json, constraints);
    return json.text() + '\n';
}

std::string constraint_list_to_json(const std::vector<DomainConstraints>& constraints)
{
    if (constraints.size() == 1)
        return constraints_to_json(constraints.front());
    JsonText json;
    json.open('[');
    for (const DomainConstraints& c : constraints) {
        json.line();
        write_constraints(json, c);
    }
    json.line().close(']');
    return json.text() + '\n';
}

Result<DomainConstraints> constraints_from_json(const std::string& text, const ManifoldMesh& source)
{
    return read_json<DomainConstraints>(
        text, [&](const JsonNode& root) { return read_constraints(root, source); });
}

Result<std::vector<DomainConstraints>>
constraint_list_from_json(const std::string& text, const std::vector<ManifoldMesh>& sources)
{
    return read_json<std::vector<DomainConstraints>>(text, [&](const JsonNode& root) {
        std::vector<JsonNode> items;
        if (root.is_array())
            for (std::size_t i = 0; i < root.size(); ++i)
                items.push_back(root.at(i));
        else
            items.push_back(root);
        std::vector<std::string> known;
        for (const ManifoldMesh& source : sources)
            known.push_back(signature(source));
        std::vector<DomainConstraints> constraints(sources.size());
        std::vector<char> used(sources.size(), 0);
        for (const JsonNode& item : items) {
            expect_schema(item, schema_name);
            const JsonNode node = item.at("source_signature");
            const std::string wanted = node.text();
            std::size_t c = 0;
            while (c < sources.size() && (used[c] || known[c] != wanted))
                ++c;
            if (c == sources.size())
                node.fail("made for the mesh with signature " + wanted +
                              ", which no component of the input has",
                          ErrorCode::stale_domain);
            constraints[c] = read_constraints(item, sources[c]);
            used[c] = 1;
        }
        return constraints;
    });
}

} // namespace bot2nurbs
