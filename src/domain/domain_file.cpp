// SPDX-License-Identifier: MIT
#include "bot2nurbs/domain_file.h"

#include "domain/json_node.h"
#include "domain/json_text.h"

#include <utility>

namespace bot2nurbs {

namespace {

const char* const schema_name = "bot2nurbs.domain";

//! An own vertex of the source is a corner of its source face; they come first.
bool is_corner(const SourcePoint& p)
{
    return p.bary[0] == 1.0 || p.bary[1] == 1.0 || p.bary[2] == 1.0;
}

void write_carrier(const CarrierMesh& carrier, JsonText& json)
{
    std::size_t own = 0;
    while (own < carrier.vertex_source.size() && is_corner(carrier.vertex_source[own]))
        ++own;
    json.line().key("carrier").open('{');
    json.line().key("vertices").open('[');
    for (std::size_t v = own; v < carrier.vertex_source.size(); ++v)
        json.line().value(carrier.vertex_source[v]);
    json.close(']');
    json.line().key("faces").open('[');
    for (Index f = 0; f < carrier.mesh.face_count(); ++f) {
        json.line().open('[');
        for (const Index v : carrier.mesh.triangle(f))
            json.value(v);
        json.value(carrier.face_source[f]).close(']');
    }
    json.close(']');
    json.line().close('}');
}

void write_component(const QuadDomain& domain, JsonText& json)
{
    const QuadComplex& complex = domain.complex;
    json.line().open('{');
    json.line().key("source_signature").value(domain.source_signature);
    json.line().key("origin").value(domain.origin);
    if (domain.carrier.refined)
        write_carrier(domain.carrier, json);
    json.line().key("vertices").open('[');
    for (const Index v : domain.vertices)
        json.value(v);
    json.close(']');
    json.line().key("corners").open('[');
    for (Index v = 0; v < complex.vertex_count(); ++v)
        if (complex.is_corner(v))
            json.value(v);
    json.close(']');
    json.line().key("quads").open('[');
    for (const auto& quad : complex.quads()) {
        json.line().open('[');
        for (const Index v : quad)
            json.value(v);
        json.close(']');
    }
    json.close(']');
    json.line().key("edges").open('[');
    for (const DomainEdge& edge : domain.edges) {
        json.line().open('{').key("a").value(edge.a).key("b").value(edge.b);
        if (edge.crease)
            json.key("crease").value(true);
        json.key("path").open('[');
        for (const PathPoint& p : edge.path) {
            if (p.is_vertex())
                json.value(p.from);
            else
                json.open('[').value(p.from).value(p.to).value(p.t).close(']');
        }
        json.close(']').close('}');
    }
    json.close(']');
    json.line().close('}');
}

CarrierMesh read_carrier(const JsonNode& node, const ManifoldMesh& source)
{
    node.allow_only({"vertices", "faces"});
    CarrierMesh carrier = CarrierMesh::from_source(source);
    carrier.refined = true;
    std::vector<Vec3> positions = source.positions();
    const JsonNode vertices = node.at("vertices");
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const SourcePoint point = read_source_point(vertices.at(i), source);
        if (is_corner(point))
            vertices.at(i).fail("this is a vertex of the source, which the carrier has already");
        carrier.vertex_source.push_back(point);
        positions.push_back(source.at(point));
    }
    const JsonNode faces = node.at("faces");
    std::vector<std::array<Index, 3>> triangles;
    carrier.face_source.clear();
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const JsonNode face = faces.at(f);
        face.expect_size(4);
        std::array<Index, 3> t{};
        for (std::size_t k = 0; k < 3; ++k)
            t[k] = face.at(k).index(positions.size(), "carrier vertex");
        triangles.push_back(t);
        carrier.face_source.push_back(face.at(3).index(source.face_count(), "source face"));
    }
    auto mesh = ManifoldMesh::build(std::move(positions), std::move(triangles));
    if (!mesh.ok())
        node.fail("not a manifold mesh: " + mesh.error().message, ErrorCode::invalid_domain,
                  mesh.error().element);
    carrier.mesh = std::move(*mesh);
    return carrier;
}

PathPoint read_path_point(const JsonNode& node, Index vertex_count)
{
    PathPoint point;
    if (!node.is_array()) {
        point.from = point.to = node.index(vertex_count, "carrier vertex");
        return point;
    }
    node.expect_size(3);
    point.from = node.at(std::size_t{0}).index(vertex_count, "carrier vertex");
    point.to = node.at(1).index(vertex_count, "carrier vertex");
    point.t = node.at(2).number();
    if (point.from == point.to)
        node.fail("a crossing needs two different vertices");
    return point;
}

DomainEdge read_edge(const JsonNode& node, const QuadDomain& domain)
{
    node.allow_only({"a", "b", "crease", "path"});
    DomainEdge edge;
    edge.a = node.at("a").index(domain.vertices.size(), "domain vertex");
    edge.b = node.at("b").index(domain.vertices.size(), "domain vertex");
    edge.crease = node.has("crease") && node.at("crease").boolean();
    const JsonNode path = node.at("path");
    for (std::size_t i = 0; i < path.size(); ++i)
        edge.path.push_back(read_path_point(path.at(i), domain.carrier.mesh.vertex_count()));
    return edge;
}

