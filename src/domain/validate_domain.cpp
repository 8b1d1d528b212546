// SPDX-License-Identifier: MIT
#include "bot2nurbs/validate_domain.h"

#include "domain/validate_domain_rules.h"

#include <algorithm>
#include <utility>

namespace bot2nurbs {

namespace {

constexpr std::size_t listed_per_rule = 100;
//! Fewest quads around a vertex inside: around one of valence 2 two quads share two sides, and the
//! surface would have to fold back. Where the boundary or two creases meet, one is enough.
constexpr Index least_inner_valence = 3;

//! Number of boundary and crease edges at a vertex.
int sharp_edges(const QuadComplex& complex, Index v)
{
    int count = 0;
    const Index first = complex.halfedge_at(v);
    Index h = first;
    do {
        count += complex.is_sharp(complex.edge(h));
        const Index last = QuadComplex::prev(h);
        h = complex.twin(last);
        count += h == invalid_index; // The last edge at the boundary is no start of a quad's side.
    } while (h != first && h != invalid_index);
    return count;
}

std::string number(std::size_t i)
{
    return std::to_string(i);
}

//! Rule index: sizes of arrays, and that every index names something.
void check_indices(const ManifoldMesh& source, const QuadDomain& domain, DefectList& defects)
{
    const CarrierMesh& carrier = domain.carrier;
    const Index carrier_vertices = carrier.mesh.vertex_count();
    const auto add = [&](std::string message, std::size_t element) {
        defects.add("index", std::move(message), static_cast<Index>(element));
    };
    if (carrier.vertex_source.size() != carrier_vertices)
        add("vertex_source of the carrier has not one entry a vertex", invalid_index);
    if (carrier.face_source.size() != carrier.mesh.face_count())
        add("face_source of the carrier has not one entry a face", invalid_index);
    for (std::size_t v = 0; v < carrier.vertex_source.size(); ++v)
        if (carrier.vertex_source[v].face >= source.face_count())
            add("carrier vertex " + number(v) + " lies on no source face", v);
    for (std::size_t f = 0; f < carrier.face_source.size(); ++f)
        if (carrier.face_source[f] >= source.face_count())
            add("carrier face " + number(f) + " is part of no source face", f);
    if (domain.complex.quad_count() == 0)
        add("the domain has no quads", invalid_index);
    if (domain.vertices.size() != domain.complex.vertex_count())
        add("there is not one carrier vertex for each domain vertex", invalid_index);
    for (std::size_t v = 0; v < domain.vertices.size(); ++v)
        if (domain.vertices[v] >= carrier_vertices)
            add("domain vertex " + number(v) + " lies on no carrier vertex", v);
    if (domain.edges.size() != domain.complex.edge_count())
        add("there is not one path for each edge of the complex", invalid_index);
    for (std::size_t e = 0; e < domain.edges.size(); ++e) {
        const DomainEdge& edge = domain.edges[e];
        if (edge.a >= domain.vertices.size() || edge.b >= domain.vertices.size())
            add("edge " + number(e) + " ends at no domain vertex", e);
        for (const PathPoint& p : edge.path)
            if (p.from >= carrier_vertices || p.to >= carrier_vertices) {
                add("the path of edge " + number(e) + " names no carrier vertex", e);
                break;
            }
    }
}

//! Rules edge_ends, crease, vertex_distinct, valence.
void check_elements(const QuadDomain& domain, Index max_valence, DefectList& defects)
{
    const QuadComplex& complex = domain.complex;
    for (Index e = 0; e < complex.edge_count(); ++e) {
        const Index h = complex.halfedge_of_edge(e);
        const DomainEdge& edge = domain.edges[e];
        if (edge.a != complex.from(h) || edge.b != complex.to(h))
            defects.add("edge_ends",
                        "edge " + number(e) + " runs from vertex " + number(edge.a) + " to " +
                            number(edge.b) + ", but the complex has it from " +
                            number(complex.from(h)) + " to " + number(complex.to(h)),
                        e);
        if (edge.crease != complex.is_crease(e))
            defects.add("crease",
                        "edge " + number(e) + " is " + (edge.crease ? "a" : "no") +
                            " crease, but the complex says otherwise",
                        e);
    }
    std::vector<std::pair<Index, Index>> places;
    for (Index v = 0; v < complex.vertex_count(); ++v)
        places.emplace_back(domain.vertices[v], v);
    std::sort(places.begin(), places.end());
    for (std::size_t i = 1; i < places.size(); ++i)
        if (places[i].first == places[i - 1].first)
            defects.add("vertex_distinct",
                        "domain vertices " + number(places[i - 1].second) + " and " +
                            number(places[i].second) + " lie on the same carrier vertex " +
                            number(places[i].first),
                        places[i].second);
    for (Index v = 0; v < complex.vertex_count(); ++v) {
        const Index valence = complex.valence(v);
        if (valence < least_inner_valence && sharp_edges(complex, v) < 2)
            defects.add("valence",
                        "domain vertex " + number(v) + " has " + number(valence) +
                            " quads; inside, at least " + number(least_inner_valence) +
                            " are needed",
                        v);
        if (valence > max_valence)
            defects.add("valence",
                        "domain vertex " + number(v) + " has " + number(valence) +
                            " quads; at most " + number(max_valence) + " are allowed",
                        v);
    }
}

//! Numbers of connected pieces, from pairs of joined elements.
class Pieces {
public:
    explicit Pieces(Index count) : parent_(count), pieces_(count)
    {
        for (Index i = 0; i < count; ++i)
            parent_[i] = i;
    }
    void join(Index a, Index b)
    {
        a = root(a), b = root(b);
        if (a == b)
            return;
        parent_[std::max(a, b)] = std::min(a, b);
        --pieces_;
    }
    Index count() const { return pieces_; }

private:
    Index root(Index i)
    {
        while (parent_[i] != i)
            i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    std::vector<Index> parent_;
    Index pieces_;
};

//! What two surfaces must have in common.
struct Topology {
    Index pieces = 0, boundary_loops = 0;
    int euler_characteristic = 0;
};

//! `Surface` is ManifoldMesh or QuadComplex, whose halfedges are walked by the same verbs.
template <class Surface>
Topology topology(const Surface& surface, Index faces, Index sides, int euler_characteristic)
{
    Topology result;
    result.euler_characteristic = euler_characteristic;
    Pieces pieces(faces);
    std::vector<char> seen(surface.halfedge_count(), 0);
    for (Index h = 0; h < surface.halfedge_count(); ++h) {
        if (surface.twin(h) != invalid_index) {
            pieces.join(h / sides, surface.twin(h) / sides);
            continue;
        }
        if (seen[h])
            continue;
        ++result.boundary_loops;
        // The next boundary halfedge starts where this one ends: turn there over all faces.
        for (Index g = h; !seen[g];) {
            seen[g] = 1;
            g = Surface::next(g);
            while (surface.twin(g) != invalid_index)
                g = Surface::next(surface.twin(g));
        }
    }
    result.pieces = pieces.count();
    return result;
}

void check_topology(const ManifoldMesh& source, const QuadDomain& domain,
                    DomainValidation& validation, DefectList& defects)
{
    const Topology mesh =
        topology(source, source.face_count(), 3,
                 static_cast<int>(source.vertex_count()) - static_cast<int>(source.edge_count()) +
                     static_cast<int>(source.face_count()));
    const Topology k = topology(domain.complex, domain.complex.quad_count(), 4,
                                domain.complex.euler_characteristic());
    validation.euler_characteristic = k.euler_characteristic;
    validation.boundary_loops = k.boundary_loops;
    const auto compare = [&](const char* what, long ours, long theirs) {
        if (ours != theirs)
            defects.add("topology",
                        std::string("the domain has ") + what + ' ' + std::to_string(ours) +
                            ", the source mesh " + std::to_string(theirs),
                        invalid_index);
    };
    compare("Euler characteristic", k.euler_characteristic, mesh.euler_characteristic);
    compare("number of boundary loops", k.boundary_loops, mesh.boundary_loops);
    compare("number of connected pieces", k.pieces, mesh.pieces);
    if (mesh.pieces > 1)
        defects.add("topology",
                    "the source mesh has " + number(mesh.pieces) +
                        " connected pieces; each needs a domain of its own",
                    invalid_index);
}

} // namespace

void DefectList::add(const char* rule, std::string message, Index element)
{
    ++count_;
    if (++of_rule_[rule] <= listed_per_rule)
        defects_.push_back({rule, std::move(message), element});
}

Result<DomainValidation> validate_domain(const ManifoldMesh& source, const QuadDomain& domain,
                                         Context& context, const ValidateOptions& options)
{
    DomainValidation validation;
    DefectList defects;
    validation.vertices = domain.complex.vertex_count();
    validation.edges = domain.complex.edge_count();
    validation.quads = domain.complex.quad_count();
    const auto finish = [&] {
        validation.defects = defects.defects();
        validation.defect_count = defects.count();
        return validation;
    };
    const std::string wanted = signature(source);
    if (domain.source_signature != wanted)
        defects.add("signature",
                    "the domain was made for the mesh with signature " + domain.source_signature +
                        ", this one has " + wanted,
                    invalid_index);
    check_indices(source, domain, defects);
    if (defects.has("index"))
        return finish();
    validation.extraordinary = domain.complex.extraordinary_count();
    validation.max_valence = domain.complex.max_valence();
    check_elements(domain, options.max_valence, defects);
    check_topology(source, domain, validation, defects);
    check_carrier(source, domain.carrier, defects);
    if (context.cancelled())
        return Context::cancelled_error("validation");
    // With ends or places confused, paths would only repeat the complaint.
    if (!defects.has("edge_ends") && !defects.has("vertex_distinct"))
        check_paths(domain, defects);
    if (options.charts && defects.empty()) {
        const Result<std::vector<QuadChart>> charts = compute_charts(source, domain, context);
        if (charts.ok()) {
            for (const DomainDefect& defect :
                 check_charts(source, domain.complex, *charts, validation.charts))
                defects.add(defect.rule.c_str(), defect.message, defect.element);
        } else if (charts.error().code == ErrorCode::cancelled) {
            return charts.error();
        } else {
            defects.add("chart", charts.error().message, charts.error().element);
        }
    }
    if (context.cancelled())
        return Context::cancelled_error("validation");
    return finish();
}

} // namespace bot2nurbs