QuadDomain read_component(const JsonNode& node, const ManifoldMesh& source)
{
    node.allow_only(
        {"source_signature", "origin", "carrier", "vertices", "corners", "quads", "edges"});
    QuadDomain domain;
    domain.source_signature = node.at("source_signature").text();
    domain.origin = node.at("origin").text();
    domain.carrier = node.has("carrier") ? read_carrier(node.at("carrier"), source)
                                         : CarrierMesh::from_source(source);
    const JsonNode vertices = node.at("vertices");
    for (std::size_t v = 0; v < vertices.size(); ++v)
        domain.vertices.push_back(
            vertices.at(v).index(domain.carrier.mesh.vertex_count(), "carrier vertex"));
    std::vector<Index> corners;
    const JsonNode corner_nodes = node.at("corners");
    for (std::size_t i = 0; i < corner_nodes.size(); ++i)
        corners.push_back(corner_nodes.at(i).index(domain.vertices.size(), "domain vertex"));
    std::vector<std::array<Index, 4>> quads;
    const JsonNode quad_nodes = node.at("quads");
    for (std::size_t q = 0; q < quad_nodes.size(); ++q) {
        quad_nodes.at(q).expect_size(4);
        quads.emplace_back();
        for (std::size_t k = 0; k < 4; ++k)
            quads.back()[k] = quad_nodes.at(q).at(k).index(domain.vertices.size(), "domain vertex");
    }
    std::vector<std::pair<Index, Index>> creases;
    const JsonNode edges = node.at("edges");
    for (std::size_t e = 0; e < edges.size(); ++e) {
        domain.edges.push_back(read_edge(edges.at(e), domain));
        if (domain.edges.back().crease)
            creases.emplace_back(domain.edges.back().a, domain.edges.back().b);
    }
    auto complex = QuadComplex::build(static_cast<Index>(domain.vertices.size()), std::move(quads),
                                      std::move(creases), std::move(corners));
    if (!complex.ok())
        quad_nodes.fail("not a manifold complex: " + complex.error().message,
                        ErrorCode::invalid_domain, complex.error().element);
    domain.complex = std::move(*complex);
    edges.expect_size(domain.complex.edge_count());
    return domain;
}

//! The components of a document, checked for its kind.
JsonNode components_of(const JsonNode& root)
{
    expect_schema(root, schema_name);
    root.allow_only({"schema", "components"});
    const JsonNode components = root.at("components");
    if (components.size() == 0)
        components.fail("expected at least one component");
    return components;
}

std::string signatures(const JsonNode& components)
{
    std::string list;
    for (std::size_t c = 0; c < components.size(); ++c)
        list += (c ? ", " : "") + components.at(c).at("source_signature").text();
    return list;
}

[[noreturn]] void fail_stale(const JsonNode& components, const std::string& wanted)
{
    components.fail("the domain was made for another mesh: it carries signature " +
                        signatures(components) + ", the input has " + wanted,
                    ErrorCode::stale_domain);
}

//! The first unused component with a signature, or the number of components.
std::size_t find_component(const JsonNode& components, const std::string& wanted,
                           const std::vector<char>& used)
{
    std::size_t c = 0;
    while (c < components.size() &&
           (used[c] || components.at(c).at("source_signature").text() != wanted))
        ++c;
    return c;
}

} // namespace

std::string domains_to_json(const std::vector<QuadDomain>& domains)
{
    JsonText json;
    json.open('{');
    json.line().key("schema").value(std::string(schema_name) + "/1");
    json.line().key("components").open('[');
    for (const QuadDomain& domain : domains)
        write_component(domain, json);
    json.close(']');
    json.line().close('}');
    return json.text() + '\n';
}

std::string domain_to_json(const QuadDomain& domain)
{
    return domains_to_json({domain});
}

Result<QuadDomain> domain_from_json(const std::string& text, const ManifoldMesh& source)
{
    return read_json<QuadDomain>(text, [&](const JsonNode& root) {
        const JsonNode components = components_of(root);
        const std::string wanted = signature(source);
        const std::size_t c =
            find_component(components, wanted, std::vector<char>(components.size(), 0));
        if (c == components.size())
            fail_stale(components, wanted);
        return read_component(components.at(c), source);
    });
}

Result<std::vector<QuadDomain>> domains_from_json(const std::string& text,
                                                  const std::vector<ManifoldMesh>& sources)
{
    return read_json<std::vector<QuadDomain>>(text, [&](const JsonNode& root) {
        const JsonNode components = components_of(root);
        std::vector<char> used(components.size(), 0);
        std::vector<QuadDomain> domains;
        for (const ManifoldMesh& source : sources) {
            const std::string wanted = signature(source);
            const std::size_t c = find_component(components, wanted, used);
            if (c == components.size())
                fail_stale(components, wanted);
            used[c] = 1;
            domains.push_back(read_component(components.at(c), source));
        }
        for (std::size_t c = 0; c < used.size(); ++c)
            if (!used[c])
                components.at(c).fail("the input has no mesh for this component (signature " +
                                          components.at(c).at("source_signature").text() + ')',
                                      ErrorCode::stale_domain);
        return domains;
    });
}

} // namespace bot2nurbs
